//! What can be typed.

mod check;
mod columns;
mod diagnose;
mod estimate;
mod exam;
mod export;
mod folder;
pub mod help;
mod look;
mod man;
mod new;
mod report;
mod study;

use std::path::PathBuf;

use clap::{Args as Arguments, Parser, Subcommand};

pub use check::Check;
pub use columns::Columns;
pub use diagnose::Diagnose;
pub use estimate::Estimate;
pub use exam::{Exam, ExamVerb};
pub use export::{Export, ExportTo};
pub use look::Look;
pub use man::Man;
pub use new::New;
pub use report::Report;
pub use study::{Study, StudyVerb};

/// Shows what a model's simulation gets wrong, names the cause, extends the model and
/// measures the gain.
#[derive(Debug, Parser)]
#[command(name = "lacuna", version, about, arg_required_else_help = true)]
#[command(after_long_help = "Exit status:\n  \
    0    done\n  \
    1    the work failed, or `check` was interrupted\n  \
    2    the call or its input is wrong\n  \
    3    the data reject the model (check)\n  \
    4    the data themselves are at fault (check)\n  \
    130  ended by a second Ctrl-C\n\n\
    Results go to stdout, remarks and progress to stderr. --json puts one JSON document on stdout, also\n\
    on failure; docs/schema describes it. NO_COLOR and --quiet are heard. `lacuna COMMAND --help` shows\n\
    an example of each.")]
pub struct Args {
    #[command(subcommand)]
    pub command: Command,
    #[command(flatten)]
    pub common: Common,
}

#[derive(Debug, Clone, Arguments)]
pub struct Common {
    /// Seed of everything random
    #[arg(long, global = true, default_value_t = 0, value_name = "N")]
    pub seed: u64,
    /// Threads to work with [default: all]
    #[arg(long, global = true, value_name = "N", value_parser = positive)]
    pub threads: Option<usize>,
    /// One JSON document on stdout, and nothing else there
    #[arg(long, global = true)]
    pub json: bool,
    /// Replace files that lacuna did not write, too; what the call reads, and records, never
    #[arg(long, global = true)]
    pub force: bool,
    /// No text beside the result
    #[arg(long, global = true, conflicts_with = "verbose")]
    pub quiet: bool,
    /// More text
    #[arg(short, long, global = true)]
    pub verbose: bool,
}

