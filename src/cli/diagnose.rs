//! `lacuna diagnose`.

use std::fs;
use std::path::Path;

use super::args::Diagnose as Args;
use super::console::{Console, print};
use super::failure::Failure;
use super::input;
use lacuna::data::Record;
pub use lacuna::diagnose::{Diagnosis, Finding, number};
use lacuna::file::save_with;
use lacuna::report::Report;
use lacuna::system::System;

pub fn run(args: &Args, look: &Console) -> Result<u8, Failure> {
    let (system, want) = input::model(&args.on.model)?;
    let columns = &args.on.columns;
    let records = input::records(&args.on.data, &want, columns, look)?;
    if columns.repair {
        fs::create_dir_all(&args.out).map_err(|error| cannot_write(&args.out, &error))?;
        input::keep_repaired(&records, columns, &args.out, look)?;
    }
    let test = args.test.as_ref();
    let test = test.map(|path| input::record(path, &want, columns, look)).transpose()?;
    let diagnosis = Diagnosis::of(&system)
        .only(&args.only)
        .without(&args.without)
        .fix(&args.fix)
        .max_causes(args.max_causes)
        .init(input::init(args.init));
    let title = args.on.model.display().to_string();
    look_for(&diagnosis, &system, &records, test.as_ref(), &title, &args.out, look)
}

/// Runs a diagnosis, writes its files and says what it found.
pub fn look_for(
    diagnosis: &Diagnosis<'_>,
    system: &System,
    records: &[Record],
    test: Option<&Record>,
    title: &str,
    out: &Path,
    look: &Console,
) -> Result<u8, Failure> {
    // a folder that cannot be made is better known before the work than after it
    fs::create_dir_all(out).map_err(|error| cannot_write(out, &error))?;
    look.hear_interrupts()?;
    let finding = diagnosis.run(records, test, look)?;
    look.clear();
    let units: Vec<(String, String)> =
        system.signals().outputs.iter().map(|s| (s.name.clone(), s.unit.clone())).collect();
    let header: Vec<String> = finding.to_string().lines().map(str::to_string).collect();
    save_with(&finding.extended, &out.join(&finding.extended_model), &header)?;
    let page = out.join(&finding.report);
    Report::of(&finding).titled(title).write(&page).map_err(|error| cannot_write(&page, &error))?;
    let document = serde_json::to_string_pretty(&finding)
        .map_err(|error| Failure::work(format!("the result cannot be written: {error}")))?
        + "\n";
    let json = out.join("diagnosis.json");
    fs::write(&json, &document).map_err(|error| cannot_write(&json, &error))?;
    tell(&finding, &units, out, look);
    if look.json {
        print(&document);
    }
    Ok(0)
}

fn tell(finding: &Finding, units: &[(String, String)], out: &Path, look: &Console) {
    if finding.interrupted {
        look.result("Interrupted: this is what was known.");
    }
    look.headline(&finding.to_string());
    for cause in &finding.causes {
        let others: Vec<String> = cause.indistinguishable.iter().map(ToString::to_string).collect();
        if !others.is_empty() {
            look.result(&format!(
                "  the data cannot tell {} from: {}",
                cause.effect,
                others.join("; ")
            ));
        }
    }
    for (name, before) in &finding.before.test {
        let Some(after) = finding.after.test.get(name).filter(|_| !finding.causes.is_empty())
        else {
            continue;
        };
        let unit = units.iter().find(|(n, _)| n == name).map_or("", |(_, unit)| unit);
        look.result(&format!(
            "{name}: test RMSE {} -> {} {unit}",
            number(before.rmse, None),
            number(after.rmse, None)
        ));
    }
    for remark in &finding.remarks {
        look.result(remark);
    }
    look.result(&format!(
        "Wrote {}, {} and diagnosis.json into {} ({:.1} s)",
        finding.report,
        finding.extended_model,
        out.display(),
        finding.seconds
    ));
}

fn cannot_write(path: &Path, error: &std::io::Error) -> Failure {
    Failure::work(format!("{}: cannot be written ({error})", path.display()))
}
