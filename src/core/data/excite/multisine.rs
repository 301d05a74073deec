//! A sum of sines that share a period: the excitation with a spectrum to order.

use super::{crest_factor, positive, samples, scale_to};
use crate::data::error::DataError;
use crate::data::random::Random;
use crate::fourier::{self, Complex, ComplexToReal, RealToComplex};
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// A multisine with a flat spectrum on its excited lines.
///
/// Line `k` is the frequency `k / (period sampling_time)` in Hz; those from 1 up to, but
/// not including, half the sampling rate can be excited. Over whole periods the root mean
/// square is exactly `rms` and the mean 0.
///
/// ```
/// use lacuna::data::{Lines, Multisine, Phases, crest_factor};
///
/// let random = Multisine {
///     period: 1000,
///     lines: Lines::Odd { from: 1, to: Some(199) },
///     rms: 2.0,
///     phases: Phases::Random,
///     crest_iterations: 0,
/// };
/// let flat = Multisine { crest_iterations: 100, ..random.clone() };
/// let (u, v) = (random.generate(2000, 0.01, 0)?, flat.generate(2000, 0.01, 0)?);
/// assert_eq!(u[..1000], u[1000..]);
/// assert!(crest_factor(&v) < crest_factor(&u));
/// # Ok::<(), lacuna::data::DataError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Multisine {
    /// Samples in one period.
    pub period: usize,
    /// The excited lines.
    pub lines: Lines,
    /// Root mean square over a period, in the signal's unit.
    pub rms: f64,
    /// How the phases are chosen.
    #[serde(default)]
    pub phases: Phases,
    /// Rounds of clipping and phase correction that lower the crest factor; the best
    /// signal met is taken.
    #[serde(default)]
    pub crest_iterations: usize,
}

/// Which lines of a multisine are excited. `from` and `to` are included; without `to`
/// they reach up to half the sampling rate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Lines {
    /// All lines of a band.
    Full {
        /// First line.
        #[serde(default = "first")]
        from: usize,
        /// Last line.
        #[serde(default)]
        to: Option<usize>,
    },
    /// The odd lines of a band: even nonlinearities show at the even lines.
    Odd {
        /// First line.
        #[serde(default = "first")]
        from: usize,
        /// Last line.
        #[serde(default)]
        to: Option<usize>,
    },
    /// The odd lines of a band without one, drawn at random, of each `group` in a row:
    /// odd nonlinearities show at the lines left out.
    OddRandom {
        /// First line.
        #[serde(default = "first")]
        from: usize,
        /// Last line.
        #[serde(default)]
        to: Option<usize>,
        /// Odd lines of which one is left out, at least 2.
        group: usize,
    },
    /// These lines.
    List(Vec<usize>),
}

fn first() -> usize {
    1
}

/// How the phases of a multisine are chosen.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Phases {
    /// Uniform and independent.
    #[default]
    Random,
    /// `-pi i (i - 1) / N` for the i-th of N lines: a low crest factor without a search.
    Schroeder,
}

impl Multisine {
    /// The first `n` samples, the period repeated as often as needed. `seed` draws
    /// random phases and the lines left out.
    ///
    /// # Errors
    ///
    /// A setting outside its range, by its name.
    pub fn generate(&self, n: usize, sampling_time: f64, seed: u64) -> Result<Vec<f64>, DataError> {
        samples("samples", n)?;
        positive("sampling_time", sampling_time)?;
        positive("rms", self.rms)?;
        let mut random = Random::new(seed);
        let lines = self.draw_lines(&mut random)?;
        let count = lines.len() as f64;
        let phases: Vec<f64> = (0..lines.len())
            .map(|i| match self.phases {
                Phases::Random => TAU * random.uniform(),
                Phases::Schroeder => -PI * i as f64 * (i as f64 + 1.0) / count,
            })
            .collect();
        let mut period = Period::new(self.period).lower(&lines, phases, self.crest_iterations);
        scale_to(&mut period, self.rms);
        Ok(period.into_iter().cycle().take(n).collect())
    }

    /// The lines that [`Multisine::generate`] excites with this seed, in order.
    ///
    /// # Errors
    ///
    /// A setting outside its range, by its name.
    pub fn excited(&self, seed: u64) -> Result<Vec<usize>, DataError> {
        self.draw_lines(&mut Random::new(seed))
    }

