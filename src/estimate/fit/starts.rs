//! Where a fit starts: from the values given, and from others.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::{Fit, Key};
use crate::evaluate::EvaluateError;
use crate::optimise::Settings;

/// Random starts beside the values given.
const STARTS: usize = 63;
/// Of those, how many are followed.
const FOLLOWED: usize = 5;
/// Samples of each record that starts are judged on.
const FIRST: usize = 4000;
/// Spread of the random starts, as the standard deviation of the logarithm.
const WIDE: f64 = 0.7;

impl Fit<'_> {
    /// The best of the given values and of many random ones, each followed for a while, and
    /// the mean square at the values given.
    pub(super) fn best_start(&self, seed: u64) -> Result<(Vec<f64>, f64), EvaluateError> {
        let given: Vec<f64> = self.unknowns.iter().map(|u| u.start).collect();
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut points = vec![given.clone()];
        for _ in 0..STARTS {
            let point = self.keys.iter().zip(&self.unknowns).map(|(key, u)| {
                // a normal deviate, by the sum of twelve uniform ones
                let normal: f64 = (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0;
                match key {
                    Key::Start(..) => u.start,
                    _ => (u.start * (WIDE * normal).exp()).clamp(u.bounds.0, u.bounds.1),
                }
            });
            points.push(point.collect());
        }
        let mean = |r: &Vec<f64>| r.iter().map(|v| v * v).sum::<f64>() / r.len().max(1) as f64;
        let answers = self.residuals(&points, FIRST);
        let mut order: Vec<(usize, f64)> = answers
            .iter()
            .enumerate()
            .filter_map(|(i, r)| r.as_ref().map(|r| (i, mean(r))))
            .filter(|(_, m)| m.is_finite())
            .collect();
        order.sort_by(|a, b| a.1.total_cmp(&b.1));
        let mut follow: Vec<Vec<f64>> =
            order.iter().take(FOLLOWED).map(|&(i, _)| points[i].clone()).collect();
        if answers[0].is_some() && !order.iter().take(FOLLOWED).any(|&(i, _)| i == 0) {
            follow.push(given.clone());
        }
        let settings = Settings { iterations: 15, tolerance: 1e-4, difference: 1e-4 };
        let mut followed = self.run(&follow, settings, FIRST);
        followed.sort_by(|a, b| a.squares.total_cmp(&b.squares));
        let best = followed.into_iter().find(|f| f.squares.is_finite()).map(|f| f.point);
        let best = best.or_else(|| self.watch.stopped().then(|| given.clone()));
        let best = best.ok_or_else(|| EvaluateError::Diverges {
            record: self.source.clone(),
            sample: 0,
            time: 0.0,
        })?;
        let before = self.residuals(&[given], usize::MAX).swap_remove(0);
        Ok((best, before.map_or(f64::INFINITY, |r| mean(&r))))
    }
}
