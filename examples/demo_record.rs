//! Makes the records that `lacuna demo` brings along: a multisine drives two masses with dry
//! friction on the first one; noise at 20 dB.
//!
//! `cargo run --release --example demo_record -- src/cli/demo`

use lacuna::data::{Lines, Multisine, Phases, Record, noise};
use lacuna::evaluate::{Init, Simulation};
use lacuna::file::{Format, parse};
use lacuna::system::System;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".into());
    let mut truth = include_str!("../src/cli/demo/model.toml").to_string();
    truth += "\n[[effects]]\ninto = \"force_1\"\nof = \"v_1\"\n\
              effect.coulomb_friction = { level = -1.5, width = 0.02 }\n";
    let machine = parse(&truth, "the machine", Format::Toml)?;
    record(&machine, 3000, 1)?.write_csv(format!("{folder}/est.csv.gz"))?;
    record(&machine, 1500, 2)?.write_csv(format!("{folder}/test.csv.gz"))?;
    Ok(())
}

/// `n` samples after as many that let the start fade, as a data logger of 24 bits over
/// +-1 m (+-100 N) would store them.
fn record(machine: &System, n: usize, seed: u64) -> Result<Record, Box<dyn std::error::Error>> {
    let excitation = Multisine {
        period: n,
        lines: Lines::Full { from: 5, to: Some(n / 4) },
        rms: 6.0,
        phases: Phases::Random,
        crest_iterations: 0,
    };
    let input = excitation.generate(2 * n, 0.05, seed)?;
    let logged = |value: f64, step: f64| (value / step).round() / step.recip();
    let input: Vec<f64> = input.into_iter().map(|u| logged(u, 1e-5)).collect();
    let drive = Record::new(0.05).input("u [N]", input.clone())?;
    let run = Simulation::of(machine, &drive, Init::Samples(0))?;
    let clean = &run.outputs[0].1[n..];
    let noise = noise::at_snr(clean, 20.0, seed + 100)?;
    let output = clean.iter().zip(noise).map(|(y, e)| logged(y + e, 1e-6));
    Ok(Record::new(0.05)
        .input("u [N]", input[n..].to_vec())?
        .output("y [m]", output.collect::<Vec<f64>>())?)
}
