//! Laws that remember, on the path of an instrument: a lag, a delay, play.
//!
//! What such a law adds depends on the past of what it reads, so that no column of a sample tells it. The slopes of
//! the standardised innovations z along its parameters are differences of the filter itself, and a point p of its
//! grid is judged by its secant, d = z(p) - z:
//!
//! ```text
//! dz / dp = (z(p + h) - z(p - h)) / 2 h,      gain of log L: 1/2 (d'z)^2 / d'd  where d'z < 0
//! ```
//!
//! Sources: Ljung, "System Identification", 2nd ed., 1999, section 10.2 (Gauss-Newton, a gradient by differences);
//! Miller, "Subset Selection in Regression", 2nd ed., 2002, ch. 3.

use rayon::prelude::*;

use super::follow::Wanted;
use super::hypothesis::{Hypothesis, Part, names};
use super::laws::Law;
use super::noise::Noise;
use super::path::Path;
use super::predictor::Predictor;
use super::racing::RACED;
use super::replay::Pass;
use super::screen::Spotted;
use crate::effect::{EffectCard, Mechanism, Role, View};
use crate::register;

/// Laws of one survey that go into a race, the most gaining first.
const FITTED: usize = 2;
/// Points of a grid from nothing on, and by how much each is less than the one before; the first is as much less
/// than the most that is looked for.
const POINTS: usize = 3;
const LESS: f64 = 4.0;
/// Difference along a parameter, as a share of its value.
const NUDGE: f64 = 1e-4;

/// Whether what a law adds depends on the past of what it reads.
pub(super) fn remembers(card: &EffectCard) -> bool {
    matches!(card.mechanism, Mechanism::Lag | Mechanism::Delay | Mechanism::Play) || card.states > 0
}

/// The laws that an instrument may have on its own path, each at every point of its grid.
pub(super) fn of_an_instrument(is_input: bool, view: &View) -> Vec<Law> {
    let mut found = vec![];
    for (own, effect) in register::effects() {
        let card = effect.card();
        let is_there = if is_input { card.places.input } else { card.places.output };
        if !(remembers(&card) && is_there && card.states == 0) {
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
    fn standardised(&self, parts: &[Part], theta: &[f64], noise: &Noise) -> Option<Vec<f64>> {
        let model = self.extended(parts, theta).ok()?;
        let run = self.run(&model, noise, Wanted { gate: Some(self.gate()), ..Wanted::default() });
        let run = run.ok().filter(|run| run.log_likelihood.is_finite())?;
        Some(Pass::of(&run.path, noise, false).z)
    }

    /// The laws that remember which gain the most, each with its place among `spots`; fitted to the end where they
    /// are near `best`, the criterion of the best of all others.
    pub(super) fn remembering(
        &self,
        (path, noise): (&Path, &Noise),
        spots: &[Spotted],
        best: f64,
    ) -> Vec<(Hypothesis, usize)> {
        let theta = &self.model.theta;
        let z = Pass::of(path, noise, false).z;
        let points = spots.iter().enumerate().flat_map(|(at, spot)| {
            spot.remembering.iter().map(move |law| {
                let law = Box::new(law.clone());
                (at, vec![Part::Law { site: spot.site, source: spot.source, law }])
            })
        });
        let points: Vec<(usize, Vec<Part>)> = points.collect();
        let gained = |(at, parts): (usize, Vec<Part>)| {
            let there = self.standardised(&parts, theta, noise)?;
            Some((secant_gain(&z, &there), at, parts))
        };
        let mut judged: Vec<(f64, usize, Vec<Part>)> =
            points.into_par_iter().filter_map(gained).collect();
        judged.sort_by(|a, b| b.0.total_cmp(&a.0));
        let price = 0.5 * self.observed().ln() + (spots.len() as f64).ln();
        let mut raced: Vec<(usize, Vec<Part>)> = vec![];
        for (gain, at, parts) in judged {
            let own = names(&parts);
            let is_new = !raced.iter().any(|(_, other)| names(other) == own);
            if gain > price && is_new && raced.len() < FITTED {
                raced.push((at, parts));
            }
        }
        let fit = |(at, parts): (usize, Vec<Part>)| {
            let raced = self.raced(parts, theta, noise)?;
            let fitted = match raced.criterion(self.observed()) > best - RACED {
                true => self.refit(self.fit(raced.parts, &raced.theta, noise)?)?,
                false => raced,
            };
            Some((fitted, at))
        };
        raced.into_par_iter().filter_map(fit).collect()
    }
}

/// What a multiple of the way from innovations `z` to those at a point of a grid gains at most.
fn secant_gain(z: &[f64], there: &[f64]) -> f64 {
    let both = z.iter().zip(there).filter(|(z, there)| z.is_finite() && there.is_finite());
    let (along, size) = both.fold((0.0, 0.0), |(along, size), (z, there)| {
        let d = there - z;
        (along + d * z, size + d * d)
    });
    if along < 0.0 { 0.5 * along * along / size } else { 0.0 }
}
