//! `lacuna plan`.

use super::args::Plan as Args;
use super::console::Console;
use super::failure::Failure;
use super::input;
use lacuna::diagnose::Planner;
use lacuna::report::sentences;

pub fn run(args: &Args, look: &Console) -> Result<u8, Failure> {
    let (system, want) = input::model(&args.on.model)?;
    let records = input::records(&args.on.data, &want, &args.on.columns, look)?;
    look.hear_interrupts()?;
    let outlook = Planner::of(&system).fix(&args.fix).run(&records, look)?;
    look.clear();
    for cause in &outlook.causes {
        look.detail(&sentences::visibility(cause));
    }
    for pair in &outlook.look_alikes {
        look.detail(&sentences::pair(pair));
    }
    look.result(&sentences::outlook(&outlook));
    let document = serde_json::to_value(&outlook)
        .map_err(|error| Failure::work(format!("the result cannot be written: {error}")))?;
    look.document(&document);
    Ok(0)
}
