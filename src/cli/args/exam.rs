//! What `lacuna exam` takes.

use std::path::PathBuf;

use clap::{Args as Arguments, Subcommand};
use lacuna::diagnose::Memory;

#[derive(Debug, Clone, Arguments)]
pub struct Exam {
    #[command(subcommand)]
    pub verb: ExamVerb,
}

#[derive(Debug, Clone, Subcommand)]
pub enum ExamVerb {
    /// Writes the cases of an exam as files, the truth apart from them
    #[command(
        after_help = "Example:\n  lacuna exam write exam --config examples/exam/exam.toml\n\n\
        Writes exam.json, cases/caseN (case.json, model.toml, record1.csv ..) and truth/caseN. Hand out\n\
        `cases`, keep `truth`. docs/exam.md describes every file."
    )]
    Write(Write),
    /// Answers an exam with lacuna's own diagnosis
    #[command(after_help = "Example:\n  lacuna exam answer exam --out answers")]
    Answer(Answer),
    /// Marks the answers of any tool against the truth
    #[command(after_help = "Example:\n  lacuna exam mark exam answers.json --out marks\n\n\
        ANSWERS is a JSON file, or a folder of such files (docs/schema/answers.json). Cases without an\n\
        answer count as if nothing had been found. Writes study.json, cases.csv and report.html.")]
    Mark(Mark),
    /// Says how sure what was told is: reliability, Brier score, coverage, rank histograms
    #[command(
        after_help = "Example:\n  lacuna exam calibrate exam-results --commit \"$(git rev-parse HEAD)\" --out calibration.json\n\n\
        Takes folders that `study` or `exam mark` wrote marks into."
    )]
    Calibrate(Calibrate),
}

#[derive(Debug, Clone, Arguments)]
pub struct Write {
    /// Folder for the exam
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// What is hidden where (TOML or JSON), as for `lacuna study`
    #[arg(long, value_name = "FILE")]
    pub config: PathBuf,
}

#[derive(Debug, Clone, Arguments)]
pub struct Answer {
    /// Folder of the exam
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// Folder for the answers, one file a case; what is there is not done again
    #[arg(long, value_name = "DIR", default_value = "lacuna-out", value_parser = super::folder::folder())]
    pub out: PathBuf,
    /// Memory that it may take, such as 2GB or 512MiB; what does not fit is left out by rule and said
    /// [default: half of the machine's]
    #[arg(long, value_name = "SIZE")]
    pub memory: Option<Memory>,
}

#[derive(Debug, Clone, Arguments)]
pub struct Mark {
    /// Folder of the exam
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// Answers: a JSON file, or a folder of them
    #[arg(value_name = "ANSWERS")]
    pub answers: PathBuf,
    /// Folder for the results
    #[arg(long, value_name = "DIR", default_value = "lacuna-out", value_parser = super::folder::folder())]
    pub out: PathBuf,
}

#[derive(Debug, Clone, Arguments)]
pub struct Calibrate {
    /// Folders of exams that `study` worked off
    #[arg(value_name = "DIR", required = true)]
    pub folders: Vec<PathBuf>,
    /// Commit of the program that answered
    #[arg(long, value_name = "HASH")]
    pub commit: Option<String>,
    /// File for the result
    #[arg(long, value_name = "FILE", default_value = "calibration.json")]
    pub out: PathBuf,
}
