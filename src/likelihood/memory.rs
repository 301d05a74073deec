//! Laws that remember, on the path of an instrument: a lag, a delay, play.
//!
//! What such a law adds depends on the past of what it reads, so that no column of a sample tells it. The slopes of
//! the standardised innovations z along its parameters are differences of the filter itself,
//!
//! ```text
//! dz / dp = (z(p + h) - z(p - h)) / 2 h
//! ```
//!
//! Source: Ljung, "System Identification", 2nd ed., 1999, section 10.2 (Gauss-Newton, a gradient by differences).

use super::follow::Wanted;
use super::hypothesis::{Hypothesis, Part};
use super::laws::Law;
use super::noise::Noise;
use super::predictor::Predictor;
use super::replay::Pass;
use crate::effect::{EffectCard, Mechanism, Role, View};
use crate::register;

/// Points of a grid from nothing on, and by how much each is less than the one before; the first is as much less
/// than the most that is looked for.
const POINTS: usize = 3;
const LESS: f64 = 4.0;
/// Difference along a parameter, as a share of its value.
const NUDGE: f64 = 1e-4;

/// Whether the system remembers the past of a path for what sits in it.
pub(super) fn is_of_a_path(mechanism: Mechanism) -> bool {
    matches!(mechanism, Mechanism::Lag | Mechanism::Delay | Mechanism::Play)
}

/// Whether what a law adds depends on the past of what it reads.
pub(super) fn remembers(card: &EffectCard) -> bool {
    is_of_a_path(card.mechanism) || card.states > 0
}

/// The laws that an instrument may have on its own path, each at every point of its grid.
pub(super) fn of_an_instrument(is_input: bool, view: &View) -> Vec<Law> {
    let mut found = vec![];
    for (own, effect) in register::effects() {
        let card = effect.card();
        let is_there = if is_input { card.places.input } else { card.places.output };
        if !(is_of_a_path(card.mechanism) && is_there && card.states == 0) {
            continue;
        }
        let (mut card, search) = (card, effect.search(view));
        for (parameter, most) in card.parameters.iter_mut().zip(&search.max) {
            parameter.max = parameter.max.min(*most);
        }
        let grid = |start: &Vec<f64>| -> Vec<Vec<f64>> {
            let from_nothing =
                |&i: &usize| card.parameters[i].role == Role::Coefficient && start[i] == 0.0;
            let Some(i) = (0..start.len()).find(from_nothing) else { return vec![start.clone()] };
            let at = |point: usize| {
                let mut values = start.clone();
                values[i] = search.max[i] / LESS.powi(point as i32);
                values
            };
            (1..=POINTS).map(at).filter(|values| values[i].is_finite()).collect()
        };
        let free: Vec<usize> =
            (0..card.parameters.len()).filter(|&i| card.parameters[i].role.is_fitted()).collect();
        found.extend(search.starts.iter().flat_map(grid).map(|values| Law {
            name: own.name,
            effect: effect.boxed(),
            card: card.clone(),
            load: None,
            values,
            free: free.clone(),
        }));
    }
    found
}

impl Predictor {
    /// Slope of the standardised innovations along parameter `i` of a law, part `part` of a hypothesis; 0 where
    /// it cannot be run.
    pub(super) fn slope_of_memory(&self, of: &Hypothesis, part: usize, i: usize) -> Vec<f64> {
        let at = |sign: f64| {
            let mut parts = of.parts.clone();
            let Part::Law { law, .. } = &mut parts[part] else { return None };
            let parameter = &law.card.parameters[i];
            let step = NUDGE * law.values[i].abs().max(NUDGE * self.model.plan.sampling_time);
            law.values[i] = (law.values[i] + sign * step).clamp(parameter.min, parameter.max);
            let value = law.values[i];
            Some((value, self.standardised(&parts, &of.theta, &of.noise)?))
        };
        let nothing = || vec![0.0; self.measured.len()];
        let Some(((above, up), (below, down))) = at(1.0).zip(at(-1.0)) else { return nothing() };
        let slope = |(up, down): (f64, f64)| (up - down) / (above - below);
        let finite = |slope: f64| if slope.is_finite() { slope } else { 0.0 };
        up.into_iter().zip(down).map(|both| finite(slope(both))).collect()
    }

    /// The standardised innovations of a hypothesis under a noise.
    pub(super) fn standardised(
        &self,
        parts: &[Part],
        theta: &[f64],
        noise: &Noise,
    ) -> Option<Vec<f64>> {
        let model = self.extended(parts, theta).ok()?;
        let run = self.run(&model, noise, Wanted { gate: Some(self.gate()), ..Wanted::default() });
        let run = run.ok().filter(|run| run.log_likelihood.is_finite())?;
        Some(Pass::of(&run.path, noise, false).z)
    }
}
