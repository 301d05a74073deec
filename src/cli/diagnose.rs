//! `lacuna diagnose`.

use std::fs;
use std::path::Path;

use super::args::Diagnose as Args;
use super::console::{Console, print};
use super::failure::Failure;
use super::no_model::Asked;
use super::outputs::{self, cannot_write};
use super::{input, provenance, reported};
use lacuna::data::Record;
use lacuna::diagnose::{Diagnosis, Finding, Planner, Watch};
use lacuna::estimate::linear_baseline;
use lacuna::file::{save_with, write_text};
use lacuna::report::{Document, FileNames, Provenance, Report, sentences};
use lacuna::study::{Rehearsal, Rehearsed};
use lacuna::system::System;

/// Files that a diagnosis leaves in its folder.
const MODEL: &str = "extended.toml";
const PAGE: &str = "report.html";
const DOCUMENT: &str = "diagnosis.json";
/// The model that is made where none is given.
const LINEAR: &str = "linear.toml";
pub const FILES: [&str; 4] = [PAGE, MODEL, DOCUMENT, reported::STORED];

/// What results are called, where they go, and where they are from.
pub struct Results<'a> {
    pub title: &'a str,
    pub out: &'a Path,
    pub from: Provenance,
    /// How many rehearsals, and which share of them.
    pub rehearse: (usize, (usize, usize)),
}

pub fn run(args: &Args, seed: u64, look: &Console) -> Result<u8, Failure> {
    let apart: Vec<_> = args.test.iter().cloned().collect();
    outputs::distinct(&args.data, &[("--test", &apart)])?;
    let mut inputs = outputs::paths(&[&args.data, &apart]);
    inputs.extend(args.model.as_deref());
    let mut files = FILES.to_vec();
    files.extend(args.model.is_none().then_some(LINEAR));
    outputs::check(&inputs, &outputs::within(&args.out, &files), look)?;
    let columns = &args.columns;
    let asked = Asked { columns, step: args.sampling_time, order: None };
    let (own, records) = match &args.model {
        Some(path) => {
            let (system, want) = input::model(path)?;
            let records = input::records(&args.data, &want, columns, look)?;
            (Some((system, want)), records)
        }
        None => (None, asked.records(&args.data, look)?),
    };
    if columns.repair {
        let names = (0..records.len()).map(|k| args.out.join(input::repaired(k)));
        outputs::apart(&inputs, &names.collect::<Vec<_>>())?;
        fs::create_dir_all(&args.out).map_err(|error| cannot_write(&args.out, &error))?;
        input::keep_repaired(&records, columns, &args.out, look)?;
    }
    let test = match (&args.test, &own) {
        (Some(path), Some((_, want))) => Some(input::record(path, want, columns, look)?),
        (Some(path), None) => asked.records(std::slice::from_ref(path), look)?.into_iter().next(),
        (None, _) => None,
    };
    let mut from = provenance::of_this_call(seed);
    if let Some(path) = &args.model {
        from = provenance::with(from, "model", path)?;
    }
    for path in &args.data {
        from = provenance::with(from, "data", path)?;
    }
    if let Some(path) = &args.test {
        from = provenance::with(from, "test", path)?;
    }
    // everything that can be written is known to be so before the first long work
    fs::create_dir_all(&args.out).map_err(|error| cannot_write(&args.out, &error))?;
    look.hear_interrupts()?;
    let system = match own {
        Some((system, _)) => system,
        None => linear_of(&records, test.is_some(), &args.out, look)?,
    };
    let diagnosis = Diagnosis::of(&system)
        .only(&args.only)
        .without(&args.without)
        .fix(&args.fix)
        .max_causes(args.max_causes)
        .sensor_noise_only(args.sensor_noise_only)
        .memory(args.memory.unwrap_or_default())
        .init(input::init(args.init));
    let title = match &args.model {
        Some(path) => path.display().to_string(),
        None => "a linear model of the record".into(),
    };
    let rehearse = (args.rehearse, args.shard.unwrap_or((1, 1)));
    let results = Results { title: &title, out: &args.out, from, rehearse };
    finish(&diagnosis, &records, test.as_ref(), results, look)
}

