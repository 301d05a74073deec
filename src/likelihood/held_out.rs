//! What samples that were not fitted say: prequential log density.
//!
//! sum over held samples of ln p(y[k] | y[0..k], numbers fitted to the others): the filter sees what is
//! before a sample, the numbers do not. Source: Dawid, JRSS A 147, 1984.

use std::ops::Range;

use super::follow::Wanted;
use super::hypothesis::Hypothesis;
use super::predictor::Predictor;

impl Predictor {
    /// The same, blind to what was measured in some samples.
    pub(crate) fn blinded(&self, held: &[Range<usize>]) -> Self {
        let mut blind = self.clone();
        let ny = self.model.plan.sizes.y;
        for k in held.iter().cloned().flatten().filter(|&k| k < self.len()) {
            blind.measured[k * ny..][..ny].fill(f64::NAN);
        }
        blind
    }

    /// Log density of held samples under a hypothesis; `None` where it cannot be run.
    pub(crate) fn density(&self, of: &Hypothesis, held: &[Range<usize>]) -> Option<f64> {
        let model = self.extended(&of.parts, &of.theta).ok()?;
        let wanted = Wanted { gate: Some(self.gate()), ..Wanted::default() };
        let run = self.run(&model, &of.noise, wanted).ok()?;
        let ny = run.path.outputs;
        let inside = held.iter().cloned().flatten().filter(|&k| k < self.len());
        let sum = inside.map(|k| run.densities[k * ny..][..ny].iter().sum::<f64>()).sum::<f64>();
        (run.diverged_at.is_none() && sum.is_finite()).then_some(sum)
    }
}
