//! The main job on records of real machines: a linear oscillator against the Silverbox, two
//! tanks without overflow, and two masses of which nothing, or one damper, is wrong.
//!
//! ```text
//! cargo run --release --example real_records -- OUT DATA
//! ```
//!
//! `DATA` holds `silverbox`, `cascaded_tanks` and `msd_paper` as CSV files; a set that is not
//! there is skipped. Reports go to `OUT`; the table on stdout is the one of `docs/results.md`.

use std::path::{Path, PathBuf};
use std::time::Instant;

use lacuna::data::Record;
use lacuna::diagnose::{Diagnosis, Finding};
use lacuna::estimate::estimate;
use lacuna::evaluate::{Init, Simulation};
use lacuna::file::{self, Format};
use lacuna::report::Report;
use lacuna::system::System;

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

/// Two masses as the paper's authors drive them (Hoekstra et al.), all of it known.
const MASSES: &str = r#"
sampling_time = 0.1
integrator = { method = "rk4", substeps = 10 }
[model.mass_spring_damper]
masses = [0.5, 0.4]
stiffness = [100.0, 100.0]
damping = [0.5, 0.5]
hardening = [0.0, 1000.0]
cubic_damping = [0.1, 0.0]
"#;

/// One record with a baseline for it.
struct Case {
    name: &'static str,
    folder: &'static str,
    model: String,
    /// Whether the baseline's parameters are fitted first.
    fitted: bool,
    train: &'static str,
    /// Test records; the first one is the diagnosis' own.
    tests: &'static [&'static str],
    /// Samples left out of the scores.
    init: usize,
}

fn main() -> Outcome<()> {
    let mut arguments = std::env::args().skip(1).map(PathBuf::from);
    let out = arguments.next().unwrap_or_else(|| "lacuna-out".into());
    let Some(data) = arguments.next() else {
        println!("skipped: say where the records are: real_records OUT DATA");
        return Ok(());
    };
    let cases = [
        Case {
            name: "silverbox",
            folder: "silverbox",
            model: include_str!("silverbox.toml").into(),
            fitted: true,
            train: "train_multisine.csv",
            tests: &["test_multisine.csv", "test_arrow.csv"],
            init: 50,
        },
        Case {
            name: "cascaded_tanks",
            folder: "cascaded_tanks",
            model: include_str!("cascaded_tanks.toml").into(),
            fitted: true,
            train: "train.csv",
            tests: &["test.csv"],
            init: 5,
        },
        Case {
            name: "msd_paper, all right",
            folder: "msd_paper",
            model: MASSES.into(),
            fitted: false,
            train: "train.csv",
            tests: &["test.csv"],
            init: 50,
        },
        Case {
            name: "msd_paper, d1 halved",
            folder: "msd_paper",
            model: MASSES.replace("[0.1, 0.0]", "[0.05, 0.0]"),
            fitted: false,
            train: "train.csv",
            tests: &["test.csv"],
            init: 50,
        },
    ];
    println!("| record | baseline: test RMSE | with what was found | found | s |");
    println!("| --- | --- | --- | --- | --- |");
    for case in &cases {
        let folder = data.join(case.folder);
        if folder.join(case.train).exists() {
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
        let train = Record::csv(folder.join(self.train))?.pick(&["u"], &["y"])?;
        let mut model = file::parse(&self.model, self.name, Format::Toml)?;
        if self.fitted {
            model = estimate(&model, std::slice::from_ref(&train), 0)?.system;
        }
        let mut tests = vec![];
        for name in self.tests {
            tests.push((*name, Record::csv(folder.join(name))?.pick(&["u"], &["y"])?));
        }
        let finding = Diagnosis::of(&model).init(Init::Samples(self.init)).run(
            &[train],
            Some(&tests[0].1),
            &(),
        )?;
        let (mut before, mut after) = (vec![], vec![]);
        for (name, test) in &tests {
            before.push(format!("{name} {:.6}", self.rmse(&model, test)?));
            after.push(format!("{name} {:.6}", self.rmse(&finding.extended, test)?));
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
        let beside =
            if others.is_empty() { String::new() } else { format!(" (or {})", others.join(", ")) };
        all.push(format!("{}{beside}", cause.sentence));
    }
    if all.is_empty() { finding.to_string() } else { all.join("<br>") }
}
