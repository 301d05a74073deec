//! Whether inputs react to the outputs: records of a closed loop.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use serde::Serialize;

use crate::data::Record;
use crate::findings::context::Context;
use crate::fit::finished::Finished;
use crate::fit::problem::{Part, Problem};
use crate::prepare::operating_range::Nominal;
use crate::statistics::{deviation, mean, wald};

/// Score above which an input reacts; chance passes it in one of 30 000 tests.
const REACTS: f64 = 4.0;
/// Past samples that predict an input, and what is left, without feedback.
const PAST: usize = 20;
/// Samples that an input may be late with its reaction.
const DELAYS: [usize; 10] = [0, 1, 2, 3, 4, 6, 8, 11, 15, 20];
/// Damping of regressions, as a share of what the columns hold: of those that take out the
/// past, and of those that look for a reaction.
const PAST_RIDGE: f64 = 1e-9;
const RIDGE: f64 = 0.05;
/// Rows per column, at least, and rows at most.
const ROWS: usize = 8;
const MOST: usize = 20_000;

/// An input that reacts to what is noise for the model.
///
/// What the final model leaves of the outputs is whitened by its own past and that of the
/// inputs. In an open loop, no input can know of it; in a closed one, the part of an input that
/// the past of the inputs does not predict depends on it (Granger, Econometrica 37, 1969; Sims,
/// American Economic Review 62, 1972). A regression made on either half of the record predicts
/// the other, and the score is that of the prediction, with a block-robust error bar.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ClosedLoop {
    /// The input.
    pub input: String,
    /// Score that it reacts.
    pub score: f64,
    /// Whether it shows in the same sample only: a reaction without delay, or a direct path
    /// from the input to the output that the model does not have.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub same_sample_only: bool,
}

impl Context<'_, '_> {
    /// The input that reacts most to the outputs, if one does.
    pub fn feedback(&self, chosen: &Finished, used: &[Record]) -> Option<ClosedLoop> {
        // what repeats exactly while the noise does not reacts to nothing
        let repeats = used.iter().all(|record| record.periods().is_some());
        (!repeats).then(|| closed_loop(self.problem, self.nominal, &chosen.y)).flatten()
    }
}

/// The input that reacts most to what a model's outputs `y` leave, if one does.
fn closed_loop(problem: &Problem<'_>, nominal: &Nominal, y: &[Vec<f64>]) -> Option<ClosedLoop> {
    let stretches = problem.stretches(Part::All);
    let left: Vec<Vec<f64>> = (0..problem.y.len())
        .map(|o| {
            let off = |k: usize| problem.weight[o][k] * (problem.y[o][k] - y[o][k]);
            (0..problem.len()).map(off).collect()
        })
        .collect();
    // an output that has something of the input of the same sample may have more of it
    let follows: Vec<bool> =
        (0..problem.y.len()).map(|o| nominal.first_lag(problem, o) > 0).collect();
    let loops = scores(&problem.drive.inputs, (&left, &follows), &stretches);
    let names = &problem.base.signals.inputs;
    let found = loops.into_iter().zip(names).filter_map(|((at_once, later), signal)| {
        let (score, same_sample_only) = match later > REACTS {
            true => (later, false),
            false => (at_once, true),
        };
        let input = signal.name.clone();
        (score > REACTS).then_some(ClosedLoop { input, score, same_sample_only })
    });
    found.max_by(|a, b| a.score.total_cmp(&b.score))
}

