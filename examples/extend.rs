//! Extends a model by hand: an effect, where it enters, what it depends on. The extended
//! model is a model like any other.
//!
//! ```text
//! cargo run --release --example extend -- FOLDER
//! ```
//!
//! Writes the extended model to FOLDER (the current one by default).

use lacuna::data::{FilteredNoise, Record};
use lacuna::evaluate::{Init, Simulation};
use lacuna::file;
use lacuna::plugins::effects::coulomb_friction::CoulombFriction;
use lacuna::plugins::systems::Duffing;
use lacuna::system::{Integrator, Method, Placed, Sampling, System};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".into());
    let spring = Duffing {
        mass: 1.0,
        damping: 0.5,
        stiffness: 60.0,
        hardening: 900.0,
        fixed: vec!["mass".into()],
    };
    let integrator = Integrator { method: Method::Rk4, substeps: 4 };
    let plain = System::new(spring, Sampling { integrator, ..Sampling::default() });

    // what a model offers: channels to enter, coordinates to depend on
    let signals = plain.signals();
    let names = |list: Vec<lacuna::model::Signal>| {
        list.into_iter().map(|signal| signal.name).collect::<Vec<_>>().join(", ")
    };
    println!("channels: {}", names(signals.own_channels()));
    println!("coordinates: {}", names(signals.own_coordinates()));

    let mut rough = plain.clone();
    let friction = CoulombFriction { level: -0.4, width: 0.005 };
    rough.effects.push(Placed::new(Box::new(friction), "force", Some("v")));

    let force = FilteredNoise { cutoff: 1.5, order: 2, rms: 3.0 }.generate(1000, 0.02, 3)?;
    let drive = Record::new(0.02).input("u [N]", force)?;
    for (name, system) in [("without", &plain), ("with friction", &rough)] {
        let run = Simulation::of(system, &drive, Init::Samples(0))?;
        let y = &run.outputs[0].1;
        let rms = (y.iter().map(|y| y * y).sum::<f64>() / y.len() as f64).sqrt();
        println!("{name}: {rms:.4} m rms");
    }

    // written, read again, the same to the last bit; and ready for another effect
    let path = format!("{folder}/rough.toml");
    file::save(&rough, path.as_ref())?;
    let again = file::load(path.as_ref())?;
    let run = |system| Simulation::of(system, &drive, Init::Samples(0)).map(|run| run.outputs);
    assert_eq!(run(&rough)?, run(&again)?);
    println!("{}", std::fs::read_to_string(&path)?);
    Ok(())
}
