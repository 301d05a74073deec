//! `lacuna study` of an exam.

use std::path::Path;

use super::{Args, all_unless};
use crate::console::Console;
use crate::failure::Failure;
use crate::input;
use lacuna::file::Document;
use lacuna::study::{Case, Exam, ExamResult};
use lacuna::system::System;

/// An exam and its machines, whose files stand beside the configuration.
pub fn configured(document: &Document, config: &Path) -> Result<(Exam, Vec<System>), Failure> {
    let exam: Exam = document.read()?;
    exam.check().map_err(|error| Failure::from(error).in_file(config, document, [""; 2]))?;
    let relative = |name: &String| config.parent().unwrap_or(Path::new("")).join(name);
    let load = |machine: &lacuna::study::Machine| Ok(input::model(&relative(&machine.model))?.0);
    let systems = exam.systems.iter().map(load).collect::<Result<_, Failure>>()?;
    Ok((exam, systems))
}

pub fn run(
    document: &Document,
    config: &Path,
    args: &Args,
    seed: u64,
    threads: Option<usize>,
    look: &Console,
) -> Result<u8, Failure> {
    let (mut exam, systems) = configured(document, config)?;
    exam.memory = args.memory.unwrap_or_default();
    if args.cases {
        return super::list(exam.cases()?.iter().map(Case::key), look);
    }
    let (i, n) = args.shard.unwrap_or((1, 1));
    let cases = match &args.case[..] {
        [] => exam.share(i, n)?,
        keys => keys.iter().map(|key| exam.case(key)).collect::<Result<_, _>>()?,
    };
    look.hear_interrupts()?;
    let done = exam.run(&systems, &cases, all_unless(threads), seed, &args.out, look)?;
    look.clear();
    let wanted = cases.len();
    if done < wanted {
        look.result(&format!(
            "Interrupted: {done} of {wanted} cases are done; the same call goes on."
        ));
        look.document(
            &serde_json::json!({ "schema": 1, "done": done, "of": wanted, "interrupted": true }),
        );
        return Ok(0);
    }
    if !args.case.is_empty() {
        return super::some(&args.case, &args.out, look);
    }
    if n > 1 {
        look.result(&format!("Shard {i}/{n} is done: {done} cases in {}.", args.out.display()));
        look.document(
            &serde_json::json!({ "schema": 1, "done": done, "of": wanted, "shard": [i, n] }),
        );
        return Ok(0);
    }
    finish(&ExamResult::merge(std::slice::from_ref(&args.out))?, &args.out, look)
}

pub fn finish(result: &ExamResult, out: &Path, look: &Console) -> Result<u8, Failure> {
    result.write(out)?;
    let percent = |v: Option<f64>| v.map_or_else(|| "-".into(), |v| format!("{:.0} %", 100.0 * v));
    for t in result.tallies() {
        look.result(&format!(
            "{:?}, g = {}, {}: {} cases, named {} (first {}), spurious {}, removed {}",
            t.kind,
            t.g,
            t.conditions,
            t.cases,
            percent(t.named),
            percent(t.first),
            percent(Some(t.spurious)),
            percent(t.removed_median)
        ));
    }
    look.result(&format!("Wrote study.json, cases.csv and report.html into {}", out.display()));
    look.document(&result.document());
    Ok(0)
}
