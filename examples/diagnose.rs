//! The main job: a model and a record in, the named cause and a better model out.
//!
//! ```text
//! cargo run --release --example diagnose -- FOLDER
//! ```
//!
//! The machine is a pendulum with dry friction in its bearing, of which the model,
//! `examples/pendulum.toml`, knows nothing. Writes the report and the extended model to
//! FOLDER (the current one by default).

use lacuna::data::{FilteredNoise, Record, noise};
use lacuna::diagnose::{Diagnosis, Watch};
use lacuna::evaluate::{Init, Simulation};
use lacuna::file::{self, Format};
use lacuna::report::Report;
use lacuna::system::System;

const MODEL: &str = include_str!("pendulum.toml");
const FRICTION: &str = "
[[effects]]
into = \"torque_on_arm\"
of = \"rate\"
effect.coulomb_friction = { level = -0.04, width = 0.01 }
";

/// Says what is being done, and never asks to stop.
struct Steps;

impl Watch for Steps {
    fn report(&self, done: f64, doing: &str) {
        println!("  {:3.0} % {doing}", 100.0 * done);
    }

    fn stopped(&self) -> bool {
        false
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".into());
    let machine = file::parse(&format!("{MODEL}{FRICTION}"), "the machine", Format::Toml)?;
    let (monday, tuesday) = (measured(&machine, 2000, 1)?, measured(&machine, 1000, 2)?);

    let model = file::parse(MODEL, "pendulum.toml", Format::Toml)?;
    // all registered effects at all places; `.only(..)`, `.without(..)`, `.fix(..)` narrow it
    let finding = Diagnosis::of(&model).run(&[monday], Some(&tuesday), &Steps)?;
    println!("{}", lacuna::report::sentences::headline(&finding));
    for cause in &finding.causes {
        for other in &cause.indistinguishable {
            println!("  the data cannot tell it from {other}");
        }
        for other in cause.runners_up.iter().take(2) {
            println!("  {other} would remove {:.0} %", 100.0 * other.error_removed);
        }
    }
    let (before, after) = (&finding.before.test["angle"], &finding.after.test["angle"]);
    println!("RMSE on Tuesday: {:.5} rad before, {:.5} rad after", before.rmse, after.rmse);

    Report::of(&finding).titled("a pendulum").write(format!("{folder}/report.html").as_ref())?;
    file::save(&finding.extended, format!("{folder}/extended.toml").as_ref())?;
    println!("wrote report.html and extended.toml");
    Ok(())
}

/// A record of a machine, with 25 dB of noise.
fn measured(
    machine: &System,
    samples: usize,
    seed: u64,
) -> Result<Record, Box<dyn std::error::Error>> {
    let torque =
        FilteredNoise { cutoff: 2.0, order: 2, rms: 0.25 }.generate(samples, 0.02, seed)?;
    let drive = Record::new(0.02).input("torque [N m]", torque)?;
    let clean = Simulation::of(machine, &drive, Init::Samples(0))?.outputs.swap_remove(0).1;
    let e = noise::at_snr(&clean, 25.0, seed + 100)?;
    let angle = clean.iter().zip(e).map(|(y, e)| y + e).collect::<Vec<f64>>();
    Ok(drive.output("angle [rad]", angle)?)
}
