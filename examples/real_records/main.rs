//! The main job on records of real machines, and on a few simulated ones that others publish
//! figures for: a simple baseline each, what is named, and what that is worth on other data.
//!
//! ```text
//! cargo run --release --example real_records -- OUT DATA [NAME]
//! ```
//!
//! `DATA` holds one folder of CSV files per set (`silverbox`, `cascaded_tanks`, ..); a set that is
//! not there is skipped, and with `NAME` all others are. Reports go to `OUT`; the table on stdout
//! is the one of `docs/results.md`.

mod cases;
mod source;

use std::path::{Path, PathBuf};
use std::time::Instant;

use lacuna::data::Record;
use lacuna::diagnose::{Diagnosis, Finding};
use lacuna::estimate::{estimate, linear};
use lacuna::evaluate::{Init, Simulation};
use lacuna::file::{self, Format};
use lacuna::report::Report;
use lacuna::report::sentences;
use lacuna::system::System;

use cases::{Baseline, Case};

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

fn main() -> Outcome<()> {
    let mut arguments = std::env::args().skip(1);
    let out = PathBuf::from(arguments.next().unwrap_or_else(|| "lacuna-out".into()));
    let Some(data) = arguments.next().map(PathBuf::from) else {
        println!("skipped: say where the records are: real_records OUT DATA");
        return Ok(());
    };
    let wanted = arguments.next().unwrap_or_default();
    println!("| record | baseline: test RMSE | with what was found | found | s |");
    println!("| --- | --- | --- | --- | --- |");
    for case in cases::all().iter().filter(|case| case.name.starts_with(&wanted)) {
        let folder = data.join(case.folder);
        if folder.is_dir() {
            case.run(&folder, &out)?;
        } else {
            println!("| {} | skipped: {} is not there |||||", case.name, folder.display());
        }
    }
    Ok(())
}

impl Case {
    fn run(&self, folder: &Path, out: &Path) -> Outcome<()> {
        let begin = Instant::now();
        let train = self.train.read(folder)?;
        let model = self.baseline(&train)?;
        let mut tests = vec![];
        for (name, source) in &self.tests {
            tests.push((*name, source.read(folder)?));
        }
        // a record that has no other is split by the diagnosis itself
        let same_source = self.tests.first().is_some_and(|(_, source)| *source == self.train);
        let test = tests.first().map(|(_, record)| record).filter(|_| !same_source);
        let diagnosis = Diagnosis::of(&model).init(Init::Samples(self.init));
        let finding = diagnosis.run(&[train], test, &())?;
        let (mut before, mut after) = (vec![], vec![]);
        for (name, test) in &tests {
            before.push(format!("{name} {:.3e}", self.rmse(&model, test)?));
            after.push(format!("{name} {:.3e}", self.rmse(&finding.extended, test)?));
        }
        println!(
            "| {} | {} | {} | {} | {:.0} |",
            self.name,
            before.join(", "),
            after.join(", "),
            told(&finding),
            begin.elapsed().as_secs_f64()
        );
        let own = out.join(self.name.replace([',', ' '], "_"));
        std::fs::create_dir_all(&own)?;
        Report::of(&finding).titled(self.name).write(&own.join("report.html"))?;
        file::save(&finding.extended, &own.join("extended.toml"))?;
        Ok(())
    }

    /// What is diagnosed: as it stands, or fitted to the record first, or made of it.
    fn baseline(&self, train: &Record) -> Outcome<System> {
        let records = std::slice::from_ref(train);
        Ok(match &self.baseline {
            Baseline::Known(text) => file::parse(text, self.name, Format::Toml)?,
            Baseline::Fitted(text) => {
                let model = file::parse(text, self.name, Format::Toml)?;
                estimate(&model, records, 0)?.system
            }
            Baseline::Linear(order) => linear(records, Some(*order))?.system,
        })
    }

    /// Free run over a test record, its start fitted to the first samples, which are left out.
    fn rmse(&self, system: &System, test: &Record) -> Outcome<f64> {
        let run = Simulation::of(system, test, Init::Samples(self.init))?;
        Ok(run.metrics[0].1.rmse)
    }
}

/// The sentences, and what stands beside each.
fn told(finding: &Finding) -> String {
    let mut all = vec![];
    for cause in &finding.causes {
        let others: Vec<String> = cause.indistinguishable.iter().map(ToString::to_string).collect();
        let alternatives =
            if others.is_empty() { String::new() } else { format!(" (or {})", others.join(", ")) };
        all.push(format!("{}{alternatives}", sentences::cause(cause)));
    }
    if all.is_empty() { sentences::headline(finding) } else { all.join("<br>") }
}
