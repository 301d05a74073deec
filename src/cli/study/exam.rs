//! `lacuna study` of an exam.

use std::path::Path;

use super::{Args, all_unless};
use crate::console::Console;
use crate::failure::Failure;
use crate::input;
use lacuna::file::Document;
use lacuna::study::{Exam, ExamResult};
use lacuna::system::System;

pub fn run(
    document: &Document,
    config: &Path,
    args: &Args,
    seed: u64,
    threads: Option<usize>,
    look: &Console,
) -> Result<u8, Failure> {
    let exam: Exam = document.read()?;
    let (i, n) = args.shard.unwrap_or((1, 1));
    let cases = exam.share(i, n)?;
    let beside = |name: &String| config.parent().unwrap_or(Path::new("")).join(name);
    let load = |machine: &lacuna::study::Machine| Ok(input::model(&beside(&machine.model))?.0);
    let systems: Vec<System> = exam.systems.iter().map(load).collect::<Result<_, Failure>>()?;
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
            "{:?}, g = {}, {} samples, {} dB, pole {}, parameters {:.0} % off: {} cases, named {} \
             (first {}), spurious {}, removed {}",
            t.kind,
            t.g,
            t.samples,
            t.snr_db,
            t.noise_pole,
            100.0 * t.parameter_error,
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
