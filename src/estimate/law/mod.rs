//! Which law of a library a sampled curve is: regression of every law on pairs (z, w), weighed by
//! the Bayesian information criterion.
//!
//! ```text
//! BIC_i = n ln(SSE_i / n) + k_i ln n,   P_i = exp(-BIC_i / 2) / sum_j exp(-BIC_j / 2)
//! ```
//!
//! (Schwarz, Ann. Statist. 6, 1978). Neighbouring values of a learned curve are no independent
//! data: n is the number of bins that the curve is told apart in, not that of the samples. A curve
//! of straight lines between as many knots as it needs is one of the candidates; where it is the
//! most probable, the curve has no name in the library.

mod fit;

use crate::effect::{CandidateEffect, Mechanism, Needs, View};
use crate::model::{Quantity, Signal};
use crate::optimise::Bounds;

/// Bins of as many samples each.
const BINS: usize = 32;
/// Knots of the curve without a name.
const KNOTS: usize = 10;
/// Laws that a second one is added to.
const SEEDS: usize = 3;
/// Samples that are fitted.
const SAMPLES: usize = 1200;

/// A curve as it was met: what it depends on and what it gives, pair by pair.
#[derive(Debug, Clone, Copy)]
pub struct Pairs<'a> {
    /// The coordinate, its unit and quantity.
    pub coordinate: &'a Signal,
    /// Its values.
    pub z: &'a [f64],
    /// What was given at each, in the unit of the channel.
    pub w: &'a [f64],
    /// Sampling time, s.
    pub sampling_time: f64,
}

/// A part of a law: an effect of the library and its numbers.
#[derive(Debug, Clone)]
pub struct Part {
    /// Name in model files.
    pub effect: String,
    /// The effect with its numbers.
    pub law: Box<dyn CandidateEffect>,
}

/// A law that may be what the curve is: one effect or a sum of two.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// Its parts; none where it is a curve without a name.
    pub parts: Vec<Part>,
    /// Probability among all that were tried.
    pub probability: f64,
    /// Share of the mean square about 0 that it explains.
    pub share: f64,
}

/// A place on the drawn curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drawn {
    /// Mean of the coordinate in the bin.
    pub z: f64,
    /// Mean of what was given.
    pub w: f64,
    /// Standard deviation about it: what the coordinate does not decide.
    pub band: f64,
}

/// A curve read.
#[derive(Debug, Clone)]
pub struct Reading {
    /// Share of the mean square about 0 that the coordinate decides.
    pub share: f64,
    /// The curve, drawn.
    pub curve: Vec<Drawn>,
    /// What it may be, most probable first.
    pub candidates: Vec<Candidate>,
}

impl Reading {
    /// The most probable law; none where that is a curve without a name.
    pub fn named(&self) -> Option<&Candidate> {
        self.candidates.first().filter(|first| !first.parts.is_empty())
    }
}

/// The curve in bins of as many samples each, and the share of the mean square that it decides
/// (Pearson's correlation ratio about 0, less what chance would give).
pub fn drawn(pairs: &Pairs<'_>) -> (Vec<Drawn>, f64) {
    let mut order: Vec<usize> =
        (0..pairs.z.len()).filter(|&k| pairs.z[k].is_finite() && pairs.w[k].is_finite()).collect();
    order.sort_by(|&a, &b| pairs.z[a].total_cmp(&pairs.z[b]));
    let bins = BINS.min(order.len() / 4).max(1);
    let (mut curve, mut within, mut total) = (vec![], 0.0, 0.0);
    for bin in 0..bins {
        let own = &order[bin * order.len() / bins..(bin + 1) * order.len() / bins];
        let count = own.len().max(1) as f64;
        let mean = |of: &[f64]| own.iter().map(|&k| of[k]).sum::<f64>() / count;
        let (z, w) = (mean(pairs.z), mean(pairs.w));
        // about the line through the bin: a steep curve is no scatter
        let both: f64 = own.iter().map(|&k| (pairs.z[k] - z) * (pairs.w[k] - w)).sum();
        let spread: f64 = own.iter().map(|&k| (pairs.z[k] - z).powi(2)).sum();
        let slope = if spread > 0.0 { both / spread } else { 0.0 };
        let off = |k: usize| pairs.w[k] - w - slope * (pairs.z[k] - z);
        let squares: f64 = own.iter().map(|&k| off(k) * off(k)).sum();
        within += squares * count / (count - 2.0).max(1.0);
        total += own.iter().map(|&k| pairs.w[k] * pairs.w[k]).sum::<f64>();
        curve.push(Drawn { z, w, band: (squares / count).sqrt() });
    }
    let share = if total > 0.0 { (1.0 - within / total).clamp(0.0, 1.0) } else { 0.0 };
    (curve, share)
}