/// Per input, the score that it reacts at once to what is left of outputs that it does not reach at once
/// (`follows`), and with a delay to what is left of any.
fn scores(
    inputs: &[Vec<f64>],
    (left, follows): (&[Vec<f64>], &[bool]),
    stretches: &[Range<usize>],
) -> Vec<(f64, f64)> {
    let past = PAST.min(stretches.iter().map(ExactSizeIterator::len).max().unwrap_or(0) / 8);
    let mut rows: Vec<usize> = stretches.iter().flat_map(|s| s.start + past..s.end).collect();
    rows.drain(..rows.len().saturating_sub(MOST));
    let columns = past * (inputs.len() + left.len());
    if past < 4 || rows.len() < ROWS * columns {
        return vec![(0.0, 0.0); inputs.len()];
    }
    let lagged = |series: &[Vec<f64>], lags: Range<usize>| -> Vec<Vec<f64>> {
        let one = |x: &Vec<f64>, lag: usize| rows.iter().map(|&k| x[k - lag]).collect();
        series.iter().flat_map(|x| lags.clone().map(move |lag| one(x, lag))).collect()
    };
    let at_rows = |x: &Vec<f64>| -> Vec<f64> { rows.iter().map(|&k| x[k]).collect() };
    let driven = lagged(inputs, 1..past + 1);
    let both: Vec<Vec<f64>> = driven.iter().cloned().chain(lagged(left, 1..past + 1)).collect();
    let news: Vec<Vec<f64>> = left.iter().map(|e| unpredicted(&at_rows(e), &both)).collect();
    // news by sample, so that it can be delayed; rows of one stretch stand side by side
    let mut by_sample = vec![vec![0.0; left[0].len()]; left.len()];
    for (series, news) in by_sample.iter_mut().zip(&news) {
        rows.iter().zip(news).for_each(|(&k, v)| series[k] = *v);
    }
    let delayed = |delay: usize| lagged(&by_sample, delay..delay + 1);
    let late: Vec<Vec<f64>> =
        DELAYS.iter().filter(|d| (1..=past).contains(*d)).flat_map(|&d| delayed(d)).collect();
    let asked = delayed(0).into_iter().zip(follows).filter(|(_, follows)| **follows);
    let at_once: Vec<Vec<f64>> = asked.map(|(news, _)| news).collect();
    let own: Vec<Vec<f64>> = inputs.iter().map(|u| unpredicted(&at_rows(u), &driven)).collect();
    let of = |own: &Vec<f64>| (reaction(own, &at_once), reaction(own, &late));
    own.iter().map(of).collect()
}

/// Weights of centred columns that predict a target on some of the rows.
fn regression(target: &[f64], columns: &[Vec<f64>], rows: &Range<usize>, ridge: f64) -> Vec<f64> {
    let a = DMatrix::from_fn(rows.len(), columns.len(), |i, j| columns[j][rows.start + i]);
    let b = DVector::from_fn(rows.len(), |i, _| target[rows.start + i]);
    let mut gram = a.transpose() * &a;
    let typical = gram.trace() / columns.len().max(1) as f64;
    for j in 0..columns.len() {
        gram[(j, j)] += ridge * gram[(j, j)] + 1e-3 * ridge * typical + f64::MIN_POSITIVE;
    }
    let right = a.transpose() * b;
    gram.cholesky()
        .map_or_else(|| vec![0.0; columns.len()], |g| g.solve(&right).as_slice().to_vec())
}

fn predicted(columns: &[Vec<f64>], weights: &[f64], k: usize) -> f64 {
    columns.iter().zip(weights).map(|(column, w)| w * column[k]).sum()
}

fn centred(x: &[f64]) -> Vec<f64> {
    let centre = mean(x);
    x.iter().map(|v| v - centre).collect()
}

/// What columns do not predict of a target, all rows together.
fn unpredicted(target: &[f64], columns: &[Vec<f64>]) -> Vec<f64> {
    let target = centred(target);
    let columns: Vec<Vec<f64>> = columns.iter().map(|c| centred(c)).collect();
    let weights = regression(&target, &columns, &(0..target.len()), PAST_RIDGE);
    (0..target.len()).map(|k| target[k] - predicted(&columns, &weights, k)).collect()
}

/// Score that columns predict a target: each half is predicted from the other.
fn reaction(target: &[f64], columns: &[Vec<f64>]) -> f64 {
    let n = target.len();
    if columns.is_empty() || deviation(target) == 0.0 {
        return 0.0;
    }
    let mut guess = vec![0.0; n];
    for (learn, try_on) in [(0..n / 2, n / 2..n), (n / 2..n, 0..n / 2)] {
        let weights = regression(target, columns, &learn, RIDGE);
        for k in try_on {
            guess[k] = predicted(columns, &weights, k);
        }
    }
    let ff: Vec<f64> = guess.iter().map(|g| g * g).collect();
    let fr: Vec<f64> = guess.iter().zip(target).map(|(g, t)| g * t).collect();
    wald(&ff, &fr)
}

#[cfg(test)]
#[path = "closed_loop_tests.rs"]
mod tests;
