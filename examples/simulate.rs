//! Simulates a model along a record and compares.
//!
//! ```text
//! cargo run --release --example simulate -- FOLDER
//! ```
//!
//! The model is a file, `examples/pendulum.toml`; the record is made up: a pendulum with a
//! little more damping. Writes the simulated angle to FOLDER (the current one by default).

use lacuna::data::{FilteredNoise, Record};
use lacuna::evaluate::{Init, Simulation};
use lacuna::file::{self, Format};

const MODEL: &str = include_str!("pendulum.toml");

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".into());
    let model = file::parse(MODEL, "pendulum.toml", Format::Toml)?;

    // the machine, of which one would have a record: `Record::csv("monday.csv")?.pick(..)?`
    let damped = MODEL.replace("name = \"c\", value = 0.05", "name = \"c\", value = 0.07");
    let machine = file::parse(&damped, "the machine", Format::Toml)?;
    let torque = FilteredNoise { cutoff: 2.0, order: 2, rms: 0.25 }.generate(1500, 0.02, 1)?;
    let drive = Record::new(0.02).input("torque [N m]", torque)?;
    let run = Simulation::of(&machine, &drive, Init::Samples(0))?;
    let record = drive.output("angle [rad]", run.outputs[0].1.clone())?;

    // the initial state is estimated from as many samples as the model needs to forget it
    let run = Simulation::of(&model, &record, Init::Forgotten)?;
    println!("{} samples at the start are not counted", run.init_samples);
    for (state, value) in &run.initial_state {
        println!("  {state} starts at {value:.4}");
    }
    for (output, metrics) in &run.metrics {
        println!(
            "{output}: RMSE {:.5} rad, NRMSE {:.4}, fit {:.1} %",
            metrics.rmse, metrics.nrmse, metrics.fit_percent
        );
    }
    if let Some(sample) = run.diverged_at {
        println!("diverged at sample {sample}");
    }
    let path = format!("{folder}/simulated.csv");
    Record::new(0.02).output("angle_hat [rad]", run.outputs[0].1.clone())?.write_csv(&path)?;
    println!("wrote {path}");
    Ok(())
}
