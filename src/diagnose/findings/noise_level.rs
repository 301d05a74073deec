//! Noise whose level changes: with a signal, in time, in bursts.
//!
//! What an autoregressive model of the residual does not foretell, e, is of one level where |e| depends
//! on nothing. |e|, bounded at three times its median against outliers, is put to the score test of a
//! dynamic regression on time and on the sizes of outputs and inputs (Glejser, Journal of the American
//! Statistical Association 64, 1969), and its own memory to the test of Ljung and Box, as Engle does
//! with e^2 (Econometrica 50, 1982). Samples far beyond the usual level are then no outliers, unless
//! they lie as far beyond those near them; nor where all of e is of one density with heavy tails.

use crate::evidence::{Stretches, Tails, Whitener};
use crate::findings::context::Context;
use crate::findings::note::{Follows, Note};
use crate::fit::finished::Finished;
use crate::fit::problem::Part;
use crate::statistics::{Regression, deviation, mean, median, whiteness};

/// Probability under one level at which the level is said to change.
const CHANGES: f64 = 1e-5;
/// The same as a score of the Ljung-Box test.
const REMEMBERS: f64 = 4.3;
/// Bound of |e|, in medians of it.
const BOUND: f64 = 3.0;
/// Samples that tell the level near one of them.
const NEAR: usize = 41;
/// Standard deviation of normal noise over its median magnitude.
const ROBUST: f64 = 1.4826;
/// Share of the levels left out at either end of their range.
const END: f64 = 0.05;
/// Local robust standard deviations beyond which a sample is far from those near it.
const BEYOND: f64 = 6.0;
/// Samples that a verdict takes, at least.
const FEWEST: usize = 200;

impl Context<'_, '_> {
    /// The noise of every output as far as its level changes.
    pub fn noise_levels(&self, chosen: &Finished) -> Vec<Option<Note>> {
        let residual = self.problem.residual(&chosen.y, Part::All);
        let noise = Stretches::new(self.problem, Part::All).normal(&residual);
        let white = noise.whiten(&residual);
        let samples: Vec<usize> = self.problem.samples(Part::All).collect();
        let of = |(o, e): (usize, &[f64])| {
            let level = self.noise_level(chosen, o, e, &samples);
            level.or_else(|| {
                let mut e = e.to_vec();
                for (e, &k) in e.iter_mut().zip(&samples) {
                    if self.problem.known[o][k] && self.problem.weight[o][k] == 0.0 {
                        let off = (self.problem.y[o][k] - chosen.y[o][k]) / self.problem.scale[o];
                        *e += noise.own_part(o, off);
                    }
                }
                let left_out = chosen.found.spikes.get(o).map_or(0, Vec::len);
                // a remark on why samples that were left out are no outliers
                let freedom = (left_out > 0).then(|| Tails::rather_than_gross_errors(&e))??;
                let output = self.problem.base.signals.outputs[o].name.clone();
                Some(Note::HeavyTails { output, freedom, left_out })
            })
        };
        white.chunks(samples.len().max(1)).enumerate().map(of).collect()
    }

    fn noise_level(
        &self,
        chosen: &Finished,
        o: usize,
        e: &[f64],
        samples: &[usize],
    ) -> Option<Note> {
        let problem = self.problem;
        let known: Vec<f64> = e.iter().filter(|v| **v != 0.0).map(|v| v.abs()).collect();
        let middle = median(&known);
        if known.len() < FEWEST || !(middle > 0.0) {
            return None;
        }
        let bound = BOUND * middle;
        // a sample that was left out for being far off is as large as the bound
        let size = |(e, &k): (&f64, &usize)| match (problem.known[o][k], problem.weight[o][k] > 0.0)
        {
            (false, _) => middle,
            (true, false) => bound,
            (true, true) => e.abs().min(bound),
        };
        let sizes: Vec<f64> = e.iter().zip(samples).map(size).collect();
        let follows = self.followed(chosen, o, &sizes, samples)?;
        let off: Vec<f64> = samples
            .iter()
            .filter(|&&k| problem.known[o][k])
            .map(|&k| (problem.y[o][k] - chosen.y[o][k]).abs())
            .collect();
        let mut levels: Vec<f64> =
            off.windows(NEAR.min(off.len())).map(|near| ROBUST * median(near)).collect();
        levels.sort_by(f64::total_cmp);
        let at = |share: f64| levels[((levels.len() - 1) as f64 * share) as usize];
        let signal = &problem.base.signals.outputs[o];
        Some(Note::NoiseLevel {
            output: signal.name.clone(),
            low: at(END),
            high: at(1.0 - END),
            unit: signal.unit.clone(),
            follows,
            left_out: chosen.found.spikes.get(o).map_or(0, Vec::len),
        })
    }

    /// What a level follows; `None` where it does not change.
    fn followed(
        &self,
        chosen: &Finished,
        o: usize,
        sizes: &[f64],
        samples: &[usize],
    ) -> Option<Follows> {
        let n = sizes.len();
        let whole = 0..n;
        let all = std::slice::from_ref(&whole);
        let nuisance = [vec![1.0; n]];
        let test = |tested: &[Vec<f64>]| {
            let test = Regression { r: sizes, segments: all, nuisance: &nuisance, tested };
            test.test().map_or(1.0, |found| found.p_value)
        };
        let of = |series: &[f64]| -> Vec<f64> { samples.iter().map(|&k| series[k]).collect() };
        let about = |series: &[f64]| {
            let known: Vec<f64> = series.iter().copied().filter(|v| v.is_finite()).collect();
            let (centre, spread) = (mean(&known), deviation(&known).max(f64::MIN_POSITIVE));
            series.iter().map(|v| ((v - centre) / spread).abs()).collect::<Vec<f64>>()
        };
        let time: Vec<f64> = (0..n).map(|k| k as f64 / n as f64).collect();
        let square = time.iter().map(|t| t * t).collect();
        let signals = &self.problem.base.signals;
        let mut found: Vec<(f64, Follows)> = vec![(test(&[time, square]), Follows::Time)];
        let mut ask = |name: &str, series: &[f64]| {
            let (own, size) = (of(series), about(&of(series)));
            found.push((test(&[own, size]), Follows::Signal(name.into())));
        };
        ask(&signals.outputs[o].name, &chosen.y[o]);
        for (signal, series) in signals.inputs.iter().zip(&self.joined.drive.inputs) {
            ask(&signal.name, series);
        }
        let asked = found.len() as f64;
        let best = found.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
        if best.0 * asked < CHANGES {
            return Some(best.1);
        }
        (whiteness(sizes) > REMEMBERS).then_some(Follows::Itself)
    }

    /// Samples that were left out and lie far beyond those near them too.
    pub fn far_from_near(&self, chosen: &Finished, o: usize, rows: &[usize]) -> Vec<usize> {
        let off: Vec<f64> =
            self.problem.y[o].iter().zip(&chosen.y[o]).map(|(a, b)| (a - b).abs()).collect();
        let isolated = |&&k: &&usize| {
            let level = |near: std::ops::Range<usize>| {
                let known = near.filter(|&j| self.problem.known[o][j]);
                median(&known.map(|j| off[j]).collect::<Vec<_>>())
            };
            // a burst may begin or end here
            let before = level(k.saturating_sub(NEAR / 2)..k);
            let after = level(k + 1..(k + 1 + NEAR / 2).min(off.len()));
            off[k] > BEYOND * ROBUST * before.max(after)
        };
        rows.iter().filter(isolated).copied().collect()
    }
}
