//! What samples that were not fitted say: prequential log density.
//!
//! sum over held samples of ln p(y[k] | y[0..k], numbers fitted to the others): a stretch that is held begins
//! where the filter of all samples before it stands. The variances of the noise are a nuisance of either model
//! and are estimated where it is judged: what a model still lacks may be larger here than where it was fitted,
//! and would count against a cause that has nothing to do with it. Source: Dawid, JRSS A 147, 1984.

use std::ops::Range;

use super::follow::Wanted;
use super::hypothesis::Hypothesis;
use super::intensities::most_likely;
use super::predictor::Predictor;
use super::replay::Pass;

/// Log odds by which held samples must speak against a cause for it to be withdrawn, or those that the fitted
/// ones gave it where they are less: 20 to 1 (Kass and Raftery, JASA 90, 1995: strong). Samples that a cause
/// does not reach say next to nothing.
const REFUTED: f64 = 3.0;
/// Estimates of the noise of held samples; the first is that of the samples that were fitted.
const NOISES: usize = 3;

/// Whether held samples refute a cause: `gain` is their log density with it less that without it, `odds` its
/// log odds by the samples that were fitted.
pub fn refutes(gain: f64, odds: f64) -> bool {
    gain <= -REFUTED.min(odds.max(0.0))
}

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

    /// Log density of held samples under a hypothesis, at the variances of its noise that are most likely
    /// there; `None` where it cannot be run.
    pub(crate) fn density(&self, of: &Hypothesis, held: &[Range<usize>]) -> Option<f64> {
        self.densities(of, held).map(|(_, best)| best)
    }

    /// Whether held samples have other variances of the noise than the samples that a hypothesis was fitted to; `None`
    /// where none are held, or it cannot be run.
    pub(super) fn is_another_noise(&self, of: &Hypothesis, held: &[Range<usize>]) -> Option<bool> {
        let samples = held.iter().map(Range::len).sum::<usize>() as f64;
        let (own, best) = self.densities(of, held).filter(|_| samples > 0.0)?;
        Some(best - own > 0.5 * of.noise.count() as f64 * samples.ln())
    }

    /// Log density of held samples at the noise of a hypothesis, and at the most likely variances.
    fn densities(&self, of: &Hypothesis, held: &[Range<usize>]) -> Option<(f64, f64)> {
        let model = self.extended(&of.parts, &of.theta).ok()?;
        let wanted = Wanted { gate: Some(self.gate()), ..Wanted::default() };
        let mut noise = of.noise.clone();
        let (mut own, mut best) = (None, f64::NEG_INFINITY);
        for left in (0..NOISES).rev() {
            let run = self.run(&model, &noise, wanted).ok().filter(|r| r.diverged_at.is_none())?;
            let mut path = run.path;
            path.segments = path.segments.iter().flat_map(|own| within(own, held)).collect();
            let ny = path.outputs;
            let is_held = |k: &usize| held.iter().any(|range| range.contains(k));
            let gated = run.outliers.iter().filter(|(_, k)| is_held(k));
            let gated: f64 = gated.map(|(o, k)| run.densities[k * ny + o]).sum();
            let value = gated + Pass::of(&path, &noise, false).log_likelihood;
            (own, best) = (own.or(Some(value)), best.max(value));
            if left > 0 {
                noise = most_likely(&path, &noise, &noise.components()).0;
            }
        }
        own.filter(|_| best.is_finite()).map(|own| (own, best))
    }
}

/// The parts of a segment that are held.
fn within(segment: &Range<usize>, held: &[Range<usize>]) -> Vec<Range<usize>> {
    let own = held.iter().map(|h| h.start.max(segment.start)..h.end.min(segment.end));
    own.filter(|range| !range.is_empty()).collect()
}
