//! Candidates and fits to test with.

use std::sync::Arc;

use super::beam::Fit;
use crate::candidates::candidate::{Candidate, Preference, Wire};
use crate::candidates::stiffness::Stiffness;
use crate::effect::Named;
use crate::evidence::{NoiseModel, Stretches};
use crate::fit::problem::Model;
use crate::register;
use crate::system::Route;

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
