//! Random numbers that depend on a seed and on nothing else.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::f64::consts::TAU;

/// A sequence of random numbers; the same seed gives the same sequence.
///
/// ```
/// use lacuna::data::Random;
///
/// let (mut one, mut two) = (Random::new(7), Random::new(7));
/// assert_eq!(one.normal(), two.normal());
/// assert_ne!(Random::new(8).normal(), one.normal());
/// ```
#[derive(Debug, Clone)]
pub struct Random {
    bits: ChaCha8Rng,
    /// Normal numbers come in pairs; this is the second.
    spare: Option<f64>,
}

impl Random {
    /// The sequence of a seed.
    pub fn new(seed: u64) -> Self {
        Self { bits: ChaCha8Rng::seed_from_u64(seed), spare: None }
    }

    /// Uniform from 0 (included) to 1 (not included).
    pub fn uniform(&mut self) -> f64 {
        // the upper 53 bits are what a number of 64 bits can hold
        (self.bits.next_u64() >> 11) as f64 * 2.0_f64.powi(-53)
    }

    /// Standard normal, by the transform of Box and Muller.
    pub fn normal(&mut self) -> f64 {
        if let Some(second) = self.spare.take() {
            return second;
        }
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        let (sin, cos) = (TAU * self.uniform()).sin_cos();
        self.spare = Some(radius * sin);
        radius * cos
    }

    /// A whole number below `bound`, each equally likely; 0 for a bound of 0.
    pub fn below(&mut self, bound: u64) -> u64 {
        if bound == 0 {
            return 0;
        }
        // draws from an incomplete last round would prefer the small numbers
        let usable = u64::MAX - u64::MAX % bound;
        loop {
            let draw = self.bits.next_u64();
            if draw < usable {
                return draw % bound;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_numbers_have_the_moments_of_the_normal() {
        let mut random = Random::new(0);
        let draws: Vec<f64> = (0..200_000).map(|_| random.normal()).collect();
        let moment = |power: i32| draws.iter().map(|x| x.powi(power)).sum::<f64>() / 2e5;
        assert!(moment(1).abs() < 0.01);
        assert!((moment(2) - 1.0).abs() < 0.02);
        assert!(moment(3).abs() < 0.04);
        assert!((moment(4) - 3.0).abs() < 0.1);
    }

    #[test]
    fn whole_numbers_are_equally_likely() {
        let mut random = Random::new(1);
        let mut counts = [0; 6];
        (0..60_000).for_each(|_| counts[random.below(6) as usize] += 1);
        assert!(counts.iter().all(|count| (9_600..10_400).contains(count)), "{counts:?}");
        assert_eq!(random.below(0), 0);
    }
}
