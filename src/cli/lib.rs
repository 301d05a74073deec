//! The library's verbs from a terminal.
//!
//! ```text
//! arguments -- args --> a command -- input --> System, Record -- the library --> Outcome
//! Outcome -- console --> text or one JSON document on stdout, remarks on stderr, files
//! ```

mod args;
mod check;
mod command_line;
mod console;
mod demo;
mod diagnose;
mod estimate;
mod exam;
mod export;
mod failure;
mod fit;
mod generate;
mod input;
mod linear;
mod list;
mod look;
mod man;
mod missing;
mod new;
mod no_model;
mod outputs;
mod plan;
mod provenance;
mod reference;
mod reported;
mod simulate;
mod stdout;
mod study;

use std::process::ExitCode;

use clap::FromArgMatches;

use args::{Args, Command};
use console::Console;
use failure::Failure;
use lacuna::fault::Place;

/// Runs the program with the process's arguments.
pub fn main() -> ExitCode {
    let typed = args::help::command().try_get_matches().and_then(|m| Args::from_arg_matches(&m));
    let args = match typed {
        Ok(args) => args,
        Err(error) => return failure::call(&error),
    };
    let look = Console::new(&args.common);
    let done = threads(args.common.threads).and_then(|()| run(&args, &look));
    match done {
        Ok(status) => ExitCode::from(status),
        Err(failure) => failure.show(&look),
    }
}

/// Runs one command; its exit status.
fn run(args: &Args, look: &Console) -> Result<u8, Failure> {
    let seed = args.common.seed;
    match &args.command {
        Command::Demo(demo) => demo::run(demo, seed, look),
        Command::Diagnose(diagnose) => diagnose::run(diagnose, seed, look),
        Command::Simulate(simulate) => simulate::run(simulate, look),
        Command::Estimate(estimate) => estimate::run(estimate, seed, look),
        Command::Fit(fit) => fit::run(fit, seed, args.common.threads, look),
        Command::Generate(generate) => generate::run(generate, seed, look),
        Command::Study(study) => study::run(study, seed, args.common.threads, look),
        Command::Exam(exam) => exam::run(exam, seed, look),
        Command::Look(args) => look::run(args, look),
        Command::Plan(plan) => plan::run(plan, look),
        Command::Check(check) => check::run(check, look),
        Command::Report(report) => reported::run(report, look),
        Command::New(new) => new::run(new, look),
        Command::Man(man) => man::run(man, look),
        Command::Export(export) => export::run(export, look),
        Command::Models => list::models(look),
        Command::Effects => list::effects(look),
        Command::Completions { shell } => list::completions(*shell, look),
    }
}

/// Threads that are started at most, where the machine has few: more only wait for each other.
const MOST_THREADS: usize = 256;

/// Sets how many threads the library works with.
fn threads(count: Option<usize>) -> Result<(), Failure> {
    let Some(count) = count else { return Ok(()) };
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let most = MOST_THREADS.max(4 * cores);
    if count > most {
        let place = Place { key: Some("--threads".into()), ..Place::default() };
        return Err(Failure::call_refused(
            format!("--threads is {count}, and at most {most} are started"),
            place,
            format!("this machine has {cores}; leave --threads out to use all"),
        ));
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build_global();
    pool.map_err(|error| Failure::work(format!("{count} threads cannot be started: {error}")))
}
