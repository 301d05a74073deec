//! Fits the free parameters of a model to a record, with intervals, and says what the
//! record cannot tell.
//!
//! ```text
//! cargo run --release --example estimate -- FOLDER
//! ```
//!
//! Writes the fitted model to FOLDER (the current one by default).

use lacuna::data::{FilteredNoise, Record, noise};
use lacuna::estimate::estimate;
use lacuna::evaluate::{Init, Simulation};
use lacuna::file::{self, Format};

const MODEL: &str = include_str!("pendulum.toml");

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".into());

    // a record of the machine: the model's own values, 30 dB of noise
    let machine = file::parse(MODEL, "the machine", Format::Toml)?;
    let torque = FilteredNoise { cutoff: 2.0, order: 2, rms: 0.25 }.generate(1500, 0.02, 1)?;
    let drive = Record::new(0.02).input("torque [N m]", torque)?;
    let clean = Simulation::of(&machine, &drive, Init::Samples(0))?.outputs.swap_remove(0).1;
    let e = noise::at_snr(&clean, 30.0, 2)?;
    let angle: Vec<f64> = clean.iter().zip(e).map(|(y, e)| y + e).collect();
    let record = drive.output("angle [rad]", angle)?;

    // a guess to start from; the length is now free as well
    let guess = MODEL
        .replace("value = 0.02, unit = \"kg m^2\"", "value = 0.05, unit = \"kg m^2\"")
        .replace("unit = \"m\",  fixed = true", "unit = \"m\", min = 0.0");
    let guess = file::parse(&guess, "a guess", Format::Toml)?;
    let fit = estimate(&guess, &[record], 0)?;
    for p in &fit.parameters {
        let spread = p.std_error.map_or("not told by the record".into(), |e| format!("+- {e:.2e}"));
        println!("{} = {:.5} {spread} {} (was {})", p.name, p.value, p.unit, p.from);
    }
    // empty here; free the mass too and it says that m and l come as a product
    for combination in &fit.undetermined {
        println!("the record cannot tell: {}", combination.text);
    }
    println!("NRMSE {:.4} before, {:.4} after", fit.nrmse.0, fit.nrmse.1);
    let path = format!("{folder}/fitted.toml");
    file::save(&fit.system, path.as_ref())?;
    println!("wrote {path}");
    Ok(())
}
