//! `lacuna new`: a commented model file to begin with.
//!
//! Of a registered model it is its example with what its names mean. Of a record it is a chain
//! of derivatives for each output,
//!
//! ```text
//! y^(n) + a_{n-1} y^(n-1) + .. + a_0 y = sum_j b_j u_j
//! ```
//!
//! whose poles lie, n times, at the frequency w below which half of the output's power is, and
//! whose gain is the ratio of the standard deviations: a start for `lacuna estimate`, no estimate.

use std::fmt::Write;

use serde_json::json;

use super::args::New as Args;
use super::console::{Console, print};
use super::failure::Failure;
use super::no_model::Asked;
use super::outputs::{self, cannot_write};
use super::stdout;
use lacuna::data::{Record, Signal};
use lacuna::fault::{Place, nearest};
use lacuna::file::{Format, parse, write_text};
use lacuna::look::Look;
use lacuna::register::{self, PlugIn};

/// Names that mean something in expressions.
const RESERVED: [&str; 19] = [
    "time", "pi", "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh",
    "exp", "log", "sqrt", "abs", "sign", "min", "max",
];

pub fn run(args: &Args, look: &Console) -> Result<u8, Failure> {
    let text = match (&args.model, &args.data) {
        (Some(name), _) => of_plug_in(name)?,
        (None, Some(path)) => {
            let asked =
                Asked { columns: &args.columns, step: args.sampling_time, order: Some(args.order) };
            let records = asked.records(std::slice::from_ref(path), look)?;
            match records.first() {
                Some(record) => of_record(record, args.order),
                None => return Err(Failure::work(format!("{}: no record", path.display()))),
            }
        }
        (None, None) => return Err(Failure::work("neither a model nor a record was named".into())),
    };
    // what cannot be loaded helps nobody
    parse(&text, "the new model", Format::Toml)?;
    let piped = args.out.as_deref().map_or(Ok(false), |out| stdout::given_to(out, look))?;
    match &args.out {
        Some(path) if !piped => {
            let inputs: Vec<_> = args.data.iter().cloned().collect();
            outputs::check(&outputs::paths(&[&inputs]), std::slice::from_ref(path), look)?;
            write_text(path, &text).map_err(|error| cannot_write(path, &error))?;
            look.introduce(&format!("Wrote {}", path.display()));
        }
        _ if !look.json => print(&text),
        _ => {}
    }
    look.document(&json!({ "schema": 1, "model": text, "written": args.out }));
    Ok(0)
}

/// The example of a registered model, with what its names mean.
fn of_plug_in(name: &str) -> Result<String, Failure> {
    let cards = register::models();
    let names = || cards.iter().map(|card| card.name);
    let Some(card) = cards.iter().find(|card| card.name == name) else {
        let known: Vec<&str> = names().collect();
        let hint = match nearest(name, names()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("there are: {}", known.join(", ")),
        };
        let place = Place { key: Some(name.into()), ..Place::default() };
        return Err(Failure::call_refused(format!("no model is called `{name}`"), place, hint));
    };
    let PlugIn::Model { example } = card.plug_in else {
        return Err(Failure::work(format!("`{name}` is no model")));
    };
    let mut text = format!(
        "# Written by `lacuna new`: {}.\n\
         # Put in your own numbers; then: lacuna diagnose --model THIS.toml --data RECORD.csv\n\n\
         sampling_time = 0.01      # s, for records without a column `time`\n",
        card.summary
    );
    let body = format!("[model.{name}]\n{}\n", example.trim());
    if let Ok(system) = parse(&format!("sampling_time = 0.01\n{body}"), name, Format::Toml) {
        let signals = system.signals();
        if signals.time.is_continuous() {
            text += "integrator = { method = \"rk4\", substeps = 4 }\n\
                     hold = \"zero\"             # inputs between samples; \"first\": straight lines\n";
        }
        text += "\n";
        let listed = |signals: Vec<(String, String)>| -> String {
            let one = |(name, unit): (String, String)| match unit.as_str() {
                "" => name,
                unit => format!("{name} [{unit}]"),
            };
            signals.into_iter().map(one).collect::<Vec<_>>().join(", ")
        };
        let pairs = |signals: &[lacuna::model::Signal]| {
            signals.iter().map(|s| (s.name.clone(), s.unit.clone())).collect()
        };
        let parameters = signals.parameters.iter().map(|p| (p.name.clone(), p.unit.clone()));
        for (what, names) in [
            ("inputs, columns of the record", listed(pairs(&signals.inputs))),
            ("outputs, columns of the record", listed(pairs(&signals.outputs))),
            ("parameters", listed(parameters.collect())),
            ("where something unmodelled may enter", listed(pairs(&signals.own_channels()))),
            ("what it may depend on", listed(pairs(&signals.own_coordinates()))),
        ] {
            let _ = writeln!(text, "# {what}: {names}");
        }
        text += "# fixed = [\"..\"] within the model holds parameters that are known\n";
    }
    Ok(text + &body)
}