/// Asks every law of a library whether the curve is it.
pub fn read(pairs: &Pairs<'_>, library: &[(String, Box<dyn CandidateEffect>)]) -> Reading {
    let (curve, share) = drawn(pairs);
    let finite: Vec<usize> =
        (0..pairs.z.len()).filter(|&k| pairs.z[k].is_finite() && pairs.w[k].is_finite()).collect();
    let count = SAMPLES.min(finite.len());
    let used: Vec<usize> = (0..count).map(|i| finite[i * finite.len() / count.max(1)]).collect();
    let pick = |of: &[f64]| -> Vec<f64> { used.iter().map(|&k| of[k]).collect() };
    let (z, w) = (pick(pairs.z), pick(pairs.w));
    let view = View::new(&z, pairs.sampling_time);
    let places: Vec<&(String, Box<dyn CandidateEffect>)> =
        library.iter().filter(|(_, law)| may_be(law.as_ref(), pairs.coordinate, &view)).collect();
    let mut tried: Vec<(Vec<Part>, usize, f64)> = vec![];
    let singles: Vec<fit::Fitted> = places
        .iter()
        .filter_map(|(name, law)| fit::one(name, law.as_ref(), &view, &z, &w))
        .collect();
    let n = curve.len() as f64;
    let bic = |squares: f64, parameters: usize| {
        n * (squares / z.len().max(1) as f64).max(f64::MIN_POSITIVE).ln()
            + parameters as f64 * n.ln()
    };
    let mut order: Vec<usize> = (0..singles.len()).collect();
    let rank = |i: usize| bic(singles[i].squares, singles[i].parameters());
    order.sort_by(|&a, &b| rank(a).total_cmp(&rank(b)));
    for (place, &first) in order.iter().take(SEEDS).enumerate() {
        for &second in &order[place + 1..] {
            if let Some(both) = fit::two(&singles[first], &singles[second], &z, &w) {
                let (parameters, squares) = (both.parameters(), both.squares);
                tried.push((both.parts, parameters, squares));
            }
        }
    }
    tried.extend(singles.into_iter().map(|one| {
        let (parameters, squares) = (one.parameters(), one.squares);
        (one.parts, parameters, squares)
    }));
    if let Some(squares) = fit::drawn(&curve, KNOTS, &z, &w) {
        tried.push((vec![], KNOTS, squares));
    }
    let total: f64 = w.iter().map(|w| w * w).sum();
    let scores: Vec<f64> =
        tried.iter().map(|(_, parameters, squares)| bic(*squares, *parameters)).collect();
    let best = scores.iter().copied().fold(f64::INFINITY, f64::min);
    let odds: Vec<f64> = scores.iter().map(|score| (-0.5 * (score - best)).exp()).collect();
    let sum: f64 = odds.iter().sum();
    let each = tried.into_iter().zip(odds).map(|((parts, _, squares), odds)| Candidate {
        parts,
        probability: odds / sum,
        share: 1.0 - squares / total.max(f64::MIN_POSITIVE),
    });
    let mut candidates: Vec<Candidate> = each.collect();
    candidates.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    Reading { share, curve, candidates }
}

/// Regression of one law on pairs (z, w) from several starts (nonlinear least squares has several
/// hills): all of its parameters and the sum of squares that is left, best first, each hill once.
///
/// `starts` and `range` hold a value per parameter; coefficients are solved for, wherever they start.
#[doc(hidden)]
pub fn regressions(
    law: &dyn CandidateEffect,
    starts: &[Vec<f64>],
    range: &Bounds,
    pairs: (&[f64], &[f64]),
) -> Vec<(Vec<f64>, f64)> {
    fit::each(law, starts, range, pairs)
}

/// Whether a law can be asked about a curve of this coordinate.
fn may_be(law: &dyn CandidateEffect, coordinate: &Signal, view: &View) -> bool {
    let card = law.card();
    let crosses = view.quantile(0.02) < 0.0 && view.quantile(0.98) > 0.0;
    let needs = match card.needs {
        Needs::Nothing | Needs::Coordinate => true,
        Needs::Velocity => {
            coordinate.quantity.as_ref().is_some_and(Quantity::is_velocity) && crosses
        }
        Needs::NoVelocity => !coordinate.quantity.as_ref().is_some_and(Quantity::is_velocity),
        Needs::AngleOrTime => coordinate.unit == "rad",
        Needs::VelocityUnderLoad | Needs::CoordinateWithRate | Needs::Motion | Needs::Time => false,
    };
    // what may stand in a channel: a gain of a path is a linear law there
    needs
        && card.places.channel
        && card.mechanism == Mechanism::Law
        && card.states == 0
        && !card.parameters.is_empty()
}
