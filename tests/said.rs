//! What a diagnosis says beside its causes, where a record lets it say so, and that it is
//! silent where nothing is there.

use lacuna::data::{FilteredNoise, Record, noise};
use lacuna::diagnose::{Diagnosis, Finding};
use lacuna::evaluate::{Init, Simulation};
use lacuna::file::{Format, parse};
use lacuna::report::{Document, FileNames, Provenance, Report, sentences};
use lacuna::system::System;

mod closed_loop;
mod distortion;
mod records;
mod regime;

/// A mass on a spring, as it is modelled.
const MODEL: &str = r#"
sampling_time = 0.05
[model.duffing]
mass = 1.0
damping = 0.6
stiffness = 9.0
hardening = 0.0
fixed = ["mass", "hardening"]
"#;
const STEP: f64 = 0.05;

/// The mass on a spring, with this in it.
fn machine(more: &str) -> System {
    parse(&format!("{MODEL}{more}"), "spring.toml", Format::Toml)
        .unwrap_or_else(|e| panic!("{}", e.pretty()))
}

/// A hidden effect at a place.
fn hidden(into: &str, of: &str, effect: &str) -> String {
    format!("\n[[effects]]\ninto = \"{into}\"\nof = \"{of}\"\neffect.{effect}\n")
}

/// What a machine makes of an input, from rest.
fn answer(machine: &System, u: &[f64]) -> Vec<f64> {
    let drive = Record::new(STEP).input("u", u.to_vec()).unwrap();
    let mut run = Simulation::of(machine, &drive, Init::Samples(0)).unwrap();
    run.outputs.remove(0).1
}

/// A record of an input and an output with white noise.
fn record(u: &[f64], y: &[f64], size: f64, seed: u64) -> Record {
    let e = noise::white(y.len(), size, seed).unwrap();
    let y: Vec<f64> = y.iter().zip(e).map(|(y, e)| y + e).collect();
    Record::new(STEP).input("u [N]", u.to_vec()).unwrap().output("y [m]", y).unwrap()
}

/// Filtered noise as a force of 3 N.
fn force(n: usize, seed: u64) -> Vec<f64> {
    FilteredNoise { rms: 3.0, cutoff: 1.0, order: 2 }.generate(n, STEP, seed).unwrap()
}

/// A diagnosis that looks for these only.
fn diagnosed(records: &[Record], only: &[&str]) -> Finding {
    let system = machine("");
    let only: Vec<String> = only.iter().map(|name| (*name).to_string()).collect();
    Diagnosis::of(&system).only(&only).run(records, None, &()).unwrap()
}

/// The finding as its document.
fn document(finding: &Finding) -> serde_json::Value {
    let files = FileNames { extended_model: "extended.toml", report: "report.html" };
    let from = Provenance::default();
    serde_json::from_str(&Document::of(finding, files, &from).text().unwrap()).unwrap()
}

/// Whether a remark of the finding has these words.
fn remarked(finding: &Finding, words: &str) -> bool {
    sentences::notes(finding).iter().any(|note| note.contains(words))
}

/// The sections of the report.
fn headings(finding: &Finding) -> Vec<String> {
    let html = Report::of(finding).html();
    let parts = html.split("<h2 ").skip(1);
    let text =
        |part: &str| part[part.find('>').unwrap() + 1..part.find("</h2>").unwrap()].to_string();
    parts.map(text).collect()
}
