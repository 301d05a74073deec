//! Model files and records as the commands take them.

use std::path::{Path, PathBuf};

use super::args::Columns;
use super::console::Console;
use super::failure::Failure;
use lacuna::data::{DataError, Record, Remark, Table, Want};
use lacuna::evaluate::{Init, want};
use lacuna::fault::Place;
use lacuna::file::load;
use lacuna::system::System;

/// A system and what it wants of a record.
pub fn model(path: &Path) -> Result<(System, Want), Failure> {
    if path == Path::new("-") {
        let place = Place { key: Some("--model".into()), ..Place::default() };
        let message = "a model is not read from standard input";
        let hint = "give --model a file; --data may be -";
        return Err(Failure::call_refused(message.into(), place, hint.into()));
    }
    let system = load(path)?;
    let want = want(&system)?;
    Ok((system, want))
}

/// The tables in a file; `-` is the standard input.
pub fn tables(path: &Path) -> Result<Vec<Table>, Failure> {
    if path == Path::new("-") {
        return Ok(Table::read_all(std::io::stdin().lock(), "standard input")?);
    }
    Ok(Table::open_all(path)?)
}

/// The only table in a file.
pub fn table(path: &Path) -> Result<Table, Failure> {
    let mut tables = tables(path)?;
    match (tables.len(), tables.pop()) {
        (1, Some(table)) => Ok(table),
        (count, _) => {
            let file = Some(path.display().to_string());
            let at = Box::new(Place { file, ..Place::default() });
            Err(DataError::Several { at, count }.into())
        }
    }
}

/// A record; what was noticed in it is said.
pub fn record(
    path: &Path,
    want: &Want,
    columns: &Columns,
    look: &Console,
) -> Result<Record, Failure> {
    let (record, remarks) = table(path)?.record_by(want, &columns.reading())?;
    say_remarks(path, &remarks, look);
    Ok(record)
}

/// All records of some files.
pub fn records(
    paths: &[PathBuf],
    want: &Want,
    columns: &Columns,
    look: &Console,
) -> Result<Vec<Record>, Failure> {
    let mut records = Vec::new();
    for path in paths {
        for table in tables(path)? {
            let (record, remarks) = table.record_by(want, &columns.reading())?;
            say_remarks(path, &remarks, look);
            records.push(record);
        }
    }
    Ok(records)
}

/// Name of the k-th repaired record, from 0.
pub fn repaired(k: usize) -> String {
    if k == 0 { "repaired.csv".into() } else { format!("repaired-{}.csv", k + 1) }
}

/// Writes repaired records into a folder: repaired.csv, repaired-2.csv..
pub fn keep_repaired(
    records: &[Record],
    columns: &Columns,
    folder: &Path,
    look: &Console,
) -> Result<(), Failure> {
    if !columns.repair {
        return Ok(());
    }
    for (k, record) in records.iter().enumerate() {
        let name = repaired(k);
        record.write_csv(folder.join(&name))?;
        look.say(&format!("Wrote {name} into {}", folder.display()));
    }
    Ok(())
}

/// A record that need not hold outputs.
pub fn record_to_simulate(
    path: &Path,
    want: &Want,
    columns: &Columns,
    look: &Console,
) -> Result<Record, Failure> {
    let (record, remarks) = table(path)?.record_to_simulate(want, &columns.reading())?;
    say_remarks(path, &remarks, look);
    Ok(record)
}

/// Says what was noticed in a record.
pub fn say_remarks(path: &Path, remarks: &[Remark], look: &Console) {
    for remark in remarks {
        look.say(&format!("{}: {remark}", path.display()));
    }
}

/// How initial states are found.
pub fn init(samples: Option<usize>) -> Init {
    samples.map_or(Init::Forgotten, Init::Samples)
}

/// Refuses a file in a folder that is not there, before the work rather than after it.
pub fn writable(path: &Path) -> Result<(), Failure> {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => {
            let folder = folder.display();
            Err(Failure::work(format!("{}: there is no folder {folder}", path.display())))
        }
        _ => Ok(()),
    }
}
