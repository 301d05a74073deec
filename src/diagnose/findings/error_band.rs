//! Frequencies that the model's error keeps to.

use std::collections::BTreeMap;
use std::ops::Range;

use serde::Serialize;

use crate::findings::context::Context;
use crate::fit::finished::Finished;
use crate::fit::problem::Part;
use crate::prepare::input_dependence::DEPENDS;
use crate::statistics::{pieces, spread};
use crate::validate::noise_floor::NoiseFloor;

/// Share of a power that its band holds.
const SHARE: f64 = 0.95;
/// An error is told from noise by at least this share of the noise's power
const ABOVE: f64 = 0.2;
/// and by so many standard errors, from what its pieces hold,
const CHANCE: f64 = 4.0;
/// A band is narrow below this share of the width of the output's own,
const NARROW: f64 = 0.5;
/// or where it holds less than this share of the output's power.
const ASIDE: f64 = 0.1;
/// Lines of the output's band that are enough to speak of a part of it.
const ENOUGH: usize = 10;
/// Pieces that a record is cut into, at least; lines of a piece, at most.
const PIECES: usize = 16;
const LONGEST: usize = 2048;

/// The band in which what the model gets wrong about an output lives, where that is a small
/// part of where the output itself lives.
///
/// Powers are Welch's, of pieces an eighth of the record long or less; noise is taken off line
/// by line: the spectrum of what the extended model leaves where that does not depend on the
/// inputs, else the noise floor at all lines alike. The narrowest band with 95 % of what is left
/// of the error is stated if it is less than half as wide as the narrowest one with 95 % of the
/// output's power (about its mean), or holds less than a tenth of that power, and if either half
/// of the record, on its own, has it at the same place (both ends within half its width).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Regime {
    /// Lower end.
    pub from: f64,
    /// Upper end.
    pub to: f64,
    /// Unit of the two: rad/s.
    pub unit: String,
    /// Share of the error's power above the noise in between.
    pub share: f64,
    /// Whether nothing that counts lies above it: it has no upper end.
    pub to_the_top: bool,
    /// Lower and upper end of where the output itself lives.
    pub output: [f64; 2],
    /// Distance of the lines that the ends were read from.
    pub resolution: f64,
}

impl Context<'_, '_> {
    /// Where each output's error lives, if it keeps to a part of the frequencies. `named` says whether
    /// a cause in the machine is named.
    pub fn regimes(
        &self,
        named: bool,
        floors: &BTreeMap<String, NoiseFloor>,
        before: &[Vec<f64>],
        chosen: &Finished,
    ) -> BTreeMap<String, Regime> {
        let is_noise = named && chosen.dependence <= DEPENDS;
        let outputs = self.problem.base.signals.outputs.iter().enumerate();
        let found = outputs.filter_map(|(o, signal)| {
            let floor = floors.get(&signal.name).map_or(0.0, |floor| floor.std);
            let size = self.length()?;
            let of = |values: &dyn Fn(usize) -> f64| self.pieces(o, size, values);
            let (y, b, a) = (&self.problem.y[o], &before[o], &chosen.y[o]);
            let output = of(&|k| y[k]);
            let error = of(&|k| y[k] - b[k]);
            let noise = if is_noise { of(&|k| y[k] - a[k]) } else { white(&error, floor) };
            let line = std::f64::consts::TAU / (size as f64 * self.problem.base.sampling_time);
            Some((signal.name.clone(), Found::of(&output, &error, &noise)?.regime(line)))
        });
        found.collect()
    }

    /// Samples of a piece: a power of two, so that there are enough pieces.
    fn length(&self) -> Option<usize> {
        let counted: usize =
            self.problem.stretches(Part::All).iter().map(ExactSizeIterator::len).sum();
        let most = (2 * counted / PIECES).clamp(1, LONGEST);
        let size = (most / 2 + 1).next_power_of_two();
        (size >= 64).then_some(size)
    }

    /// Powers of all pieces of a series, nothing where it does not count.
    fn pieces(&self, o: usize, size: usize, values: &dyn Fn(usize) -> f64) -> Vec<Vec<f64>> {
        let weight = &self.problem.weight[o];
        let value = |k: usize| if weight[k] > 0.0 { values(k) } else { 0.0 };
        let of = |stretch: Range<usize>| pieces(&stretch.map(value).collect::<Vec<_>>(), size);
        self.problem.stretches(Part::All).into_iter().flat_map(of).collect()
    }
}

/// Powers of white noise of a size, like these.
fn white(like: &[Vec<f64>], std: f64) -> Vec<Vec<f64>> {
    like.iter().map(|piece| vec![std * std; piece.len()]).collect()
}

/// Bands of lines.
struct Found {
    error: Range<usize>,
    output: Range<usize>,
    lines: usize,
}

