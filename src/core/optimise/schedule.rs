//! How a step size changes from step to step.

use serde::{Deserialize, Serialize};

use super::OptimiseError;
use super::stop::{not_negative, positive};

/// Factor on the rate at every step.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Schedule {
    /// 1 throughout.
    #[default]
    Constant,
    /// Times `factor` every `every` steps, smoothly.
    Exponential {
        /// Factor, positive.
        factor: f64,
        /// Steps, positive.
        every: f64,
    },
    /// Half a cosine from 1 down to `last` over `steps`, then `last`
    /// (Loshchilov and Hutter, SGDR, ICLR 2017).
    Cosine {
        /// Steps, positive.
        steps: f64,
        /// Factor at the end.
        #[serde(default)]
        last: f64,
    },
    /// A straight line from 0 up to 1 over `warm_up` steps, then a cosine as above.
    WarmUp {
        /// Steps of the rise, positive.
        warm_up: f64,
        /// Steps of the fall, positive.
        steps: f64,
        /// Factor at the end.
        #[serde(default)]
        last: f64,
    },
}

impl Schedule {
    /// Factor at a step, 1 being the first.
    ///
    /// ```
    /// use lacuna::optimise::Schedule;
    ///
    /// let half_every_ten = Schedule::Exponential { factor: 0.5, every: 10.0 };
    /// assert_eq!(half_every_ten.factor(1), 1.0);
    /// assert!((half_every_ten.factor(21) - 0.25).abs() < 1e-15);
    /// ```
    pub fn factor(&self, step: u64) -> f64 {
        let done = step.saturating_sub(1) as f64;
        let cosine = |share: f64, last: f64| {
            let height = 0.5 * (1.0 + (std::f64::consts::PI * share.clamp(0.0, 1.0)).cos());
            last + (1.0 - last) * height
        };
        match *self {
            Self::Constant => 1.0,
            Self::Exponential { factor, every } => factor.powf(done / every),
            Self::Cosine { steps, last } => cosine(done / steps, last),
            Self::WarmUp { warm_up, .. } if done < warm_up => (done + 1.0) / (warm_up + 1.0),
            Self::WarmUp { warm_up, steps, last } => cosine((done - warm_up) / steps, last),
        }
    }

    pub fn check(&self) -> Result<(), OptimiseError> {
        match *self {
            Self::Constant => Ok(()),
            Self::Exponential { factor, every } => {
                positive("schedule.factor", factor)?;
                positive("schedule.every", every)
            }
            Self::Cosine { steps, last } => {
                positive("schedule.steps", steps)?;
                not_negative("schedule.last", last)
            }
            Self::WarmUp { warm_up, steps, last } => {
                positive("schedule.warm_up", warm_up)?;
                positive("schedule.steps", steps)?;
                not_negative("schedule.last", last)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn schedules_start_and_end_where_they_say() {
        let cosine = Schedule::Cosine { steps: 100.0, last: 0.1 };
        assert_eq!(cosine.factor(1), 1.0);
        assert!((cosine.factor(51) - 0.55).abs() < 1e-12);
        assert!((cosine.factor(1000) - 0.1).abs() < 1e-12);
        let warm = Schedule::WarmUp { warm_up: 4.0, steps: 10.0, last: 0.0 };
        let rising: Vec<f64> = (1..=5).map(|k| warm.factor(k)).collect();
        assert!((0..5).all(|i| (rising[i] - 0.2 * (i as f64 + 1.0)).abs() < 1e-12), "{rising:?}");
        assert!(warm.factor(15).abs() < 1e-12);
        assert!(Schedule::Exponential { factor: 0.0, every: 1.0 }.check().is_err());
    }
}
