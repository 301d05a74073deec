//! `lacuna check`.

use super::args::Check;
use super::console::Console;
use super::failure::Failure;
use super::input;
use super::outputs;
use lacuna::diagnose::Diagnosis;
use lacuna::digits::number;
use lacuna::report::{documents, sentences};

/// Exit status where somebody stopped the check before it had a verdict.
const NO_VERDICT: u8 = 1;
/// Exit status where the data reject the model.
const REJECTED: u8 = 3;
/// Exit status where the data are at fault in a way that changes what was measured.
const DATA_REJECTED: u8 = 4;

pub fn run(args: &Check, look: &Console) -> Result<u8, Failure> {
    outputs::distinct(&args.on.data, &[])?;
    let (system, want) = input::model(&args.on.model)?;
    let records = input::records(&args.on.data, &want, &args.on.columns, look)?;
    look.hear_interrupts()?;
    let diagnosis = Diagnosis::of(&system).max_causes(1).memory(args.memory.unwrap_or_default());
    let outcome = diagnosis.check(&records, look)?;
    look.clear();
    let rejected = outcome.p_value.map(|p| p < args.level);
    let data_rejected = outcome.rejects_data();
    let p = outcome.p_value.map_or_else(String::new, |p| number(p, None));
    if data_rejected {
        look.headline("These data are at fault: what was measured is not what the machine did.");
    }
    look.headline(&match rejected {
        None => "Interrupted: there is no verdict.".into(),
        Some(true) => format!("These data reject the model (p = {p}, level {}).", args.level),
        Some(false) => {
            format!("These data do not reject the model (p = {p}, level {}).", args.level)
        }
    });
    let first = outcome.first_cause.as_ref();
    let of_the_model = first.filter(|cause| !outcome.data_faults.contains(cause));
    for cause in outcome.data_faults.iter().chain(of_the_model) {
        look.result(&sentences::cause(cause));
    }
    for note in &outcome.notes {
        look.result(&sentences::note(note));
    }
    let document = documents::goodness_of_fit(&outcome, args.level).map_err(Failure::unwritable)?;
    look.document(&document);
    Ok(match rejected {
        None => NO_VERDICT,
        _ if data_rejected => DATA_REJECTED,
        Some(true) => REJECTED,
        Some(false) => 0,
    })
}