fn positive(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(0) | Err(_) => Err("a whole number, 1 or above, is needed".into()),
        Ok(count) => Ok(count),
    }
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// The main job on an embedded record: finds an effect hidden in a mass-spring-damper
    #[command(after_help = "Example:\n  lacuna demo --out lacuna-out")]
    Demo(Demo),
    /// Shows what a model gets wrong on a record, names the cause and measures the gain
    #[command(
        after_help = "Examples:\n  lacuna diagnose --model press.toml --data est.csv --test test.csv\n  \
        lacuna diagnose --data est.csv --inputs force --outputs position\n\n\
        Without --model, a linear one is estimated from the first part of the record (linear.toml), and\n\
        what it gets wrong is shown.\n\n\
        Writes report.html, extended.toml and diagnosis.json into --out. The records are split by\n\
        time: 70 % fit, 30 % choose; the test record is touched once, for scoring. One Ctrl-C stops\n\
        with what is known."
    )]
    Diagnose(Diagnose),
    /// Runs a model along the inputs of a record
    #[command(
        after_help = "Example:\n  lacuna simulate --model press.toml --data test.csv --out simulated.csv"
    )]
    Simulate(Simulate),
    /// Fits the free parameters of a model to records, or makes a linear model of records alone
    #[command(
        after_help = "Examples:\n  lacuna estimate --model press.toml --data est.csv --out fitted.toml\n  \
        lacuna estimate --lti --data est.csv --out linear.toml\n  \
        lacuna estimate --lti 4 --inputs force --outputs position --data est.csv --out linear.toml\n\n\
        --lti makes a discrete linear model with the records' names, units and sampling time: poles\n\
        from the records' correlations (a subspace method), everything refined by simulation error.\n\
        Without --inputs and --outputs, the columns u, u1.. and y, y1.. are taken. Offsets and direct\n\
        terms within three standard errors of 0 are left out. An offset belongs to the outputs:\n\
        y = C x + D u + offset."
    )]
    Estimate(Estimate),
    /// Trains a network beside a model, and its encoder, on records
    #[command(
        after_help = "Example:\n  lacuna fit --model baseline.toml --data est.csv --validate val.csv --config fit.toml\n\n\
        Writes model.toml (a model like any other), weights.json, history.csv and report.html into\n\
        --out. The same call goes on from checkpoint.json there; one Ctrl-C stops with the best model."
    )]
    Fit(Fit),
    /// Shows what a record is like; with a model, what the model leaves unexplained, as a force
    #[command(
        after_help = "Examples:\n  lacuna look --data est.csv --inputs force --outputs position\n  \
        lacuna look --model press.toml --data est.csv\n\n\
        Without a model: sampling, range, grain, what is clipped or stuck, spectrum, excitation,\n\
        coherence, delays, periods with noise and distortion, and whether inputs react to outputs.\n\
        Columns u, u1.. drive and all others are measured, where --inputs and --outputs do not say.\n\n\
        With a model: \
        Smooths the missing force of every channel, no law assumed, and says how much of it a curve of\n\
        each coordinate explains. Writes look.html into --out; takes seconds."
    )]
    Look(Look),
    /// Says what a record can see and tell apart, and the experiment that would tell more
    #[command(after_help = "Example:\n  lacuna plan --model press.toml --data est.csv\n\n\
        A little of every cause is simulated along the record and measured by the noise. Writes no\n\
        file. -v lists every cause and every pair. --json prints\n  \
        noise_floor    noise of each output and where it is from\n  \
        causes         smallest_visible (parameters trusted), smallest_visible_free, unit, and kappa,\n                 \
        the share of the effect that free parameters cannot imitate\n  \
        look_alikes    pairs with a correlation rho above 0.95, or a separation below 10 when each\n                 \
        moves the outputs as much as the noise does; told_apart_by, twins: by none\n  \
        experiments    level, offset, band, another sensor: pairs that each tells apart, and causes\n                 \
        that it shows and the record does not")]
    Plan(Plan),
    /// Says whether data reject a model: exit status 0 if they do not, 3 if they do
    #[command(
        after_help = "Example:\n  lacuna check --model press.toml --data today.csv --level 0.01"
    )]
    Check(Check),
    /// Makes records with known truth: excitation, simulation, noise, a hidden effect if asked
    #[command(
        after_help = "Example:\n  lacuna generate --config generate.toml --out records --seed 1\n\n\
        Writes est.csv, test.csv and truth.json into --out."
    )]
    Generate(Generate),
    /// Trains a model from several starts with several seeds, and compares
    #[command(
        args_conflicts_with_subcommands = true,
        after_help = "Examples:\n  lacuna study --config study.toml --out study\n  \
        lacuna study --config study.toml --shard 2/4 --out shard2\n  \
        lacuna study merge shard1 shard2 shard3 shard4 --out study\n  \
        lacuna study --config examples/exam/exam.toml --out exam\n  \
        lacuna study --config examples/exam/exam.toml --cases\n  \
        lacuna study --config examples/exam/exam.toml --case case17 --out exam"
    )]
    Study(Study),
    /// Writes, answers and marks exams of hidden effects, for any tool; tells how sure answers are
    #[command(
        after_help = "Example:\n  lacuna exam write exam --config examples/exam/exam.toml\n  \
        lacuna exam answer exam --out answers\n  lacuna exam mark exam answers --out marks"
    )]
    Exam(Exam),
    /// Draws the page of a diagnosis again from what was stored beside it
    #[command(after_help = "Example:\n  lacuna report lacuna-out\n\n\
        Reads report-data.json, which `diagnose` writes, and writes report.html anew: after an update\n\
        of the program, or where the page is lost. Takes the folder or a file in it.")]
    Report(Report),
    /// Writes a commented model file to begin with, from a registered model or a record's columns
    #[command(after_help = "Examples:\n  lacuna new mass_spring_damper > press.toml\n  \
        lacuna new --data est.csv --inputs force --outputs position --order 2 --out press.toml\n\n\
        Of a record: a linear differential equation of that order for each output, with the record's\n\
        names and units and rough values. It loads and runs at once; `lacuna estimate` fits it.")]
    New(New),
    /// Prints the manual page, or writes those of all commands into a folder
    #[command(after_help = "Example:\n  lacuna man --out ~/.local/share/man/man1")]
    Man(Man),
    /// Writes a model as C, FMU, MATLAB function or Python class, with a test that it is the same
    #[command(
        after_help = "Example:\n  lacuna export lacuna-out/extended.toml --to fmu --out press"
    )]
    Export(Export),
    /// Lists the registered models
    #[command(after_help = "Example:\n  lacuna models --json")]
    Models,
    /// Lists the registered effects
    #[command(after_help = "Example:\n  lacuna effects")]
    Effects,
    /// Prints completions for a shell
    #[command(
        after_help = "Example:\n  lacuna completions bash > ~/.local/share/bash-completion/completions/lacuna"
    )]
    Completions {
        /// bash, zsh, fish, elvish or powershell
        shell: clap_complete::Shell,
    },
}

