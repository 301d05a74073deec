//! What periodic inputs that leave lines empty show without any model: odd and even
//! distortion, and noise, at the same lines.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::data::Record;
use crate::statistics::{Averaged, deviation, lines, mean};

/// Chance at which noise alone passes for a distortion.
const LEVEL: f64 = 1e-3;
/// An input line below this share of its strongest is empty.
const EMPTY: f64 = 1e-3;
/// Empty lines within the excited band that suffice; with fewer, those above it count too,
const ENOUGH: usize = 8;
/// up to this multiple of the highest excited line.
const BEYOND: usize = 9;
/// Share of the samples that may be missing.
const MISSING: f64 = 0.05;

/// What stands at one kind of lines of an output.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AtLines {
    /// Root mean square at these lines of the average over the periods, its noise included,
    /// in the output's unit.
    pub rms: f64,
    /// What noise alone would make of that, from the differences between the periods.
    pub noise_rms: f64,
    /// Number of lines.
    pub lines: usize,
    /// Whether the power at these lines is above the noise's by more than chance.
    pub present: bool,
}

/// Distortion of one output under an input that excites odd lines only.
///
/// A law that is odd about the operating point, f(-x) = -f(x), answers odd lines with odd
/// lines, an even one with even lines, so that what stands at lines that the input leaves
/// empty tells which is there; what differs from period to period is noise. With the
/// Fourier lines Y_p(k) of P periods (whitened by an autoregression of the differences
/// between periods), their mean Y(k) and s2(k), the variance of that mean from the scatter of
/// the periods, a distortion is there where `sum |Y(k)|^2 / sum s2(k)` passes the 0.1 % point
/// of F(2 L, 2 L (P - 1)), L being the number of lines. What an input that is nearly empty at a line can cause there by the largest gain
/// at excited lines is added to s2 (Pintelon, Schoukens, System Identification: A Frequency
/// Domain Approach, 2nd ed. 2012, Ch. 4).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Distortion {
    /// Root mean square at the excited lines, in the output's unit.
    pub excited_rms: f64,
    /// Noise at the excited lines, in the average over the periods.
    pub excited_noise_rms: f64,
    /// At empty odd lines; `None` where there are none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub odd: Option<AtLines>,
    /// At empty even lines.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub even: Option<AtLines>,
    /// Whole periods that were averaged.
    pub periods: usize,
    /// Whether the inputs have no mean, so that the operating point is zero.
    pub about_zero: bool,
}

/// What the first record of enough periods shows of distortion, per output.
pub fn distortion(records: &[Record]) -> BTreeMap<String, Distortion> {
    let Some((record, lit)) = records.iter().find_map(|r| Some((r, Lit::of(r)?))) else {
        return BTreeMap::new();
    };
    let of =
        |output: &crate::data::Signal| Some((output.name.clone(), lit.distortion(&output.values)?));
    record.outputs.iter().filter_map(of).collect()
}

/// Which lines of a record's period its inputs excite.
struct Lit {
    samples: usize,
    count: usize,
    /// Excited lines, all odd.
    excited: Vec<usize>,
    highest: usize,
    /// What the inputs have at every line, as a share of their strongest.
    share: Vec<f64>,
    /// Whether the inputs have no mean to speak of.
    centred: bool,
}

impl Lit {
    /// `None` where inputs do not repeat, or do not excite odd lines only.
    fn of(record: &Record) -> Option<Self> {
        let periods = record.periods()?;
        let mut share = vec![0.0_f64; periods.samples / 2 + 1];
        let mut centred = true;
        for input in &record.inputs {
            let u = &input.values[..periods.samples];
            let spread = deviation(u);
            if !(spread > 1e-12 * mean(u).abs()) {
                centred &= mean(u) == 0.0;
                continue;
            }
            centred &= mean(u).abs() < 0.01 * spread;
            let all: Vec<f64> = lines(u).iter().map(|line| line.norm()).collect();
            let strongest = all.iter().skip(1).copied().fold(0.0, f64::max);
            for (share, line) in share.iter_mut().zip(&all) {
                *share = share.max(line / strongest);
            }
        }
        let excited: Vec<usize> = (1..share.len()).filter(|&k| share[k] > EMPTY).collect();
        let odd_only = excited.iter().all(|k| k % 2 == 1);
        let highest = *excited.last().filter(|_| odd_only)?;
        Some(Self {
            samples: periods.samples,
            count: periods.count,
            excited,
            highest,
            share,
            centred,
        })
    }