impl Found {
    fn of(output: &[Vec<f64>], error: &[Vec<f64>], noise: &[Vec<f64>]) -> Option<Self> {
        let half = error.len() / 2;
        if half < PIECES / 4 {
            return None;
        }
        let excess = |pieces: Range<usize>| -> Vec<f64> {
            let sum = |all: &[Vec<f64>], k: usize| -> f64 {
                all[pieces.clone()].iter().map(|piece| piece[k]).sum()
            };
            (0..error[0].len()).map(|k| sum(error, k) - sum(noise, k)).collect()
        };
        let all = excess(0..error.len());
        let of_noise: f64 = noise.iter().flatten().sum();
        let sum = |piece: &Vec<f64>| piece.iter().sum::<f64>();
        let each: Vec<f64> = error.iter().zip(noise).map(|(e, n)| sum(e) - sum(n)).collect();
        let chance = CHANCE * (each.len() as f64).sqrt() * spread(&each);
        if all.iter().sum::<f64>() <= chance.max(ABOVE * of_noise) {
            return None;
        }
        let own: Vec<f64> =
            (0..all.len()).map(|k| output.iter().map(|piece| piece[k]).sum()).collect();
        let (error_band, output_band) = (narrowest(&all)?, narrowest(&own)?);
        let inside: f64 = own[error_band.clone()].iter().sum::<f64>() / own.iter().sum::<f64>();
        let narrow = (error_band.len() as f64) < NARROW * output_band.len() as f64;
        if output_band.len() < ENOUGH || !(narrow || inside < ASIDE) {
            return None;
        }
        let near = |a: usize, b: usize| a.abs_diff(b) <= 2.max(error_band.len() / 2);
        let stays = |pieces: Range<usize>| {
            narrowest(&excess(pieces))
                .is_some_and(|b| near(b.start, error_band.start) && near(b.end, error_band.end))
        };
        let stable = stays(0..half) && stays(half..error.len());
        stable.then_some(Self { error: error_band, output: output_band, lines: all.len() })
    }
}

impl Found {
    /// The same in rad/s, `line` apart.
    fn regime(&self, line: f64) -> Regime {
        let (from, to) = (self.error.start, self.error.end);
        let output = &self.output;
        Regime {
            from: if from <= 1 { 0.0 } else { (from as f64 - 0.5) * line },
            to: (to as f64 - 0.5) * line,
            unit: "rad/s".into(),
            share: SHARE,
            to_the_top: to >= self.lines - 1 || to >= output.end && from < output.end,
            output: [(output.start as f64 - 0.5).max(0.0) * line, (output.end as f64 - 0.5) * line],
            resolution: line,
        }
    }
}

/// The fewest lines in a row with 95 % of a power, some lines of which may be below 0; of
/// several, those with most.
fn narrowest(power: &[f64]) -> Option<Range<usize>> {
    let mut sums = vec![0.0];
    for p in power {
        sums.push(sums[sums.len() - 1] + p);
    }
    let total = sums[power.len()];
    if !(total > 0.0) {
        return None;
    }
    (1..=power.len()).find_map(|width| {
        let held = |from: usize| sums[from + width] - sums[from];
        let best = (0..=power.len() - width).max_by(|&a, &b| held(a).total_cmp(&held(b)))?;
        (held(best) >= SHARE * total).then(|| best..best + width)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::noise;

    /// Noise that a resonance at a share of the sampling rate shapes.
    fn coloured(n: usize, at: f64, seed: u64) -> Vec<f64> {
        let (mut a, mut b) = (0.0, 0.0);
        let turn = 2.0 * 0.98 * (std::f64::consts::TAU * at).cos();
        let white = noise::white(n, 1.0, seed).unwrap();
        let next = |e: f64| {
            let x = turn * a - 0.9604 * b + e;
            (a, b) = (x, a);
            x
        };
        white.into_iter().map(next).collect()
    }

    fn bands(error: &[f64], y: &[f64], noise: &[f64]) -> Option<(Range<usize>, Range<usize>)> {
        let off: Vec<f64> = error.iter().zip(noise).map(|(a, b)| a + b).collect();
        let found = Found::of(&pieces(y, 256), &pieces(&off, 256), &pieces(noise, 256))?;
        Some((found.error, found.output))
    }

    #[test]
    fn an_error_in_a_part_of_the_band_is_placed_and_one_in_all_of_it_is_not() {
        let n = 6000;
        for seed in 1..=20 {
            let y = noise::white(n, 1.0, seed).unwrap();
            let e = noise::ar1(n, 0.9, 0.3, 100 + seed).unwrap();
            let (error, output) = bands(&coloured(n, 0.2, 200 + seed), &y, &e).unwrap();
            // 51.2 is the line of the resonance
            assert!(error.contains(&51) && error.len() < 40 && output.len() > 110, "{error:?}");
            let broad = noise::white(n, 0.5, 300 + seed).unwrap();
            assert_eq!(bands(&broad, &y, &e), None, "{seed}");
        }
    }

    #[test]
    fn an_error_that_moves_within_the_record_has_no_band() {
        let n = 6000;
        for seed in 1..=20 {
            let y = noise::white(n, 1.0, seed).unwrap();
            let (early, late) = (coloured(n, 0.1, 40 + seed), coloured(n, 0.4, 60 + seed));
            let error: Vec<f64> =
                (0..n).map(|k| if k < n / 2 { early[k] } else { late[k] }).collect();
            assert_eq!(bands(&error, &y, &vec![0.0; n]), None);
        }
    }

    #[test]
    fn noise_has_no_band() {
        let n = 6000;
        for seed in 1..=20 {
            let y = noise::white(n, 1.0, seed).unwrap();
            let error = coloured(n, 0.2, 80 + seed);
            let twice = coloured(n, 0.2, 120 + seed);
            let found = Found::of(&pieces(&y, 256), &pieces(&error, 256), &pieces(&twice, 256));
            assert!(found.is_none());
        }
    }

    #[test]
    fn the_narrowest_band() {
        assert_eq!(narrowest(&[0.0, 1.0, 8.0, 9.0, 1.5, -0.5, 0.1]), Some(2..5));
        assert_eq!(narrowest(&[0.0, -1.0]), None);
    }
}
