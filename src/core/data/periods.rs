//! Whether the inputs of a record repeat, which is how noise is told from model error.

use super::record::Record;
use crate::fourier;

/// The period of a record's inputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Periods {
    /// Samples in one period.
    pub samples: usize,
    /// Whole periods in the record.
    pub count: usize,
}

/// Two samples a period apart may differ by this share of the input's rms.
const TOLERANCE: f64 = 1e-9;

impl Record {
    /// The shortest period with which all inputs repeat from the first sample to the
    /// last, at least twice, to 1e-9 of their rms about the mean.
    ///
    /// None where the inputs do not repeat, are all constant (they repeat with any
    /// period and say nothing), or have gaps.
    ///
    /// ```
    /// use lacuna::data::{Periods, Record};
    ///
    /// let u = [1.0, 3.0, 2.0, 1.0, 3.0, 2.0, 1.0];
    /// let record = Record::new(0.1).input("u", u)?;
    /// assert_eq!(record.periods(), Some(Periods { samples: 3, count: 2 }));
    /// # Ok::<(), lacuna::data::DataError>(())
    /// ```
    pub fn periods(&self) -> Option<Periods> {
        let n = self.len();
        let whole = 0..n;
        if self.segments.as_slice() != std::slice::from_ref(&whole) {
            return None;
        }
        // a constant input repeats with any period and does not decide
        let moving: Vec<Moving<'_>> =
            self.inputs.iter().filter_map(|input| Moving::of(&input.values[..n])).collect();
        let (first, others) = moving.split_first()?;
        let candidates = first.candidates();
        let samples = candidates.into_iter().find(|&period| {
            first.repeats(period) && others.iter().all(|input| input.repeats(period))
        })?;
        Some(Periods { samples, count: n / samples })
    }
}

/// An input that is not constant.
struct Moving<'a> {
    values: &'a [f64],
    mean: f64,
    rms: f64,
}

impl<'a> Moving<'a> {
    fn of(values: &'a [f64]) -> Option<Self> {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let rms = (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / n).sqrt();
        (rms > 1e-12 * mean.abs()).then_some(Self { values, mean, rms })
    }

    fn repeats(&self, period: usize) -> bool {
        let tolerance = TOLERANCE * self.rms;
        self.values.iter().zip(&self.values[period..]).all(|(a, b)| (a - b).abs() <= tolerance)
    }

    /// Periods that the mean square of `v[k + P] - v[k]` does not rule out, shortest
    /// first. It comes for all P at once from the autocorrelation; comparing samples for
    /// each P would take time with the square of the length on signals that rarely change.
    fn candidates(&self) -> Vec<usize> {
        let n = self.values.len();
        let length = (2 * n).next_power_of_two();
        let (forward, inverse) = (fourier::forward(length), fourier::inverse(length));
        let mut padded = forward.make_input_vec();
        for (slot, value) in padded.iter_mut().zip(self.values) {
            *slot = (value - self.mean) / self.rms;
        }
        let mut energy = vec![0.0; n + 1];
        for k in 0..n {
            energy[k + 1] = energy[k] + padded[k] * padded[k];
        }
        let mut spectrum = forward.make_output_vec();
        let mut correlation = inverse.make_output_vec();
        let done = forward.process(&mut padded, &mut spectrum).is_ok() && {
            spectrum.iter_mut().for_each(|line| *line *= line.conj());
            inverse.process(&mut spectrum, &mut correlation).is_ok()
        };
        if !done {
            return (1..=n / 2).collect();
        }
        let difference = |period: usize| {
            energy[n - period] + energy[n]
                - energy[period]
                - 2.0 * correlation[period] / length as f64
        };
        // rounding of the transform is some 1e-15 of the total, which is n
        (1..=n / 2).filter(|&period| difference(period) <= 1e-10 * n as f64).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn period(u: Vec<f64>) -> Option<Periods> {
        Record::new(0.1).input("u", u).unwrap().periods()
    }

    fn noise(k: usize) -> f64 {
        (k as f64 * 12.9898).sin() * 43_758.545_3 % 1.0
    }

    #[test]
    fn repeated_noise_has_its_period() {
        let found = period((0..1000).map(|k| noise(k % 237)).collect());
        assert_eq!(found, Some(Periods { samples: 237, count: 4 }));
    }

    #[test]
    fn one_wrong_sample_and_less_than_two_periods_are_none() {
        let mut u: Vec<f64> = (0..1000).map(|k| noise(k % 250)).collect();
        u[700] += 1e-6;
        assert_eq!(period(u), None);
        assert_eq!(period((0..499).map(|k| noise(k % 250)).collect()), None);
    }

    #[test]
    fn constants_gaps_and_nothing_are_none() {
        assert_eq!(period(vec![2.0; 50]), None);
        assert_eq!(period(vec![1.0, 2.0, f64::NAN, 2.0, 1.0, 2.0]), None);
        assert_eq!(period(Vec::new()), None);
        assert_eq!(Record::new(0.1).periods(), None);
    }

    #[test]
    fn all_inputs_have_to_repeat() {
        let u1: Vec<f64> = (0..60).map(|k| noise(k % 10)).collect();
        let u2: Vec<f64> = (0..60).map(|k| noise(k % 15)).collect();
        let constant = vec![4.0; 60];
        let both = Record::new(1.0).input("u1", u1).unwrap().input("u2", u2).unwrap();
        let all = both.input("u3", constant).unwrap();
        assert_eq!(all.periods(), Some(Periods { samples: 30, count: 2 }));
    }

    #[test]
    fn rare_changes_do_not_take_long() {
        let mut u = vec![0.0; 200_000];
        u[123_456] = 1e-3;
        u[199_999] = 1.0;
        assert_eq!(period(u), None);
    }
}
