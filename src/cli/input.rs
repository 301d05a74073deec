//! Model files and records as the commands take them.

use std::path::Path;

use super::console::Console;
use super::failure::Failure;
use lacuna::data::{Record, Remark, Step, Table, Want};
use lacuna::evaluate::Init;
use lacuna::file::load;
use lacuna::system::System;

/// A system and what it wants of a record.
pub fn model(path: &Path) -> Result<(System, Want), Failure> {
    let system = load(path)?;
    let want = want(&system)?;
    Ok((system, want))
}

/// What a system wants of a record.
pub fn want(system: &System) -> Result<Want, Failure> {
    let signals = system.signals();
    let pairs = |signals: &[lacuna::model::Signal]| {
        signals.iter().map(|s| (s.name.clone(), s.unit.clone())).collect()
    };
    let step = match (signals.time.is_continuous(), system.sampling.sampling_time) {
        (true, default) => Step::Free { default },
        (false, Some(step)) => Step::Fixed(step),
        (false, None) => Step::Fixed(system.sampling_time(None)?),
    };
    Ok(Want {
        inputs: pairs(&signals.inputs),
        outputs: pairs(&signals.outputs),
        step,
        outputs_required: true,
        minimum: 2 * signals.states.len().max(1),
    })
}

/// A record; what was noticed in it is said.
pub fn record(path: &Path, want: &Want, look: &Console) -> Result<Record, Failure> {
    let (record, remarks) = Table::open(path)?.record_for(want)?;
    tell(path, &remarks, look);
    Ok(record)
}

/// A record that need not hold outputs. A file with columns left over lacks none on purpose.
pub fn record_to_simulate(path: &Path, want: &Want, look: &Console) -> Result<Record, Failure> {
    let table = Table::open(path)?;
    let (record, remarks) = table.record_for(&Want { outputs_required: false, ..want.clone() })?;
    let absent = remarks.iter().any(|r| matches!(r, Remark::AbsentOutputs { .. }));
    let extra = remarks.iter().any(|r| matches!(r, Remark::ExtraColumns { .. }));
    if absent && extra {
        table.record_for(want)?;
    }
    tell(path, &remarks, look);
    Ok(record)
}

/// Says what was noticed in a record.
pub fn tell(path: &Path, remarks: &[Remark], look: &Console) {
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