    fn draw_lines(&self, random: &mut Random) -> Result<Vec<usize>, DataError> {
        let highest = samples("period", self.period)?.saturating_sub(1) / 2;
        if highest == 0 {
            return Err(DataError::setting("period", self.period as f64, "at least 3 samples"));
        }
        let odd = |from: usize, to: Option<usize>| {
            (from..=to.unwrap_or(highest)).filter(|line| line % 2 == 1)
        };
        let band = match &self.lines {
            Lines::List(_) => None,
            Lines::Full { from, to }
            | Lines::Odd { from, to }
            | Lines::OddRandom { from, to, .. } => Some((*from, to.unwrap_or(highest))),
        };
        if let Some(outside) = band.and_then(|(from, to)| {
            [from, to].into_iter().find(|line| *line == 0 || *line > highest || from > to)
        }) {
            let rule = "a band of lines from 1 to below half the period";
            return Err(DataError::setting("lines", outside as f64, rule));
        }
        let lines: Vec<usize> = match &self.lines {
            Lines::Full { from, to } => (*from..=to.unwrap_or(highest)).collect(),
            Lines::Odd { from, to } => odd(*from, *to).collect(),
            Lines::OddRandom { group, .. } if *group < 2 => {
                return Err(DataError::setting("group", *group as f64, "at least 2"));
            }
            Lines::OddRandom { from, to, group } => {
                let mut lines: Vec<usize> = odd(*from, *to).collect();
                // from the last group down, so that the places before stay as they are
                for k in (0..lines.len() / group).rev() {
                    lines.remove(k * group + random.below(*group as u64) as usize);
                }
                lines
            }
            Lines::List(lines) => {
                let mut lines = lines.clone();
                lines.sort_unstable();
                let twice = lines.windows(2).find(|pair| pair[0] == pair[1]).map(|pair| pair[0]);
                let outside = lines.iter().copied().find(|line| *line == 0 || *line > highest);
                if let Some(line) = twice.or(outside) {
                    let rule = "a line from 1 to below half the period, listed once";
                    return Err(DataError::setting("lines", line as f64, rule));
                }
                lines
            }
        };
        if lines.is_empty() {
            return Err(DataError::setting("lines", 0.0, "at least one line"));
        }
        Ok(lines)
    }
}

/// One period in time and frequency.
struct Period {
    to_time: Arc<dyn ComplexToReal<f64>>,
    to_lines: Arc<dyn RealToComplex<f64>>,
}

impl Period {
    fn new(samples: usize) -> Self {
        Self { to_time: fourier::inverse(samples), to_lines: fourier::forward(samples) }
    }

    fn time(&self, lines: &[usize], phases: &[f64]) -> Vec<f64> {
        let mut spectrum = self.to_time.make_input_vec();
        for (line, phase) in lines.iter().zip(phases) {
            spectrum[*line] = Complex::from_polar(1.0, *phase);
        }
        let mut signal = self.to_time.make_output_vec();
        // the lengths agree and the ends of the spectrum are 0: nothing to fail
        let _ = self.to_time.process(&mut spectrum, &mut signal);
        signal
    }

    /// Clips the peaks, takes the phases of what results and puts the amplitudes back, as
    /// often as told. Clips deep at first and less and less (after E. van der Ouderaa,
    /// J. Schoukens, J. Renneboog, IEEE Trans. Instrum. Meas. 37, 1988).
    fn lower(&self, lines: &[usize], mut phases: Vec<f64>, iterations: usize) -> Vec<f64> {
        let mut best = self.time(lines, &phases);
        let mut signal = best.clone();
        let mut spectrum = self.to_lines.make_output_vec();
        for iteration in 0..iterations {
            let depth = 0.75 + 0.24 * iteration as f64 / iterations as f64;
            let peak = signal.iter().fold(0.0_f64, |peak, value| peak.max(value.abs()));
            signal.iter_mut().for_each(|x| *x = x.clamp(-depth * peak, depth * peak));
            let _ = self.to_lines.process(&mut signal, &mut spectrum);
            for (line, phase) in lines.iter().zip(&mut phases) {
                *phase = spectrum[*line].arg();
            }
            signal = self.time(lines, &phases);
            if crest_factor(&signal) < crest_factor(&best) {
                best.copy_from_slice(&signal);
            }
        }
        best
    }
}

#[cfg(test)]
#[path = "multisine_tests.rs"]
mod tests;
