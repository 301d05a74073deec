//! Draws the picture of the README: what the demo's model lacks, against the speed.
//!
//! ```text
//! cargo run --release --example picture -- docs
//! ```

use lacuna::data::Record;
use lacuna::diagnose::Diagnosis;
use lacuna::file::{Format, parse};
use lacuna::report::Report;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".into());
    let demo = concat!(env!("CARGO_MANIFEST_DIR"), "/src/cli/demo");
    let model = parse(include_str!("../src/cli/demo/model.toml"), "model.toml", Format::Toml)?;
    let record = |name| Record::csv(format!("{demo}/{name}.csv.gz"))?.pick(&["u"], &["y"]);
    let finding = Diagnosis::of(&model).run(&[record("est")?], Some(&record("test")?), &())?;
    let picture = Report::of(&finding).picture(0).ok_or("the cause has no curve")?;
    std::fs::write(format!("{folder}/found.svg"), picture)?;
    println!("{}", lacuna::report::sentences::headline(&finding));
    Ok(())
}
