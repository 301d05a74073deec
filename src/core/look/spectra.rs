//! Spectra and coherence by Welch's method.
//!
//! Overlapping pieces with Hann windows, half a piece apart, their means taken out (Welch, IEEE
//! Trans. Audio Electroacoust. 15, 1967). With K pieces, of which the overlap leaves 0.947 K
//! independent ones, a line of noise is distributed as chi^2 with 2 K degrees of freedom, and
//! the multiple coherence of unrelated signals with m inputs as Beta(m, K - m) (Goodman 1963;
//! Bendat, Piersol, Random Data, 4th ed. 2010, 9.3).

use nalgebra::DMatrix;
use serde::Serialize;
use statrs::distribution::{Beta, ChiSquared, ContinuousCDF};

use crate::data::Record;
use crate::fourier::{self, Complex};

/// Pieces that are aimed at, and their least and greatest length.
const PIECES: usize = 16;
const SHORTEST: usize = 32;
const LONGEST: usize = 8192;
/// Share of pieces that half an overlap leaves independent.
const INDEPENDENT: f64 = 0.947;
/// Chance, over all lines, at which noise stands out, or unrelated signals are coherent.
pub(super) const LEVEL: f64 = 0.01;
/// Lines on either side that a line is compared with.
const SURROUNDINGS: usize = 12;
/// Inputs whose coherence together is looked at.
const INPUTS: usize = 8;

/// A line that stands out of a spectrum.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Line {
    /// Frequency, Hz.
    pub frequency: f64,
    /// Root mean square of what stands out, in the signal's unit.
    pub rms: f64,
}

/// How much of an output the inputs account for linearly.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Coherence {
    /// The output.
    pub output: String,
    /// Share of the output's power about its mean, corrected for chance, 0 to 1. What is
    /// missing is noise, what is not linear, inputs that were not measured, and starts.
    pub share: f64,
    /// Frequencies, Hz, between which the coherence is above chance, where there are any.
    pub band: Option<[f64; 2]>,
    /// Coherence at every frequency of the spectra.
    #[serde(skip)]
    pub values: Vec<f64>,
}

/// Cross spectra of all signals.
pub(super) struct Spectra {
    /// Hz.
    pub frequency: Vec<f64>,
    /// Pieces, and the length of one.
    pub count: usize,
    length: usize,
    step: f64,
    /// Per pair i <= j of signals.
    cross: Vec<Vec<Complex<f64>>>,
    signals: usize,
}

impl Spectra {
    pub fn of(record: &Record) -> Self {
        let all: Vec<&[f64]> = record.signals().map(|signal| signal.values.as_slice()).collect();
        let n = record.segments.iter().map(|segment| segment.len()).max().unwrap_or(0);
        let wanted = 2 * n / (PIECES + 1);
        let mut length = SHORTEST;
        while 2 * length <= wanted.min(LONGEST) {
            length *= 2;
        }
        let bins = length / 2 + 1;
        let mut own = Self {
            frequency: (0..bins)
                .map(|k| k as f64 / (length as f64 * record.sampling_time))
                .collect(),
            count: 0,
            length,
            step: record.sampling_time,
            cross: vec![vec![Complex::default(); bins]; all.len() * (all.len() + 1) / 2],
            signals: all.len(),
        };
        let window: Vec<f64> = (0..length)
            .map(|k| 0.5 - 0.5 * (std::f64::consts::TAU * k as f64 / length as f64).cos())
            .collect();
        let forward = fourier::forward(length);
        for segment in &record.segments {
            let mut start = segment.start;
            while start + length <= segment.end {
                let pieces: Vec<&[f64]> = all.iter().map(|x| &x[start..start + length]).collect();
                start += length / 2;
                if pieces.iter().any(|piece| piece.iter().any(|v| !v.is_finite())) {
                    continue;
                }
                let lines: Vec<Vec<Complex<f64>>> = pieces
                    .iter()
                    .map(|piece| {
                        let mean = piece.iter().sum::<f64>() / length as f64;
                        let mut time: Vec<f64> =
                            piece.iter().zip(&window).map(|(v, w)| (v - mean) * w).collect();
                        let mut lines = forward.make_output_vec();
                        // lengths fit by construction
                        let _ = forward.process(&mut time, &mut lines);
                        lines
                    })
                    .collect();
                own.count += 1;
                let mut pair = 0;
                for i in 0..all.len() {
                    for j in i..all.len() {
                        for (sum, (a, b)) in
                            own.cross[pair].iter_mut().zip(lines[i].iter().zip(&lines[j]))
                        {
                            *sum += a.conj() * b;
                        }
                        pair += 1;
                    }
                }
            }
        }
        let power: f64 = window.iter().map(|w| w * w).sum();
        let scale = 2.0 * record.sampling_time / (power * own.count.max(1) as f64);
        own.cross.iter_mut().flatten().for_each(|value| *value *= scale);
        own
    }

    fn pair(&self, i: usize, j: usize, k: usize) -> Complex<f64> {
        let (a, b) = (i.min(j), i.max(j));
        let index = a * self.signals - a * (a + 1) / 2 + b;
        let value = self.cross[index][k];
        if i <= j { value } else { value.conj() }
    }

    /// Power spectral density of a signal, unit^2/Hz, one-sided.
    pub fn density(&self, signal: usize) -> Vec<f64> {
        (0..self.frequency.len()).map(|k| self.pair(signal, signal, k).re).collect()
    }

