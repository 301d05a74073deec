//! `lacuna check`.

use serde_json::json;

use super::args::Check;
use super::console::Console;
use super::failure::Failure;
use super::input;
use super::outputs;
use lacuna::diagnose::Diagnosis;
use lacuna::digits::number;
use lacuna::report::{cause_document, sentences};

/// Exit status where the data reject the model.
const REJECTED: u8 = 3;

pub fn run(args: &Check, look: &Console) -> Result<u8, Failure> {
    outputs::distinct(&args.on.data, &[])?;
    let (system, want) = input::model(&args.on.model)?;
    let records = input::records(&args.on.data, &want, &args.on.columns, look)?;
    look.hear_interrupts()?;
    let checked = Diagnosis::of(&system).max_causes(1).check(&records, look)?;
    look.clear();
    let rejected = checked.p_value < args.level;
    let p = number(checked.p_value, None);
    look.headline(&if rejected {
        format!("These data reject the model (p = {p}, level {}).", args.level)
    } else {
        format!("These data do not reject the model (p = {p}, level {}).", args.level)
    });
    let first = checked.first_cause.as_ref();
    let document_of = |cause| cause_document(cause).map_err(Failure::unwritable);
    if let Some(cause) = first {
        look.result(&sentences::cause(cause));
    }
    let mut document = json!({
        "schema": 1,
        "rejected": rejected,
        "p_value": checked.p_value,
        "level": args.level,
        "first_cause": first.map(document_of).transpose()?,
    });
    if checked.interrupted {
        document["interrupted"] = json!(true);
    }
    look.document(&document);
    Ok(if rejected { REJECTED } else { 0 })
}
