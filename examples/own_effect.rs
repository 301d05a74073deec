//! An effect of your own in under 25 lines, which a diagnosis then looks for.
//!
//! ```text
//! cargo run --release --example own_effect -- FOLDER
//! ```
//!
//! Writes the extended model to FOLDER (the current one by default).

use lacuna::data::{FilteredNoise, Record, noise};
use lacuna::diagnose::Diagnosis;
use lacuna::evaluate::{Init, Simulation};
use lacuna::file::{self, Format};
use lacuna::prelude::*;
use lacuna::system::System;

/// A force that a magnet lends to what comes near: w = c z / (1 + z^2 / reach^2)^2.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Magnet {
    pub coefficient: f64,
    pub reach: f64,
}

impl Default for Magnet {
    fn default() -> Self {
        Self { coefficient: 0.0, reach: 1.0 }
    }
}

impl Effect for Magnet {
    fn card(&self) -> EffectCard {
        let unit = UnitRule::ChannelPerCoordinate(1);
        let coefficient = EffectParameter::coefficient("coefficient", self.coefficient, unit);
        EffectCard::law(vec![
            coefficient,
            EffectParameter::shape("reach", self.reach, UnitRule::Coordinate),
        ])
    }
    fn title(&self, _: &Named) -> String {
        "A magnet".into()
    }
    #[inline(always)]
    fn law<R: Real>(&self, at: &Arguments<R>, _: &mut [R]) -> R {
        let (&[c, reach], z) = (at.parameters(), at.z());
        let far = (z / reach) * (z / reach) + 1.0;
        c * z / (far * far)
    }
    fn search(&self, view: &View) -> Search {
        let (card, rms) = (Effect::card(self), view.rms);
        Search::plain(&card).over(&card, "reach", &[0.3 * rms, rms], (0.05 * rms, 3.0 * rms))
    }
}

lacuna::register!(CandidateEffect for Magnet, "magnet", "a pull that fades with the distance");

const MODEL: &str = "sampling_time = 0.02
integrator = { substeps = 4 }
[model.duffing]
mass = 1.0
damping = 1.0
stiffness = 40.0
";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".into());
    let magnet = "[[effects]]\ninto = \"force\"\nof = \"p\"\n\
        effect.magnet = { coefficient = 25.0, reach = 0.1 }\n";
    let machine = file::parse(&format!("{MODEL}{magnet}"), "the machine", Format::Toml)?;
    let model = file::parse(MODEL, "the model", Format::Toml)?;
    let finding = Diagnosis::of(&model).run(&[record(&machine)?], None, &())?;
    println!("{}", lacuna::report::sentences::headline(&finding));
    for value in finding.causes.iter().flat_map(|cause| &cause.parameters) {
        println!("  {} = {:.4} {}", value.name, value.value, value.unit);
    }
    file::save(&finding.extended, format!("{folder}/magnet.toml").as_ref())?;
    Ok(())
}

fn record(machine: &System) -> Result<Record, Box<dyn std::error::Error>> {
    let force = FilteredNoise { cutoff: 1.5, order: 2, rms: 1.5 }.generate(2500, 0.02, 4)?;
    let drive = Record::new(0.02).input("u [N]", force)?;
    let clean = Simulation::of(machine, &drive, Init::Samples(0))?.outputs.swap_remove(0).1;
    let e = noise::at_snr(&clean, 25.0, 5)?;
    let y: Vec<f64> = clean.iter().zip(e).map(|(y, e)| y + e).collect();
    Ok(drive.output("y [m]", y)?)
}
