//! When an extended model takes over from the model as it was: profile likelihood of the moment.
//!
//! ```text
//! p(k | y) ~ p(y | the model until k, then the extended one from the state that the model has at k)
//! ```
//!
//! The errors of that run are coloured noise, with the numbers that the most probable moment leaves. The
//! time is the mean of the posterior under a flat prior, its standard error the root of the variance.
//! Source: Basseville and Nikiforov, "Detection of Abrupt Changes", 1993, section 7.2.

use std::ops::Range;

use crate::data::Record;
use crate::evaluate::{EvaluateError, Init, Run};
use crate::findings::cause::Onset;
use crate::likelihood::OutputNoise;
use crate::statistics::rms;
use crate::system::{Drive, Origin, System};

/// Share of a record on either side of a guess that the moment is looked for in, and samples at most.
const AROUND: (f64, usize) = (0.25, 8000);
/// Moments of a round over the range, and of one about the best of it.
const MOMENTS: usize = 48;
/// Samples after the range that are compared, at most.
const AFTER: usize = 4000;
/// Fall of the log likelihood beyond which moments have no part in the posterior.
const FAR: f64 = 12.0;

/// What is left of every measured output, sample by sample.
type Errors = Vec<Vec<f64>>;

/// A moment, and the sample that it falls on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moment {
    pub sample: usize,
    pub onset: Onset,
}

impl Moment {
    /// Whether its 95 % interval leaves out the beginning of the record: else what begins then may as
    /// well have been there always.
    pub fn is_within(&self, record: &Record) -> bool {
        self.onset.time - 1.96 * self.onset.std_error.unwrap_or(0.0) > record.start
    }
}

/// When `after` takes over from `before` in a record of one segment, near a guess; `None` where neither can
/// be followed.
pub(super) fn moment(
    (before, after): (&System, &System),
    record: &Record,
    guess: usize,
) -> Result<Option<Moment>, EvaluateError> {
    let n = record.len();
    let reach = ((AROUND.0 * n as f64) as usize).clamp(1, AROUND.1);
    let range = guess.saturating_sub(reach).max(1)..(guess + reach).min(n - 1);
    let Some(runs) = Runs::new(before, after, record, range.clone())? else { return Ok(None) };
    let mut moments = grid(&range, MOMENTS);
    let errors = |&k: &usize| Some((k, runs.errors(k)?));
    let first: Vec<(usize, Errors)> = moments.iter().filter_map(errors).collect();
    let Some(noise) = noise(&first) else { return Ok(None) };
    let likely = |(k, errors): (usize, Errors)| {
        let value: f64 = errors.iter().zip(&noise).map(|(e, own)| own.log_density(e)).sum();
        value.is_finite().then_some((k, value))
    };
    let mut known: Vec<(usize, f64)> = first.into_iter().filter_map(likely).collect();
    // over the range, then ever finer about the best as long as that leaves samples out
    loop {
        let step = moments.windows(2).map(|two| two[1] - two[0]).max().unwrap_or(1);
        let top = known.iter().map(|(_, l)| *l).fold(f64::NEG_INFINITY, f64::max);
        let near: Vec<usize> =
            known.iter().filter(|(_, l)| *l > top - FAR).map(|(k, _)| *k).collect();
        let (Some(&first), Some(&last)) = (near.first(), near.last()) else { return Ok(None) };
        let inner =
            first.saturating_sub(step).max(range.start)..(last + step).min(range.end - 1) + 1;
        moments = grid(&inner, MOMENTS);
        let new: Vec<usize> =
            moments.iter().copied().filter(|k| known.iter().all(|(own, _)| own != k)).collect();
        if step <= 1 || new.is_empty() || near.len() >= MOMENTS / 2 {
            return Ok(Some(posterior(record, &known, top)));
        }
        known.extend(new.iter().filter_map(errors).filter_map(likely));
        known.sort_by_key(|(k, _)| *k);
    }
}