/// The linear model that is diagnosed where there is no other; what it is, is said.
fn linear_of(
    records: &[Record],
    has_test: bool,
    out: &Path,
    look: &Console,
) -> Result<System, Failure> {
    look.part(0.0, 0.2);
    let (found, share) = linear_baseline(records, has_test, look)?;
    look.part(0.2, 1.0);
    let header = ["Written by `lacuna diagnose`: a linear model of the record.".to_string()];
    save_with(&found.system, &out.join(LINEAR), &header)?;
    look.result(&format!(
        "No model was given: this is about a linear one of order {}, estimated from the first {:.0} % of \
         the data ({LINEAR}). Its states are coordinates of the fit and mean nothing by themselves.",
        found.order,
        100.0 * share
    ));
    for remark in &found.remarks {
        look.result(remark);
    }
    Ok(found.system)
}

/// Runs a diagnosis, writes its files and says what it found.
pub fn look_for(
    diagnosis: &Diagnosis<'_>,
    records: &[Record],
    test: Option<&Record>,
    results: Results<'_>,
    look: &Console,
) -> Result<u8, Failure> {
    // a folder that cannot be made is better known before the work than after it
    fs::create_dir_all(results.out).map_err(|error| cannot_write(results.out, &error))?;
    look.hear_interrupts()?;
    finish(diagnosis, records, test, results, look)
}

/// The same, where the folder is there and interrupts are heard.
fn finish(
    diagnosis: &Diagnosis<'_>,
    records: &[Record],
    test: Option<&Record>,
    results: Results<'_>,
    look: &Console,
) -> Result<u8, Failure> {
    let Results { title, out, from, rehearse } = results;
    if rehearse.0 > 0 {
        look.part(0.0, 0.05);
    }
    let finding = diagnosis.run(records, test, look)?;
    let outlook = Planner::for_look_alikes(&finding, diagnosis.system(), records, look);
    look.part(0.05, 1.0);
    let rehearsed = rehearsed(diagnosis, &finding, records, (rehearse, from.seed), out, look)?;
    look.clear();
    let headline = sentences::headline(&finding);
    let mut header = vec!["Written by `lacuna diagnose`.".to_string()];
    header.extend(headline.lines().map(str::to_string).chain(from.same()));
    save_with(&finding.extended, &out.join(MODEL), &header)?;
    let mut report = Report::of(&finding).titled(title).from(&from).model(diagnosis.system());
    if let Some(outlook) = &outlook {
        report = report.outlook(outlook);
    }
    let mut page = report.page();
    let files = FileNames { extended_model: MODEL, report: PAGE };
    let mut document = Document::of(&finding, files, &from);
    if let Some(rehearsed) = &rehearsed {
        rehearsed.section(&mut page);
        document = document.with("rehearsal", rehearsed).map_err(Failure::unwritable)?;
    }
    reported::write(&page, out, PAGE)?;
    let document = document.text().map_err(Failure::unwritable)?;
    let json = out.join(DOCUMENT);
    write_text(&json, &document).map_err(|error| cannot_write(&json, &error))?;
    summarise(&finding, rehearsed.as_ref(), out, look);
    if look.json {
        print(&document);
    }
    Ok(0)
}

/// Rehearses what was found, where that is asked for.
fn rehearsed(
    diagnosis: &Diagnosis<'_>,
    finding: &Finding,
    records: &[Record],
    ((count, shard), seed): ((usize, (usize, usize)), u64),
    out: &Path,
    look: &Console,
) -> Result<Option<Rehearsed>, Failure> {
    if count == 0 || look.stopped() {
        return Ok(None);
    }
    let rehearsal = Rehearsal::of(diagnosis, finding, records, seed)?;
    let done = rehearsal.run(count, shard, out, look)?;
    if done < count {
        look.say(&format!(
            "{done} of {count} rehearsals are done; the same call without --shard does the rest."
        ));
    }
    Ok(Some(rehearsal.summary(count, out)?))
}

fn summarise(finding: &Finding, rehearsed: Option<&Rehearsed>, out: &Path, look: &Console) {
    if finding.interrupted {
        look.result(sentences::INTERRUPTED);
    }
    look.headline(&sentences::headline(finding));
    let rehearsed = rehearsed.map(Rehearsed::sentences).unwrap_or_default();
    for line in sentences::details(finding).into_iter().chain(rehearsed) {
        look.result(&line);
    }
    look.introduce(&format!(
        "Wrote {PAGE}, {MODEL} and {DOCUMENT} into {} ({:.1} s)",
        out.display(),
        finding.seconds
    ));
}
