//! `lacuna exam`.

use std::path::Path;

use super::args::{Columns, Exam as Args, ExamVerb};
use super::console::Console;
use super::failure::Failure;
use super::outputs::{self, cannot_write};
use super::study::exam::{configured, finish};
use super::{input, provenance};
use lacuna::diagnose::{Diagnosis, Memory, Watch};
use lacuna::file::{Document, read_regular, save_with, write_text};
use lacuna::study::{
    Answer, Answers, Calibration, CaseFile, ExamResult, Marked, UnknownName, Written,
};

/// What marking writes.
const MARKS: [&str; 4] = ["study.json", "cases.csv", "seconds.csv", "report.html"];

pub fn run(args: &Args, seed: u64, look: &Console) -> Result<u8, Failure> {
    match &args.verb {
        ExamVerb::Write(args) => {
            let document = Document::load(&args.config)?;
            let whole = outputs::within(&args.folder, &["exam.json"]);
            outputs::check(&[&args.config], &whole, look)?;
            let (exam, systems) = configured(&document, &args.config)?;
            look.hear_interrupts()?;
            let cases = exam.cases()?.len();
            let written = exam.write(&systems, seed, &args.folder, look)?;
            look.clear();
            look.result(&match written == cases {
                true => format!("Wrote {cases} cases into {}.", args.folder.display()),
                false => {
                    format!("Interrupted: {written} of {cases} cases are written, and no exam.")
                }
            });
            look.document(&serde_json::json!({ "schema": 1, "cases": cases, "written": written }));
            Ok(0)
        }
        ExamVerb::Answer(args) => {
            answer(&args.folder, &args.out, args.memory.unwrap_or_default(), look)
        }
        ExamVerb::Mark(args) => {
            outputs::check(&[&args.answers], &outputs::within(&args.out, &MARKS), look)?;
            let marked = Written::read(&args.folder)?.mark(&args.folder, &args.answers)?;
            said_of(&marked, look);
            let result = marked.result;
            result.keep(&args.out)?;
            finish(&result, &args.out, look)
        }
        ExamVerb::Calibrate(args) => {
            let inputs = outputs::files_of(&args.folders);
            outputs::check(&outputs::paths(&[&inputs]), std::slice::from_ref(&args.out), look)?;
            let result = ExamResult::merge(&args.folders)?;
            calibrate(&result, args.commit.as_deref(), seed, &args.out, look)
        }
    }
}

/// Remarks on answers that are missing, or that name what no library has.
fn said_of(marked: &Marked, look: &Console) {
    match marked.unanswered {
        0 => {}
        1 => look.say("One case has no answer: marked as if nothing had been found."),
        open => look.say(&format!(
            "{open} cases have no answer: marked as if nothing had been found there."
        )),
    }
    for UnknownName { case, role, name, near } in &marked.unknown {
        let near = near.as_ref();
        let hint = near.map_or_else(String::new, |near| format!(" (did you mean `{near}`?)"));
        let of = if *role == "effect" { "the library" } else { "its model" };
        look.say(&format!(
            "case {case}: `{name}`{hint} is no {role} of {of}: it counts as a wrong name."
        ));
    }
}

/// Answers every case of an exam that has no answer in the folder yet.
fn answer(folder: &Path, out: &Path, memory: Memory, look: &Console) -> Result<u8, Failure> {
    let exam = Written::read(folder)?;
    std::fs::create_dir_all(out).map_err(|error| cannot_write(out, &error))?;
    look.hear_interrupts()?;
    let mut done = 0;
    for number in 1..=exam.cases {
        if look.stopped() {
            break;
        }
        let own = folder.join("cases").join(format!("case{number}"));
        let path = out.join(format!("case{number}.json"));
        if !path.exists() {
            let extended = format!("case{number}.toml");
            let answers = answer_one(&own, &out.join(&extended), extended, memory, look)?;
            let text = serde_json::to_string_pretty(&answers).map_err(Failure::unwritable)? + "\n";
            write_text(&path, &text).map_err(|error| cannot_write(&path, &error))?;
        }
        done += 1;
        look.report(done as f64 / exam.cases as f64, &format!("case {number}"));
    }
    look.clear();
    let cases = exam.cases;
    look.result(&format!("{done} of {cases} cases are answered in {}.", out.display()));
    look.document(&serde_json::json!({ "schema": 1, "done": done, "of": cases }));
    Ok(0)
}

fn answer_one(
    case: &Path,
    extended: &Path,
    name: String,
    memory: Memory,
    look: &Console,
) -> Result<Answers, Failure> {
    let path = case.join("case.json");
    let text = read_regular(&path)
        .map_err(|error| Failure::work(format!("{}: cannot be read ({error})", path.display())))?;
    let file: CaseFile = serde_json::from_slice(&text)
        .map_err(|error| Failure::work(format!("{}: {error}", path.display())))?;
    let (system, want) = input::model(&case.join(&file.model))?;
    let records: Vec<_> = file.records.iter().map(|record| case.join(record)).collect();
    let records = input::records(&records, &want, &Columns::default(), look)?;
    let diagnosis = Diagnosis::of(&system).without(&file.without).memory(memory);
    let finding = diagnosis.run(&records, None, &())?;
    save_with(&finding.extended, extended, &["Written by `lacuna exam answer`.".into()])?;
    let mut answer = Answer::of(file.case, &finding);
    answer.extended_model = Some(name);
    let tool = concat!("lacuna ", env!("CARGO_PKG_VERSION")).to_string();
    Ok(Answers { schema: 1, tool, answers: vec![answer] })
}

/// Writes how sure what was told is, with where it is from.
fn calibrate(
    result: &ExamResult,
    commit: Option<&str>,
    seed: u64,
    out: &Path,
    look: &Console,
) -> Result<u8, Failure> {
    let calibration = Calibration::of(result);
    let all = serde_json::to_vec(result.marks()).map_err(Failure::unwritable)?;
    let from = provenance::of_this_call(seed).embedded("marks", "marks", &all);
    let document = serde_json::json!({
        "schema": 1,
        "commit": commit,
        "seeds": result.seeds(),
        "provenance": from,
        "date": from.date,
        "calibration": calibration,
    });
    let text = format!("{document:#}\n");
    write_text(out, &text).map_err(|error| cannot_write(out, &error))?;
    for row in &calibration.rows {
        look.result(&format!(
            "{:?}: {} cases, named {}, spurious {}, coefficients covered {}, gain covered {}",
            row.kind,
            row.cases,
            said(row.named.share),
            said(row.spurious.share),
            said(row.coefficients.covered.share),
            said(row.gain.covered.share),
        ));
    }
    let number = |v: Option<f64>| v.map_or_else(|| "-".into(), |v| format!("{v:.3}"));
    look.result(&format!(
        "{} probabilities of names: slope {}, Brier score {}.",
        calibration.names.count,
        number(calibration.names.slope),
        number(calibration.names.brier)
    ));
    look.result(&format!("Wrote {}", out.display()));
    look.document(&document);
    Ok(0)
}

fn said(share: Option<f64>) -> String {
    share.map_or_else(|| "-".into(), |share| format!("{:.1} %", 100.0 * share))
}