    /// Empty lines of one parity: within the excited band, or above it where there are too few.
    fn empty(&self, parity: usize) -> Vec<usize> {
        let top = (self.samples - 1) / 2;
        let up_to = |end: usize| -> Vec<usize> {
            let here = (1..=end.min(top)).filter(|k| k % 2 == parity);
            here.filter(|&k| self.share[k] <= EMPTY).collect()
        };
        let within = up_to(self.highest);
        if within.len() >= ENOUGH { within } else { up_to(BEYOND * self.highest) }
    }

    fn distortion(&self, y: &[f64]) -> Option<Distortion> {
        let mut periods = whole(y, self.samples, self.count)?;
        // a start that has not settled: the first period is unlike the others
        let band: Vec<usize> = (1..=self.highest).filter(|k| 2 * k < self.samples).collect();
        let settled = |periods: &[Vec<f64>]| {
            periods.len() < 3 || Averaged::of(&periods[1..]).unlike(&periods[0], &band) >= LEVEL
        };
        while !settled(&periods) {
            periods.remove(0);
        }
        let average = Averaged::of(&periods);
        let excited: Vec<usize> =
            self.excited.iter().copied().filter(|k| 2 * k < self.samples).collect();
        let gain = excited.iter().map(|&k| average.power[k] / self.share[k].powi(2));
        let gain = gain.fold(0.0, f64::max);
        let (power, noise) = average.sums(&excited);
        let kind = |parity: usize| {
            let lines = self.empty(parity);
            let (power, noise) = average.sums(&lines);
            (!lines.is_empty()).then(|| AtLines {
                rms: power.sqrt(),
                noise_rms: noise.sqrt(),
                lines: lines.len(),
                present: average.tail(&lines, |k| gain * self.share[k].powi(2)) < LEVEL,
            })
        };
        let (odd, even) = (kind(1), kind(0));
        (odd.is_some() || even.is_some()).then(|| Distortion {
            excited_rms: power.sqrt(),
            excited_noise_rms: noise.sqrt(),
            odd,
            even,
            periods: average.periods,
            about_zero: self.centred,
        })
    }
}

/// The last `count` whole periods, a missing sample filled by the mean of its fellows; `None`
/// where too much is missing or less than two periods are left.
fn whole(y: &[f64], samples: usize, count: usize) -> Option<Vec<Vec<f64>>> {
    let end = y.len();
    let all = (0..count).rev().map(|p| &y[end - (p + 1) * samples..end - p * samples]);
    let missing = |period: &[f64]| period.iter().filter(|v| !v.is_finite()).count() as f64;
    let kept: Vec<&[f64]> = all.filter(|p| missing(p) <= MISSING * samples as f64).collect();
    if kept.len() < 2 {
        return None;
    }
    let mut fellows = vec![];
    for k in 0..samples {
        let known: Vec<f64> = kept.iter().map(|p| p[k]).filter(|v| v.is_finite()).collect();
        if known.is_empty() {
            return None;
        }
        fellows.push(mean(&known));
    }
    let fill = |p: &[f64]| -> Vec<f64> {
        p.iter().zip(&fellows).map(|(v, m)| if v.is_finite() { *v } else { *m }).collect()
    };
    Some(kept.into_iter().map(fill).collect())
}

#[cfg(test)]
#[path = "distortion_tests.rs"]
mod tests;
