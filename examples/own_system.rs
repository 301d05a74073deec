//! A system of your own in under 40 lines, simulated and fitted like a bundled one.
//!
//! ```text
//! cargo run --release --example own_system -- FOLDER
//! ```
//!
//! Writes the fitted model to FOLDER (the current one by default).

use lacuna::data::{FilteredNoise, Record, noise};
use lacuna::estimate::estimate;
use lacuna::evaluate::{Init, Simulation};
use lacuna::file;
use lacuna::prelude::*;
use lacuna::system::{Sampling, System};

/// A heated block: C T' = P - h (T - T_room), with h growing with the temperature.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HeatedBlock {
    pub capacity: f64,   // J/K
    pub loss: f64,       // W/K
    pub convection: f64, // W/K^2
}

impl Physics for HeatedBlock {
    fn signals(&self) -> Signals {
        Signals::continuous()
            .input("power", "W")
            .state("excess", "K", 0.0)
            .output("temperature", "K")
            .parameter_from("capacity", self.capacity, "J/K", 0.0)
            .parameter_from("loss", self.loss, "W/K", 0.0)
            .parameter_from("convection", self.convection, "W/K^2", 0.0)
            .channel("heat", "W")
    }
    #[inline(always)]
    fn derivative<R: Real>(&self, at: &At<R>, dx: &mut [R]) {
        let &[capacity, loss, convection] = at.parameters();
        let (&[excess], &[power], &[heat]) = (at.states(), at.inputs(), at.channels());
        dx[0] = (power + heat - (loss + convection * excess.abs()) * excess) / capacity;
    }
    #[inline(always)]
    fn output<R: Real>(&self, at: &At<R>, y: &mut [R]) {
        y[0] = at.x[0];
    }
}

lacuna::register!(StateSpaceModel for HeatedBlock, "heated_block", "a block that loses heat");

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".into());
    let system = |capacity, loss, convection| {
        System::new(HeatedBlock { capacity, loss, convection }, Sampling::default())
    };
    let power: Vec<f64> = FilteredNoise { cutoff: 0.01, order: 2, rms: 40.0 }
        .generate(1500, 5.0, 1)?
        .into_iter()
        .map(|p| 100.0 + p)
        .collect();
    let drive = Record::new(5.0).input("power [W]", power)?;
    let clean = Simulation::of(&system(500.0, 1.2, 0.01), &drive, Init::Samples(0))?;
    let clean = &clean.outputs[0].1;
    let measured = clean.iter().zip(noise::at_snr(clean, 30.0, 2)?).map(|(y, e)| y + e);
    let record = drive.output("temperature [K]", measured.collect::<Vec<_>>())?;

    let fit = estimate(&system(300.0, 2.0, 0.005), &[record], 0)?;
    for p in &fit.parameters {
        println!("{} = {:.4} {} (was {})", p.name, p.value, p.unit, p.from);
    }
    file::save(&fit.system, format!("{folder}/block.toml").as_ref())?;
    println!("{}", file::to_toml(&fit.system)?);
    Ok(())
}