/// Mean and standard deviation of the moment, and the most probable one.
fn posterior(record: &Record, known: &[(usize, f64)], top: f64) -> Moment {
    // a moment stands for the samples nearer to it than to the others
    let weight = |i: usize| {
        let left = if i > 0 { known[i].0 - known[i - 1].0 } else { 0 };
        let right = known.get(i + 1).map_or(0, |next| next.0 - known[i].0);
        (known[i].1 - top).exp() * (left + right).max(1) as f64
    };
    let weights: Vec<f64> = (0..known.len()).map(weight).collect();
    let sum: f64 = weights.iter().sum();
    let average = |of: &dyn Fn(f64) -> f64| {
        let terms = known.iter().zip(&weights).map(|((k, _), w)| w * of(*k as f64));
        terms.sum::<f64>() / sum
    };
    let mean = average(&|k| k);
    let variance = average(&|k| (k - mean).powi(2));
    // within a sample any moment is as probable
    let spread = (variance + 1.0 / 12.0).sqrt() * record.sampling_time;
    let at = known.iter().max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(k, _)| *k);
    let time = record.start + mean * record.sampling_time;
    Moment { sample: at, onset: Onset { time, std_error: Some(spread) } }
}

/// So many samples of a range, spread evenly.
fn grid(range: &Range<usize>, count: usize) -> Vec<usize> {
    let last = range.len().saturating_sub(1);
    let count = count.min(range.len()).max(1);
    let at = |i: usize| range.start + i * last / (count - 1).max(1);
    let mut all: Vec<usize> = (0..count).map(at).collect();
    all.dedup();
    all
}

/// Both models along the samples of a record that are compared.
struct Runs<'a> {
    after: Run<'a>,
    /// Outputs of the model as it was, and its states, sample by sample.
    outputs: Vec<Vec<f64>>,
    states: Vec<Vec<f64>>,
    /// Outputs that were measured.
    measured: Vec<usize>,
    /// The first sample that is compared.
    first: usize,
}

impl<'a> Runs<'a> {
    fn new(
        before: &'a System,
        after: &'a System,
        record: &Record,
        range: Range<usize>,
    ) -> Result<Option<Self>, EvaluateError> {
        let whole = Run::new(before, record)?;
        let Some(start) = whole.starts(whole.init_samples(Init::Forgotten)).pop() else {
            return Ok(None);
        };
        let lane = whole.lane(vec![start]);
        let lead = whole.system.run(&whole.plan, &whole.first(range.start), &[lane]);
        let compared = record.slice(range.start..range.end + AFTER);
        let own = Run::new(before, &compared)?;
        let lane = own.lane(lead.into_iter().map(|lead| lead.last).collect());
        let mut track = own.system.run_seen(&own.plan, &own.drive, &lane);
        let states = (0..own.plan.sizes.x).map(|i| own.plan.sources.at(Origin::State(i)));
        let Some(states) = states.collect::<Option<Vec<usize>>>().filter(|_| track.is_finite())
        else {
            return Ok(None);
        };
        let states = states.into_iter().map(|entry| std::mem::take(&mut track.seen[entry]));
        let after = Run::new(after, &compared)?;
        let measured = (0..track.y.len()).filter(|&o| after.measured[o].is_some()).collect();
        Ok(Some(Self {
            after,
            outputs: track.y,
            states: states.collect(),
            measured,
            first: range.start,
        }))
    }

    /// What is left of every measured output when the extended model takes over at a sample.
    fn errors(&self, k: usize) -> Option<Errors> {
        let (run, k) = (&self.after, k - self.first);
        let n = run.drive.len();
        let drive = Drive { segments: std::iter::once(k..n).collect(), ..run.drive.clone() };
        let lane = run.lane(vec![self.states.iter().map(|x| x[k]).collect()]);
        let track = run.system.run(&run.plan, &drive, &[lane]).swap_remove(0);
        if !track.is_finite() {
            return None;
        }
        let error = |&o: &usize| {
            let y = run.measured[o].as_ref()?;
            let simulated = |t: usize| if t < k { self.outputs[o][t] } else { track.y[o][t] };
            Some((0..n).map(|t| y[t] - simulated(t)).collect())
        };
        self.measured.iter().map(error).collect()
    }
}

/// The noise of every output by the moment that leaves least, were it white and of any level.
fn noise(moments: &[(usize, Errors)]) -> Option<Vec<OutputNoise>> {
    let level = |e: &Vec<f64>| {
        let known: Vec<f64> = e.iter().copied().filter(|e| e.is_finite()).collect();
        known.len() as f64 * rms(&known).ln()
    };
    let all = moments.iter().map(|(_, errors)| (errors.iter().map(level).sum::<f64>(), errors));
    let least = all.filter(|(level, _)| !level.is_nan()).min_by(|a, b| a.0.total_cmp(&b.0))?.1;
    Some(least.iter().map(|e| OutputNoise::of(e)).collect())
}
