//! Levels held for a while: what an operator does.

use super::{positive, samples};
use crate::data::error::DataError;
use crate::data::random::Random;
use serde::{Deserialize, Serialize};

/// Random levels, each held for a random while.
///
/// ```
/// use lacuna::data::Steps;
///
/// let steps = Steps { low: 0.0, high: 5.0, hold_min: 20, hold_max: 100 };
/// let u = steps.generate(1000, 0.1, 0)?;
/// assert!(u.iter().all(|u| (0.0..=5.0).contains(u)));
/// assert_eq!(u[0], u[19]);
/// # Ok::<(), lacuna::data::DataError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Steps {
    /// Lowest level, in the signal's unit.
    pub low: f64,
    /// Highest level; levels are uniform between the two.
    pub high: f64,
    /// Fewest samples that a level is held, at least 1.
    pub hold_min: usize,
    /// Most samples that a level is held; all from `hold_min` on are equally likely.
    pub hold_max: usize,
}

impl Steps {
    /// The first `n` samples.
    ///
    /// # Errors
    ///
    /// A setting outside its range, by its name.
    pub fn generate(&self, n: usize, sampling_time: f64, seed: u64) -> Result<Vec<f64>, DataError> {
        samples("samples", n)?;
        positive("sampling_time", sampling_time)?;
        for (key, level) in [("low", self.low), ("high", self.high)] {
            if !level.is_finite() {
                return Err(DataError::setting(key, level, "a finite number"));
            }
        }
        if self.low > self.high || !(self.high - self.low).is_finite() {
            return Err(DataError::setting("high", self.high, "at least `low`"));
        }
        if self.hold_min == 0 {
            return Err(DataError::setting("hold_min", 0.0, "at least 1 sample"));
        }
        if samples("hold_max", self.hold_max)? < self.hold_min {
            return Err(DataError::setting(
                "hold_max",
                self.hold_max as f64,
                "at least `hold_min`",
            ));
        }
        let mut random = Random::new(seed);
        let holds = (self.hold_max - self.hold_min + 1) as u64;
        let mut signal = Vec::with_capacity(n);
        while signal.len() < n {
            let level = self.low + (self.high - self.low) * random.uniform();
            let hold = self.hold_min + random.below(holds) as usize;
            signal.resize(n.min(signal.len() + hold), level);
        }
        Ok(signal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_and_holds_keep_their_ranges() {
        let steps = Steps { low: -2.0, high: 4.0, hold_min: 3, hold_max: 7 };
        let u = steps.generate(50_000, 0.1, 1).unwrap();
        let runs: Vec<_> = u.chunk_by(|a, b| a == b).collect();
        // the last one may be cut
        assert!(runs[..runs.len() - 1].iter().all(|run| (3..=7).contains(&run.len())));
        for length in 3..=7 {
            let share = runs.iter().filter(|run| run.len() == length).count() as f64;
            assert!((share / runs.len() as f64 - 0.2).abs() < 0.02);
        }
        let mean = runs.iter().map(|run| run[0]).sum::<f64>() / runs.len() as f64;
        assert!((mean - 1.0).abs() < 0.1 && u.iter().all(|u| (-2.0..=4.0).contains(u)));
    }

    #[test]
    fn settings_are_validated() {
        let good = Steps { low: 0.0, high: 1.0, hold_min: 1, hold_max: 2 };
        for bad in [
            Steps { low: 2.0, ..good.clone() },
            Steps { low: f64::NAN, ..good.clone() },
            Steps { high: f64::INFINITY, ..good.clone() },
            Steps { low: -f64::MAX, high: f64::MAX, ..good.clone() },
            Steps { hold_min: 0, ..good.clone() },
            Steps { hold_min: 3, ..good.clone() },
            Steps { hold_max: usize::MAX, ..good.clone() },
        ] {
            assert!(bad.generate(9, 0.1, 0).is_err(), "{bad:?}");
        }
        assert!(good.generate(0, 0.1, 0).unwrap().is_empty());
    }
}