    /// Frequencies with 2.5 % of the power below and above.
    pub fn band(&self, signal: usize) -> Option<[f64; 2]> {
        let density = self.density(signal);
        let total: f64 = density.iter().skip(1).sum();
        if self.count == 0 || !(total > 0.0) {
            return None;
        }
        let (mut sum, mut low) = (0.0, None);
        for (k, value) in density.iter().enumerate().skip(1) {
            sum += value;
            if low.is_none() && sum >= 0.025 * total {
                low = Some(self.frequency[k]);
            }
            if sum >= 0.975 * total {
                return Some([low.unwrap_or(0.0), self.frequency[k]]);
            }
        }
        None
    }

    /// Lines above what noise reaches beside them, ten at most.
    pub fn lines(&self, signal: usize) -> Vec<Line> {
        let density = self.density(signal);
        let bins = density.len();
        let freedom = 2.0 * (INDEPENDENT * self.count as f64).max(1.0);
        let Ok(noise) = ChiSquared::new(freedom) else { return vec![] };
        if self.count < 2 {
            return vec![];
        }
        let middle = noise.inverse_cdf(0.5);
        let bound = noise.inverse_cdf(1.0 - LEVEL / bins as f64) / middle;
        let mut found = Vec::new();
        for k in 2..bins.saturating_sub(2) {
            let value = density[k];
            if !(density[k - 1] < value && density[k + 1] <= value) {
                continue;
            }
            // a Hann window spreads a line over its neighbours
            let neighbours = (1..bins).filter(|i| (3..=SURROUNDINGS).contains(&i.abs_diff(k)));
            let mut others: Vec<f64> = neighbours.map(|i| density[i]).collect();
            others.sort_by(f64::total_cmp);
            let floor = others.get(others.len() / 2).copied().unwrap_or(f64::INFINITY);
            // on both sides, so that an edge of a band is no line
            let side = |range: std::ops::Range<usize>| {
                (range.start.max(1)..range.end.min(bins)).map(|i| density[i]).fold(0.0, f64::max)
            };
            let (left, right) =
                (side(k.saturating_sub(SURROUNDINGS)..k - 2), side(k + 3..k + SURROUNDINGS + 1));
            if value > bound * floor && value > 4.0 * left.max(right) {
                let width = 1.0 / (self.length as f64 * self.step);
                let power: f64 = density[k - 2..=k + 2].iter().map(|v| (v - floor).max(0.0)).sum();
                found.push(Line { frequency: self.frequency[k], rms: (power * width).sqrt() });
            }
        }
        found.sort_by(|a, b| b.rms.total_cmp(&a.rms));
        found.truncate(10);
        found
    }

    /// Coherence of every output with all inputs together.
    pub fn coherences(&self, record: &Record, level: f64) -> Vec<Coherence> {
        let inputs: Vec<usize> = (0..record.inputs.len())
            .filter(|&i| self.density(i).iter().skip(1).sum::<f64>() > 0.0)
            .collect();
        let m = inputs.len();
        let pieces = INDEPENDENT * self.count as f64;
        if m == 0 || m > INPUTS || pieces < m as f64 + 2.0 {
            return vec![];
        }
        let free = pieces - m as f64;
        let bound = Beta::new(m as f64, free)
            .map_or(1.0, |beta| beta.inverse_cdf(1.0 - level / self.frequency.len() as f64));
        let outputs = record.outputs.iter().enumerate();
        outputs
            .map(|(o, output)| {
                let y = record.inputs.len() + o;
                let values: Vec<f64> =
                    (0..self.frequency.len()).map(|k| self.coherence(&inputs, y, k)).collect();
                let density = self.density(y);
                let (mut explained, mut total) = (0.0, 0.0);
                for (gamma, power) in values.iter().zip(&density).skip(1) {
                    let fair = 1.0 - (1.0 - gamma) * pieces / free;
                    explained += fair.max(0.0) * power;
                    total += power;
                }
                let above: Vec<usize> = (1..values.len()).filter(|&k| values[k] > bound).collect();
                let ends = above.first().zip(above.last());
                Coherence {
                    output: output.name.clone(),
                    share: if total > 0.0 { explained / total } else { 0.0 },
                    band: ends.map(|(a, b)| [self.frequency[*a], self.frequency[*b]]),
                    values,
                }
            })
            .collect()
    }

    /// S_yu S_uu^-1 S_uy / S_yy at one line.
    fn coherence(&self, inputs: &[usize], y: usize, k: usize) -> f64 {
        let power = self.pair(y, y, k).re;
        if !(power > 0.0) {
            return 0.0;
        }
        let complex = |c: Complex<f64>| nalgebra::Complex::new(c.re, c.im);
        let m = inputs.len();
        let uu = DMatrix::from_fn(m, m, |i, j| complex(self.pair(inputs[i], inputs[j], k)));
        let uy = DMatrix::from_fn(m, 1, |i, _| complex(self.pair(inputs[i], y, k)));
        // where an input has nothing at this line, the others answer
        let spread = uu.diagonal().iter().map(|d| d.re).fold(0.0, f64::max);
        let Ok(inverse) = uu.pseudo_inverse(1e-10 * spread.max(f64::MIN_POSITIVE)) else {
            return 0.0;
        };
        let explained = (uy.adjoint() * inverse * &uy)[(0, 0)].re;
        (explained / power).clamp(0.0, 1.0)
    }
}
