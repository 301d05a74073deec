//! Racing: hypotheses get a few iterations with few steps of the integrator, and only those that may still win
//! are fitted to the end (Maron and Moore, NIPS 6, 1994).
//!
//! A race leaves out nothing but what is far behind; what stays is fitted, and compared, by the integrator's
//! own steps.

use std::sync::Arc;

use super::follow::Wanted;
use super::hypothesis::{Hypothesis, Part};
use super::noise::Noise;
use super::parametrised::Model;
use super::predictor::Predictor;
use crate::system::{Base, Plan};

/// Iterations of a race.
const ITERATIONS: usize = 2;
/// How far behind the first another may be to go on, as a difference of criteria.
pub(crate) const RACED: f64 = 30.0;
/// Hypotheses that go on whatever they are behind: they begin with the noise that is left beside a free
/// curve, which leaves little to gain.
const LEAST: usize = 3;
/// How far behind the first another is no rival: odds of 20 000 to 1.
pub(crate) const DECIDED: f64 = 10.0;
/// What fewer steps may change of the log likelihood: a tenth of what decides.
const SAME: f64 = 0.1 * RACED;

/// How many of some hypotheses go on, the best first: some whatever they are behind, and what is near the
/// first.
pub(crate) fn going_on(all: &[Hypothesis], near: f64, merit: impl Fn(&Hypothesis) -> f64) -> usize {
    let top = all.first().map_or(0.0, &merit);
    let is_near = |h: &&Hypothesis| merit(h) > top - near;
    all.iter().take_while(is_near).count().max(LEAST).min(all.len())
}

impl Predictor {
    /// The same with the fewest steps a sample that leave the log likelihood of the model, `value` at this
    /// noise, as it is.
    pub(crate) fn quick(&self, noise: &Noise, value: f64) -> Self {
        let most = self.model.plan.base.substeps / 2;
        let counts = std::iter::successors(Some(1), |count| Some(2 * count));
        let mut all = counts.take_while(|count| *count <= most);
        let near = |quick: &Self| {
            let wanted = Wanted { gate: Some(self.gate()), ..Wanted::default() };
            let run = quick.run(&quick.model, noise, wanted);
            run.is_ok_and(|run| (run.log_likelihood - value).abs() < SAME)
        };
        all.find_map(|count| self.in_steps(count).filter(near)).unwrap_or_else(|| self.clone())
    }

    /// The same with so many steps of the integrator a sample.
    fn in_steps(&self, substeps: usize) -> Option<Self> {
        let (system, base) = (&self.system, &self.model.plan.base);
        let own = Base::new(system.model.as_ref(), &system.sampling, base.sampling_time).ok()?;
        let plan = Plan::new(Arc::new(Base { substeps, ..own }), &system.effects).ok()?;
        let model = Model { plan, theta: self.model.theta.clone() };
        Some(Self { model, ..self.clone() })
    }

    /// A hypothesis after a race.
    pub(crate) fn raced(
        &self,
        parts: Vec<Part>,
        theta: &[f64],
        noise: &Noise,
    ) -> Option<Hypothesis> {
        self.fit_in(ITERATIONS, parts, theta, noise)
    }
}
