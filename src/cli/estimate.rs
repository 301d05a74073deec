//! `lacuna estimate`.

use super::args::Estimate as Args;
use super::console::Console;
use super::failure::Failure;
use super::input;
use super::outputs;
use super::stdout;
use lacuna::diagnose::Diagnosis;
use lacuna::digits::{estimated, number};
use lacuna::estimate::{Estimated, estimate_by, estimate_with};
use lacuna::file::{Document, Format};
use lacuna::optimise::Named;
use lacuna::report::{documents, sentences};

pub fn run(args: &Args, seed: u64, look: &Console) -> Result<u8, Failure> {
    outputs::distinct(&args.data, &[])?;
    let mut inputs = outputs::paths(&[&args.data]);
    inputs.extend(args.model.as_deref());
    let piped = stdout::given_to(&args.out, look)?;
    if !piped {
        outputs::check(&inputs, std::slice::from_ref(&args.out), look)?;
        input::writable(&args.out)?;
    }
    let Some(model) = &args.model else { return super::linear::run(args, look) };
    let (system, want) = input::model(model)?;
    let records = input::records(&args.data, &want, &args.columns, look)?;
    look.hear_interrupts()?;
    // what cannot be simulated with its present values yet is fitted to the records as they are
    let (records, faults) =
        Diagnosis::of(&system).data_faults(&records).unwrap_or((records, vec![]));
    for fault in &faults {
        look.result(&sentences::cause(fault));
    }
    let estimate = match &args.optimiser {
        None => estimate_with(&system, &records, &args.fix, seed, look)?,
        Some(text) => {
            let Named(optimiser) = named(text)?;
            estimate_by(&system, &records, &args.fix, optimiser.as_ref(), seed, look)?
        }
    };
    look.clear();
    stdout::model(&estimate.system, &args.out, "Written by `lacuna estimate`.")?;
    for parameter in &estimate.parameters {
        look.result(&line(parameter));
    }
    for combination in &estimate.undetermined {
        look.result(&format!("The record cannot tell: {}", combination.text));
    }
    if let Some(length) = estimate.stretch {
        look.result(&format!(
            "The model does not forget where it starts: the record was cut into stretches of {length} \
             samples with starts of their own"
        ));
    }
    let (before, after) = estimate.nrmse;
    look.result(&format!("NRMSE {before:.4} before, {after:.4} after"));
    if !piped {
        look.say(&format!("Wrote {}", args.out.display()));
    }
    let file = args.out.display().to_string();
    let document = documents::estimated(&estimate, Some(&file), &faults);
    look.document(&document.map_err(Failure::unwritable)?);
    Ok(0)
}

/// A parameter, and why it has no interval where it has none.
fn line(p: &Estimated) -> String {
    let value = estimated(p.value, p.std_error, &p.unit);
    let why = match p.std_error {
        Some(_) => "",
        None if p.at_bound => " (at its bound)",
        None => " (the record does not tell)",
    };
    format!("{} = {value}{why} (was {})", p.name, number(p.from, None))
}

/// An optimiser by its name, its settings, or a file with these.
fn named(text: &str) -> Result<Named, Failure> {
    let path = std::path::Path::new(text);
    let document = if path.is_file() {
        Document::load(path)?
    } else {
        let is_name = text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        let text = if is_name { format!("[{text}]") } else { text.to_string() };
        Document::parse(&text, "--optimiser", Format::Toml)?
    };
    Ok(document.read()?)
}
