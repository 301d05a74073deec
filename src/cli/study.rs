//! `lacuna study`.

use std::path::Path;

use super::args::{Columns, Study as Args, StudyVerb};
use super::console::Console;
use super::failure::Failure;
use super::input;
use super::outputs;
use lacuna::data::Record;
use lacuna::digits::number;
use lacuna::file::Document;
use lacuna::study::{ExamResult, Inputs, Job, MonteCarlo, StudyResult};

pub mod exam;

/// What a study or an exam writes into its folder.
const FILES: [&str; 6] =
    ["study.json", "runs.csv", "courses.csv", "cases.csv", "seconds.csv", "report.html"];

pub fn run(args: &Args, seed: u64, threads: Option<usize>, look: &Console) -> Result<u8, Failure> {
    if let Some(StudyVerb::Merge(merge)) = &args.verb {
        outputs::check(&[], &outputs::within(&merge.out, &FILES), look)?;
        if merge.folders.iter().any(|folder| ExamResult::lies_in(folder)) {
            return exam::finish(&ExamResult::merge(&merge.folders)?, &merge.out, look);
        }
        let result = StudyResult::merge(&merge.folders)?;
        return finish(&result, &merge.out, look);
    }
    let Some(config) = &args.config else {
        return Err(Failure::work("a study needs --config, or `merge` and folders".into()));
    };
    let document = Document::load(config)?;
    outputs::check(&[config], &outputs::within(&args.out, &FILES), look)?;
    if document.has("systems") {
        return exam::run(&document, config, args, seed, threads, look);
    }
    if args.memory.is_some() {
        let what = "--memory bounds the diagnoses of an exam, and this study trains: leave it out";
        return Err(Failure::work(what.into()));
    }
    let study: MonteCarlo = document.read()?;
    let located = |error| Failure::from(error).in_file(config, &document, [""; 2]);
    study.check().map_err(located)?;
    if args.cases {
        return list(study.jobs().into_iter().map(Job::key), look);
    }
    let (i, n) = args.shard.unwrap_or((1, 1));
    let jobs = match &args.case[..] {
        [] => study.share(i, n)?,
        keys => keys.iter().map(|key| study.job(key)).collect::<Result<_, _>>()?,
    };
    let relative = |name: &String| config.parent().unwrap_or(Path::new("")).join(name);
    let test: Vec<_> = study.test.iter().map(relative).collect();
    let [data, validate] =
        [&study.data, &study.validate].map(|names| names.iter().map(relative).collect::<Vec<_>>());
    outputs::distinct(&data, &[("test", &test)])?;
    let mut inputs = outputs::paths(&[&data, &validate, &test]);
    let model = relative(&study.model);
    inputs.push(&model);
    outputs::check(&inputs, &outputs::within(&args.out, &FILES), look)?;
    let (system, want) = input::model(&model)?;
    let read = |name: &String| input::record(&relative(name), &want, &Columns::default(), look);
    let all = |names: &[String]| names.iter().map(read).collect::<Result<Vec<Record>, _>>();
    let inputs = Inputs {
        training: all(&study.data)?,
        validation: all(&study.validate)?,
        test: study.test.as_ref().map(read).transpose()?,
        system,
    };
    look.hear_interrupts()?;
    let threads = all_unless(threads);
    // the study of noise belongs to the first training
    let with_noise = jobs.first() == study.jobs().first();
    let (wanted, whole) = (jobs.len(), n == 1 && args.case.is_empty());
    let done = study.run(&inputs, &jobs, with_noise, threads, seed, &args.out, look)?;
    look.clear();
    if done < wanted {
        look.result(&format!(
            "Interrupted: {done} of {wanted} trainings are done; the same call goes on."
        ));
        look.document(
            &serde_json::json!({ "schema": 1, "done": done, "of": wanted, "interrupted": true }),
        );
        return Ok(0);
    }
    if !args.case.is_empty() {
        return some(&args.case, &args.out, look);
    }
    if !whole {
        look.result(&format!("Shard {i}/{n} is done: {done} trainings in {}.", args.out.display()));
        look.document(
            &serde_json::json!({ "schema": 1, "done": done, "of": wanted, "shard": [i, n] }),
        );
        return Ok(0);
    }
    finish(&StudyResult::merge(std::slice::from_ref(&args.out))?, &args.out, look)
}

/// Lists keys, one a line, as `--case` takes them.
fn list(keys: impl Iterator<Item = String>, look: &Console) -> Result<u8, Failure> {
    let keys: Vec<String> = keys.collect();
    keys.iter().for_each(|key| look.result(key));
    look.document(&serde_json::json!({ "schema": 1, "cases": keys }));
    Ok(0)
}

/// Says that some cases are done, and not the whole.
fn some(keys: &[String], out: &Path, look: &Console) -> Result<u8, Failure> {
    look.result(&format!("Done: {} in {}.", keys.join(", "), out.display()));
    look.document(&serde_json::json!({ "schema": 1, "done": keys.len(), "of": keys.len() }));
    Ok(0)
}

fn all_unless(threads: Option<usize>) -> usize {
    threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from))
}

fn finish(result: &StudyResult, out: &Path, look: &Console) -> Result<u8, Failure> {
    result.write(out)?;
    for summary in result.summaries() {
        for q in summary.test.iter().flatten() {
            look.result(&format!(
                "{}: test RMSE {} ({} to {}) over {} runs",
                summary.start,
                number(q.median, None),
                number(q.least, None),
                number(q.greatest, None),
                summary.runs
            ));
        }
    }
    look.result(&format!(
        "Wrote study.json, runs.csv, courses.csv and report.html into {}",
        out.display()
    ));
    look.document(&result.document());
    Ok(0)
}
