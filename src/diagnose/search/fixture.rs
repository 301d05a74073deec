//! Machines, records, candidates and fits to test with.

use std::sync::Arc;

use super::beam::Fit;
use crate::candidates::candidate::{Candidate, Preference, Wire};
use crate::candidates::stiffness::Stiffness;
use crate::data::{Random, Record};
use crate::effect::Named;
use crate::evaluate::{Init, Simulation};
use crate::evidence::{NoiseModel, Stretches};
use crate::fit::problem::Model;
use crate::register;
use crate::system::{Route, System};
use lacuna_core::file::{Format, parse};

/// A mass on a spring, driven and seen.
const MASS: &str = r#"
sampling_time = 0.05
[model.equations]
inputs = [{ name = "u" }]
states = [{ name = "x", derivative = "v" }, { name = "v", derivative = "u - k*x - 0.8*v" }]
outputs = [{ name = "y", value = "x" }]
parameters = [{ name = "k", value = 4.0, fixed = true }]
channels = [{ name = "f", into = [{ state = "v", gain = "1" }] }]
"#;

/// A model file.
pub(crate) fn system(text: &str) -> System {
    parse(text, "mass.toml", Format::Toml).unwrap_or_else(|e| panic!("{}", e.pretty()))
}

/// The mass on a spring with effects, as a model file says them.
pub(crate) fn mass(effects: &str) -> System {
    system(&format!("{MASS}{effects}"))
}

/// How a machine of one input `u` and one output `y` is driven and read.
pub(crate) struct Run {
    pub samples: usize,
    pub seed: u64,
    /// Standard deviation of what drives u, and of the noise of y.
    pub size: f64,
    pub noise: f64,
}

/// A record of a machine with white noise.
pub(crate) fn record(machine: &System, run: &Run) -> Record {
    let mut random = Random::new(run.seed);
    let mut u = vec![0.0; run.samples];
    for k in 1..u.len() {
        u[k] = 0.9 * u[k - 1] + run.size * random.normal();
    }
    let driven = Record::new(0.05).input("u", u).unwrap();
    let clean = Simulation::of(machine, &driven, Init::Samples(0)).unwrap();
    let y = clean.outputs.into_iter().next().unwrap().1;
    let y: Vec<f64> = y.into_iter().map(|y| y + run.noise * random.normal()).collect();
    driven.output("y", y).unwrap()
}

/// A cubic law into a channel, of a coordinate.
pub(crate) fn candidate(into: &str) -> Candidate {
    let (_, shape) =
        register::effects().into_iter().find(|(card, _)| card.name == "cubic").unwrap();
    let card = shape.card();
    let count = card.parameters.len();
    Candidate {
        effect: "cubic",
        shape: shape.boxed(),
        card: card.into(),
        into: into.into(),
        of: Some("position".into()),
        also_into: vec![],
        also_of: vec![],
        wire: Wire::Stage(Route { source: 0, rate: (0, 0.0), target: 0 }),
        preference: Preference::DeclaredChannel,
        place: Preference::DeclaredChannel,
        linear: vec![0],
        refine: vec![],
        starts: vec![vec![0.0; count]].into(),
        min: vec![f64::NEG_INFINITY; count],
        max: vec![f64::INFINITY; count],
        thresholds: false,
        sign: 0.0,
        probe: 1e-3,
        stiffness: Stiffness::default(),
        push: 0.0,
        named: Named { quantity: None, own_path: false, bare: false },
        units: (String::new(), String::new()),
        load: 1.0,
        twins: vec![],
    }
}

/// A model with cubic laws into these channels, and what it leaves.
pub(crate) fn fit_of(into: &[&str], residual: Vec<f64>) -> Fit {
    let mut model = Model { theta: vec![], starts: vec![], added: vec![] };
    for into in into {
        let cause = Arc::new(candidate(into));
        let parameters = cause.starts[0].clone();
        model = model.with(&cause, parameters);
    }
    let noise = Stretches::of_lengths(&[residual.len()]).white(&residual);
    Fit { model, free: false, noise, residual, likelihood: 0.0, occam: 0.0, prior: 0.0 }
}
