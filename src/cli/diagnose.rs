//! `lacuna diagnose`.

use std::fs;
use std::path::Path;

use super::args::Diagnose as Args;
use super::console::{Console, print};
use super::failure::Failure;
use super::outputs::{self, cannot_write};
use super::{input, provenance, reported};
use lacuna::data::Record;
use lacuna::diagnose::{Diagnosis, Finding, Outlook, Planner, Watch};
use lacuna::file::{save_with, write_text};
use lacuna::report::{Beside, Document, Provenance, Report, sentences};
use lacuna::system::System;

/// Files that a diagnosis leaves in its folder.
const MODEL: &str = "extended.toml";
const PAGE: &str = "report.html";
const DOCUMENT: &str = "diagnosis.json";
pub const FILES: [&str; 4] = [PAGE, MODEL, DOCUMENT, reported::STORED];

/// What results are called, where they go, and where they are from.
pub struct Results<'a> {
    pub title: &'a str,
    pub out: &'a Path,
    pub from: Provenance,
}

pub fn run(args: &Args, seed: u64, look: &Console) -> Result<u8, Failure> {
    let apart: Vec<_> = args.test.iter().cloned().collect();
    outputs::distinct(&args.on.data, &[("--test", &apart)])?;
    let mut inputs = outputs::paths(&[&args.on.data, &apart]);
    inputs.push(&args.on.model);
    outputs::check(&inputs, &outputs::within(&args.out, &FILES), look)?;
    let (system, want) = input::model(&args.on.model)?;
    let columns = &args.on.columns;
    let records = input::records(&args.on.data, &want, columns, look)?;
    if columns.repair {
        let names = (0..records.len()).map(|k| args.out.join(input::repaired(k)));
        outputs::apart(&inputs, &names.collect::<Vec<_>>())?;
        fs::create_dir_all(&args.out).map_err(|error| cannot_write(&args.out, &error))?;
        input::keep_repaired(&records, columns, &args.out, look)?;
    }
    let test = args.test.as_ref();
    let test = test.map(|path| input::record(path, &want, columns, look)).transpose()?;
    let mut from = provenance::with(provenance::of_this_call(seed), "model", &args.on.model)?;
    for path in &args.on.data {
        from = provenance::with(from, "data", path)?;
    }
    if let Some(path) = &args.test {
        from = provenance::with(from, "test", path)?;
    }
    let diagnosis = Diagnosis::of(&system)
        .only(&args.only)
        .without(&args.without)
        .fix(&args.fix)
        .max_causes(args.max_causes)
        .init(input::init(args.init));
    let title = args.on.model.display().to_string();
    let results = Results { title: &title, out: &args.out, from };
    look_for(&diagnosis, &records, test.as_ref(), results, look)
}

/// The experiments that would tell look-alikes apart, where there are some.
fn outlook(
    finding: &Finding,
    system: &System,
    records: &[Record],
    look: &Console,
) -> Option<Outlook> {
    let mut effects = vec![];
    for cause in finding.causes.iter().filter(|cause| !cause.indistinguishable.is_empty()) {
        effects.push(cause.effect.clone());
        effects.extend(cause.indistinguishable.iter().map(|other| other.effect.clone()));
    }
    if effects.is_empty() || look.stopped() {
        return None;
    }
    effects.sort();
    effects.dedup();
    // a report without it is a report all the same
    Planner::of(system).only(&effects).run(records, look).ok()
}

/// Runs a diagnosis, writes its files and says what it found.
pub fn look_for(
    diagnosis: &Diagnosis<'_>,
    records: &[Record],
    test: Option<&Record>,
    results: Results<'_>,
    look: &Console,
) -> Result<u8, Failure> {
    let Results { title, out, from } = results;
    // a folder that cannot be made is better known before the work than after it
    fs::create_dir_all(out).map_err(|error| cannot_write(out, &error))?;
    look.hear_interrupts()?;
    let finding = diagnosis.run(records, test, look)?;
    let outlook = outlook(&finding, diagnosis.system(), records, look);
    look.clear();
    let headline = sentences::headline(&finding);
    let mut header = vec!["Written by `lacuna diagnose`.".to_string()];
    header.extend(headline.lines().map(str::to_string).chain(from.same()));
    save_with(&finding.extended, &out.join(MODEL), &header)?;
    let mut report = Report::of(&finding).titled(title).from(&from).model(diagnosis.system());
    if let Some(outlook) = &outlook {
        report = report.outlook(outlook);
    }
    reported::write(&report.page(), out, PAGE)?;
    let beside = Beside { extended_model: MODEL, report: PAGE };
    let document = Document::of(&finding, beside, &from).text().map_err(Failure::unwritable)?;
    let json = out.join(DOCUMENT);
    write_text(&json, &document).map_err(|error| cannot_write(&json, &error))?;
    tell(&finding, out, look);
    if look.json {
        print(&document);
    }
    Ok(0)
}

fn tell(finding: &Finding, out: &Path, look: &Console) {
    if finding.interrupted {
        look.result("Interrupted: this is what was known.");
    }
    look.headline(&sentences::headline(finding));
    for line in sentences::details(finding) {
        look.result(&line);
    }
    look.introduce(&format!(
        "Wrote {PAGE}, {MODEL} and {DOCUMENT} into {} ({:.1} s)",
        out.display(),
        finding.seconds
    ));
}