/// A name that expressions can use.
fn identifier(name: &str, taken: &mut Vec<String>) -> String {
    let mut own: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if !own.starts_with(|c: char| c.is_ascii_alphabetic()) {
        own.insert_str(0, "x_");
    }
    while RESERVED.contains(&own.as_str()) || taken.contains(&own) {
        own.push('_');
    }
    taken.push(own.clone());
    own
}

/// A text as TOML has it.
fn quoted(text: &str) -> String {
    serde_json::to_string(text).unwrap_or_default()
}

/// Three digits of a start.
fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    format!("{rounded:?}")
}

/// A unit over time to a power; nothing where none is stated.
fn per_time(unit: &str, power: usize) -> String {
    match (unit, power) {
        ("", _) => String::new(),
        (unit, 0) => unit.into(),
        (unit, 1) => format!("{unit}/s"),
        (unit, power) => format!("{unit}/s^{power}"),
    }
}

/// A chain of derivatives for each output of a record.
fn of_record(record: &Record, order: usize) -> String {
    let mut taken = vec![];
    let mut own = |signals: &[Signal]| -> Vec<String> {
        signals.iter().map(|signal| identifier(&signal.name, &mut taken)).collect()
    };
    let (inputs, outputs) = (own(&record.inputs), own(&record.outputs));
    let look = Look::of(record);
    let (mut states, mut parameters, mut channels) = (String::new(), String::new(), String::new());
    for (output, name) in record.outputs.iter().zip(&outputs) {
        let rate = rate(&look, &output.name, record);
        let suffix = if outputs.len() > 1 { format!("_{name}") } else { String::new() };
        let state = |k: usize, taken: &mut Vec<String>| {
            identifier(
                &if k == 0 { format!("{name}_state") } else { format!("{name}_d{k}") },
                taken,
            )
        };
        let chain: Vec<String> = (0..order).map(|k| state(k, &mut taken)).collect();
        let mut terms = String::new();
        for (j, (input, signal)) in inputs.iter().zip(&record.inputs).enumerate() {
            let gain = identifier(&format!("b{}{suffix}", j + 1), &mut taken);
            let ratio = output.std() / signal.std();
            let ratio = if ratio.is_finite() && ratio > 0.0 { ratio } else { 1.0 };
            let start = ratio * rate.powi(order as i32);
            let unit = match (output.unit.as_str(), signal.unit.as_str()) {
                ("", _) | (_, "") => String::new(),
                (y, u) => format!("{}/({u})", per_time(y, order)),
            };
            let _ = writeln!(
                parameters,
                "  {{ name = {}, value = {}, unit = {} }},",
                quoted(&gain),
                short(start),
                quoted(&unit)
            );
            let sign = if terms.is_empty() { "" } else { " + " };
            let _ = write!(terms, "{sign}{gain}*{input}");
        }
        if terms.is_empty() {
            terms += "0";
        }
        for k in (0..order).rev() {
            let name = identifier(&format!("a{k}{suffix}"), &mut taken);
            // (s + w)^n
            let binomial = (0..k).fold(1.0, |b, i| b * (order - i) as f64 / (i + 1) as f64);
            let start = binomial * rate.powi((order - k) as i32);
            let unit = if order - k == 1 { "1/s".into() } else { format!("1/s^{}", order - k) };
            let _ = writeln!(
                parameters,
                "  {{ name = {}, value = {}, unit = {} }},",
                quoted(&name),
                short(start),
                quoted(&unit)
            );
            let _ = write!(terms, " - {name}*{}", chain[k]);
        }
        for (k, state) in chain.iter().enumerate() {
            let derivative = chain.get(k + 1).cloned().unwrap_or_else(|| terms.clone());
            let first = output.values.iter().copied().find(|value| value.is_finite());
            let initial = if k == 0 { first.unwrap_or(0.0) } else { 0.0 };
            let _ = writeln!(
                states,
                "  {{ name = {}, unit = {}, derivative = {}, initial = {initial:?} }},",
                quoted(state),
                quoted(&per_time(&output.unit, k)),
                quoted(&derivative)
            );
        }
        if let Some(last) = chain.last() {
            let channel = identifier(&format!("into_{name}"), &mut taken);
            let _ = writeln!(
                channels,
                "  {{ name = {}, unit = {}, into = [{{ state = {}, gain = \"1\" }}] }},",
                quoted(&channel),
                quoted(&per_time(&output.unit, order)),
                quoted(last)
            );
        }
    }
    let signal =
        |name: &String, unit: &str| format!("{{ name = {}, unit = {}", quoted(name), quoted(unit));
    let drives: Vec<String> =
        inputs.iter().zip(&record.inputs).map(|(name, s)| signal(name, &s.unit) + " }").collect();
    let renamed: Vec<String> = inputs
        .iter()
        .chain(&outputs)
        .zip(record.signals())
        .filter(|(name, signal)| **name != signal.name)
        .map(|(name, signal)| format!("{}={name}", signal.name))
        .collect();
    let measured: Vec<String> = outputs
        .iter()
        .zip(&record.outputs)
        .map(|(name, s)| {
            let mut known = taken.iter().filter(|t| t.starts_with(&format!("{name}_state")));
            let state = known.next().cloned().unwrap_or_else(|| name.clone());
            format!("{}, value = {} }}", signal(name, &s.unit), quoted(&state))
        })
        .collect();
    let rename = match renamed.as_slice() {
        [] => String::new(),
        pairs => {
            format!("# Columns have other names here: --rename {}\n", quoted(&pairs.join(",")))
        }
    };
    format!(
        "# Written by `lacuna new` from {source}.\n\
         # A start, no estimate: put your machine's equations in the place of these, or fit them:\n\
         #   lacuna estimate --model THIS.toml --data RECORD --out fitted.toml\n\
         {rename}\n\
         sampling_time = {step:?}      # s, the record's\n\
         integrator = {{ method = \"rk4\", substeps = 4 }}\n\n\
         [model.equations]\n\
         inputs = [{drives}]\n\
         # one equation a state: derivative = .. in states, inputs, parameters and time\n\
         states = [\n{states}]\n\
         outputs = [{measured}]\n\
         # `fixed = true` holds a parameter that is known; `min`, `max` bound it\n\
         parameters = [\n{parameters}]\n\
         # where something unmodelled may enter\n\
         channels = [\n{channels}]\n",
        source = record.source.replace(char::is_control, " "),
        step = record.sampling_time,
        drives = drives.join(", "),
        measured = measured.join(", "),
    )
}

/// Middle of the output's band as a rate, rad/s; a twentieth of the samples' where there is none.
fn rate(look: &Look, output: &str, record: &Record) -> f64 {
    let signal = look.signals.iter().find(|signal| !signal.is_input && signal.name == output);
    let fallback = std::f64::consts::TAU * 0.05 / record.sampling_time;
    signal
        .and_then(|signal| signal.band)
        .map_or(fallback, |[low, high]| std::f64::consts::TAU * (low.max(1e-12) * high).sqrt())
}