#[derive(Debug, Clone, Arguments)]
pub struct ModelAndData {
    /// Model file (TOML or JSON)
    #[arg(long, value_name = "FILE")]
    pub model: PathBuf,
    /// Record (CSV, .npz, .mat..; - is stdin); may be repeated for several records of one machine
    #[arg(long, value_name = "FILE", required = true)]
    pub data: Vec<PathBuf>,
    #[command(flatten)]
    pub columns: Columns,
}

#[derive(Debug, Clone, Arguments)]
pub struct Demo {
    /// Folder for the results
    #[arg(long, value_name = "DIR", default_value = "lacuna-out", value_parser = folder::folder())]
    pub out: PathBuf,
    /// Simulates what was found so many times, diagnoses each, and says how often such a record
    /// would mislead [default: not at all]
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub rehearse: usize,
}

#[derive(Debug, Clone, Arguments)]
pub struct Simulate {
    /// Model file (TOML or JSON)
    #[arg(long, value_name = "FILE")]
    pub model: PathBuf,
    /// Record (CSV, .npz, .mat..; - is stdin)
    #[arg(long, value_name = "FILE")]
    pub data: PathBuf,
    #[command(flatten)]
    pub columns: Columns,
    /// CSV file for the simulated outputs, `<output>_hat`; - is stdout
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Samples from which the initial state is estimated; the figures leave them out; 0 holds
    /// the model's `initial` [default: until the start is forgotten, at most 10 %]
    #[arg(long, value_name = "N")]
    pub init: Option<usize>,
    /// Predict every output K samples ahead from what was measured until then, instead of simulating
    /// it; measurements are weighed by the gain of the model where it has one (K), else by the noise
    /// that is estimated on the record
    #[arg(long, value_name = "K", conflicts_with = "init", value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub horizon: Option<u64>,
}

#[derive(Debug, Clone, Arguments)]
pub struct Fit {
    #[command(flatten)]
    pub on: ModelAndData,
    /// Record to choose the best epoch by; may be repeated [default: the last 20 % of the data]
    #[arg(long, value_name = "FILE")]
    pub validate: Vec<PathBuf>,
    /// Record for scoring, used for nothing else
    #[arg(long, value_name = "FILE")]
    pub test: Option<PathBuf>,
    /// Structure, encoder, initialiser and training (TOML or JSON)
    #[arg(long, value_name = "FILE")]
    pub config: PathBuf,
    /// Folder for the results
    #[arg(long, value_name = "DIR", default_value = "lacuna-out", value_parser = folder::folder())]
    pub out: PathBuf,
}

#[derive(Debug, Clone, Arguments)]
pub struct Plan {
    #[command(flatten)]
    pub on: ModelAndData,
    /// Parameters that are right
    #[arg(long, value_name = "PARAMETER", value_delimiter = ',', num_args = 1..)]
    pub fix: Vec<String>,
}

#[derive(Debug, Clone, Arguments)]
pub struct Generate {
    /// System, excitation, noise and what is hidden (TOML or JSON)
    #[arg(long, value_name = "FILE")]
    pub config: PathBuf,
    /// Folder for the records
    #[arg(long, value_name = "DIR", default_value = "lacuna-out", value_parser = folder::folder())]
    pub out: PathBuf,
}
