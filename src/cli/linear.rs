//! `lacuna estimate --lti`.

use std::path::Path;

use serde_json::json;

use super::args::Estimate as Args;
use super::console::Console;
use super::failure::Failure;
use super::input;
use lacuna::data::{DataError, Record, Step, Table, Want};
use lacuna::diagnose::number;
use lacuna::estimate::{LinearEstimate, LinearParameter, Mode, linear_with};
use lacuna::fault::Place;
use lacuna::file::save;

pub fn run(args: &Args, look: &Console) -> Result<u8, Failure> {
    input::writable(&args.out)?;
    let order = args.lti.flatten();
    let read = |path: &std::path::PathBuf| record(path, args, order, look);
    let records: Vec<Record> = args.data.iter().map(read).collect::<Result<_, _>>()?;
    look.hear_interrupts()?;
    let found = linear_with(&records, order, look)?;
    look.clear();
    save(&found.system, &args.out)?;
    tell(&found, look);
    look.result(&format!("Wrote {}", args.out.display()));
    let (before, after) = found.nrmse;
    let mut document = json!({
        "schema": 1,
        "order": found.order,
        "singular_values": found.singular_values,
        "noise_edge": found.edge,
        "modes": found.modes,
        "parameters": found.parameters,
        "nrmse": { "before": before, "after": after },
        "remarks": found.remarks,
        "model": args.out,
    });
    if found.interrupted {
        document["interrupted"] = json!(true);
    }
    look.document(&document);
    Ok(0)
}

fn tell(found: &LinearEstimate, look: &Console) {
    let values: Vec<String> =
        found.singular_values.iter().take(16).map(|value| number(*value, None)).collect();
    look.detail(&format!("singular values: {}", values.join(", ")));
    look.detail(&format!("{} stand above the noise", number(found.edge, None)));
    look.headline(&format!("A linear model of order {}", found.order));
    for mode in &found.modes {
        look.result(&format!("  {}", words(mode)));
    }
    for parameter in &found.parameters {
        look.result(&line(parameter));
    }
    for remark in &found.remarks {
        look.result(remark);
    }
    let (before, after) = found.nrmse;
    look.result(&format!("NRMSE {before:.4} before the refinement, {after:.4} after"));
}

fn words(mode: &Mode) -> String {
    let [re, im] = mode.pole;
    match (mode.frequency, mode.damping, mode.time_constant) {
        (Some(frequency), Some(damping), _) => format!(
            "poles {re:.6} +- {im:.6}i: {} Hz, damping ratio {}",
            number(frequency, None),
            number(damping, None)
        ),
        (.., Some(time)) => format!("pole {re:.6}: time constant {} s", number(time, None)),
        _ => format!("pole {re:.6}"),
    }
}

fn line(p: &LinearParameter) -> String {
    let value = number(p.value, p.std_error);
    let spread = p.std_error.map_or_else(String::new, |e| format!(" +- {}", number(e, None)));
    format!("{} = {value}{spread} {}", p.name, p.unit).trim_end().to_string()
}

/// A record with the columns that were asked for, or those called `u` and `y`.
fn record(
    path: &Path,
    args: &Args,
    order: Option<usize>,
    look: &Console,
) -> Result<Record, Failure> {
    let table = Table::open(path)?;
    let group = |given: &[String], letter: char, role: &'static str| match given {
        [] => lettered(&table, letter, role),
        _ => Ok(given.to_vec()),
    };
    let inputs = group(&args.inputs, 'u', "inputs")?;
    let outputs = group(&args.outputs, 'y', "outputs")?;
    if let Some(name) = outputs.iter().find(|name| inputs.contains(name)) {
        return Err(Failure::input(
            format!("`{name}` cannot be an input and an output"),
            Place { key: Some(name.clone()), ..Place::default() },
            "name each column once, with --inputs or with --outputs".into(),
        ));
    }
    let pairs = |names: &[String]| names.iter().map(|n| (n.clone(), String::new())).collect();
    let want = Want {
        inputs: pairs(&inputs),
        outputs: pairs(&outputs),
        step: Step::Free { default: args.sampling_time },
        outputs_required: true,
        minimum: 2 * order.unwrap_or(1),
    };
    let (record, remarks) = table.record_for(&want).map_err(in_own_words)?;
    input::tell(path, &remarks, look);
    Ok(record)
}

/// Columns `u`, `u1`, `u2`.. in the order of their numbers.
fn lettered(table: &Table, letter: char, role: &'static str) -> Result<Vec<String>, Failure> {
    let number = |name: &str| match name.strip_prefix(letter)? {
        "" => Some(0),
        digits if digits.bytes().all(|b| b.is_ascii_digit()) => digits.parse::<u32>().ok(),
        _ => None,
    };
    let mut found: Vec<(u32, &str)> =
        table.names().into_iter().filter_map(|name| Some((number(name)?, name))).collect();
    found.sort_unstable();
    if found.is_empty() {
        let known: Vec<&str> =
            table.names().into_iter().filter(|name| !matches!(*name, "" | "time")).collect();
        return Err(Failure::input(
            format!(
                "{}: no column is called {letter} or {letter}1, so the {role} are not known; there are: {}",
                table.source(),
                known.join(", ")
            ),
            Place { file: Some(table.source().into()), ..Place::default() },
            format!("name them: --{role} {}", known.first().unwrap_or(&"COLUMN")),
        ));
    }
    Ok(found.into_iter().map(|(_, name)| name.to_string()).collect())
}

/// There is no model file to change here.
fn in_own_words(error: DataError) -> Failure {
    let hint = match &error {
        DataError::NoSamplingTime { perhaps: Some(name), .. } => format!(
            "rename the column `{name}` to `time`, or state the step in s: --sampling-time 0.01"
        ),
        DataError::NoSamplingTime { .. } => {
            "add a column `time`, or state the step in s: --sampling-time 0.01".into()
        }
        _ => return error.into(),
    };
    Failure::with_hint(&error, hint)
}
