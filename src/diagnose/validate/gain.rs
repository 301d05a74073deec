//! The gain of an extended model, with its interval.
//!
//! A measured output is y + e. With what both models simulate of the same record, m = after - before, the
//! baseline's error is b = a + m of the extended model's error a, and m is known: of what is removed, b^2 -
//! a^2 = m^2 + 2 a m, and of what can be, b^2 - e^2, noise is in 2 a m and a^2 only (Fieller, Journal of the
//! Royal Statistical Society B 16, 1954, for the ratio of two means in noise). That another record excites the
//! machine otherwise changes the share by its residuals (1 - s) m^2, which are judged at the share that was
//! found (Cochran, Sampling Techniques, 1977, section 6.4).

use crate::findings::finding::Gain;
use crate::statistics::{block_sums, blocks, spread};
use crate::validate::noise_floor::Floor;
use crate::validate::test_error::{Scored, mean_square, removed};

/// Standard errors that half of a 95 % interval is.
const HALF: f64 = 2.0;

/// A share of two numbers that are both known to an error only.
#[derive(Default)]
struct Share {
    top: f64,
    bottom: f64,
    /// Variances of both by noise, and their covariance.
    of_top: f64,
    of_bottom: f64,
    of_both: f64,
    /// What the record excites adds to the variance of top - s bottom, at the share s that was found.
    of_record: f64,
}

impl Share {
    /// The 95 % interval within 0 and 1: every share s for which top - s bottom may be none. It is
    /// wide where the bottom may be none itself.
    fn interval(&self) -> [f64; 2] {
        // what is known of any share beforehand: the error is in the numbers if they say otherwise
        let t = self.top.max(0.0);
        let (b, wide) = (self.bottom.max(t), HALF * HALF);
        let of_top = self.of_top + self.of_record;
        if t == 0.0 && of_top == 0.0 {
            return [0.0, 0.0];
        }
        // where square s^2 - 2 half s + rest is not positive
        let square = b * b - wide * self.of_bottom;
        let half = t * b - wide * self.of_both;
        let rest = t * t - wide * of_top;
        let root = (half * half - square * rest).max(0.0).sqrt();
        if square > 0.0 {
            return [(half - root) / square, (half + root) / square].map(|s| s.clamp(0.0, 1.0));
        }
        // all of it, or what is above one of two bounds
        let bounds = [(half - root) / square, (half + root) / square];
        let above = bounds.into_iter().filter(|s| *s > 0.0).fold(1.0, f64::min);
        [if rest > 0.0 { above } else { 0.0 }, 1.0]
    }
}

/// The gain with its interval, block by block.
pub(crate) fn gain(before: &Scored, after: &Scored, floors: &[Option<Floor>]) -> Gain {
    let outputs: Vec<usize> =
        (0..before.errors.len()).filter(|&o| !before.errors[o].is_empty()).collect();
    let ratio = |o: usize| mean_square(&after.errors[o]) / mean_square(&before.errors[o]);
    let ratios: Vec<f64> = outputs.iter().map(|&o| ratio(o)).filter(|r| r.is_finite()).collect();
    // where no output has anything to compare, nothing has changed
    let test_rmse_ratio = match ratios.len() {
        0 => 1.0,
        count => (ratios.iter().sum::<f64>() / count as f64).sqrt(),
    };
    let error_removed = removed(before, before, after, floors);
    let mut share = Share::default();
    for &o in &outputs {
        let unit = mean_square(&before.errors[o]);
        let floor = floors[o].map_or(0.0, |f| f.std * f.std).min(unit) / unit;
        let both = before.errors[o].iter().zip(&after.errors[o]);
        let kept: Vec<(f64, f64)> =
            both.map(|(b, a)| (*b, *a)).filter(|(b, a)| b.is_finite() && a.is_finite()).collect();
        let n = kept.len().max(1) as f64;
        // every sample's part of what is removed and of what can be, and what noise does to both
        let parts = kept.iter().map(|&(b, a)| {
            let by_noise = 2.0 * a * (b - a);
            match floors[o].and_then(|floor| floor.excess) {
                // the noise is what the model leaves of the same sample
                Some(excess) => [b * b - a * a, b * b - a * a + excess, by_noise, by_noise],
                None => [b * b - a * a, b * b - floor * unit, by_noise, a * a + by_noise],
            }
        });
        let parts: Vec<[f64; 4]> = parts.map(|each| each.map(|q| q / unit)).collect();
        let series = |of: &dyn Fn(&[f64; 4]) -> f64| -> Vec<f64> { parts.iter().map(of).collect() };
        let found = series(&|q| q[0] - error_removed * q[1]);
        let count = blocks(&found);
        let variance = |q: &[f64]| {
            let sums = block_sums(q, count);
            (spread(&sums) * (sums.len() as f64).sqrt() / n).powi(2)
        };
        let by_noise = |s: f64| variance(&series(&|q| q[2] - s * q[3]));
        let (of_top, of_bottom) = (by_noise(0.0), variance(&series(&|q| q[3])));
        share.top += series(&|q| q[0]).iter().sum::<f64>() / n;
        share.bottom += series(&|q| q[1]).iter().sum::<f64>() / n;
        share.of_top += of_top;
        share.of_bottom += of_bottom + (floors[o].map_or(0.0, |f| f.doubt) * floor).powi(2);
        share.of_both += 0.5 * (of_top + of_bottom - by_noise(1.0));
        share.of_record += variance(&found) - by_noise(error_removed);
    }
    let [low, high] = share.interval();
    Gain {
        test_rmse_ratio,
        error_removed,
        interval95: [low.min(error_removed), high.max(error_removed)],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Random;

    fn share(top: (f64, f64), bottom: (f64, f64)) -> Share {
        let (square, of_both) = (|x: f64| x * x, 0.0);
        let (of_top, of_bottom) = (square(top.1), square(bottom.1));
        Share { top: top.0, bottom: bottom.0, of_top, of_bottom, of_both, of_record: 0.0 }
    }

    #[test]
    fn a_share_of_what_is_well_known_is_known_as_well_as_its_top() {
        let [low, high] = share((0.5, 0.05), (1.0, 1e-6)).interval();
        assert!((low - 0.4).abs() < 1e-6 && (high - 0.6).abs() < 1e-6, "{low} {high}");
        // both errors count: at either bound |0.5 - s| is twice sqrt(0.05^2 + (0.1 s)^2)
        let [low, high] = share((0.5, 0.05), (1.0, 0.1)).interval();
        assert!((low - 0.375).abs() < 1e-9 && (high - 2.0 / 3.0).abs() < 1e-9, "{low} {high}");
    }

    #[test]
    fn a_share_of_what_may_be_nothing_may_be_any() {
        assert_eq!(share((0.1, 0.1), (0.1, 0.2)).interval(), [0.0, 1.0]);
        assert_eq!(share((0.0, 0.1), (0.0, 0.0)).interval(), [0.0, 1.0]);
        // what was removed for sure is not none of it
        let [low, high] = share((0.3, 0.05), (0.1, 0.2)).interval();
        let left = (0.3 - 0.3 * low).abs() - 2.0 * 0.05f64.hypot(0.2 * low);
        assert!(low > 0.0 && left.abs() < 1e-9 && high == 1.0, "{low} {high}");
        // more than all is all and less than none is none, each to its error
        let [low, high] = share((0.5, 0.05), (0.4, 0.02)).interval();
        assert!((0.75..0.85).contains(&low) && high == 1.0, "{low} {high}");
        let [low, high] = share((-0.3, 0.05), (1.0, 0.02)).interval();
        assert!(low == 0.0 && (0.09..0.11).contains(&high), "{low} {high}");
        // nothing changed, nothing is gained
        assert_eq!(share((0.0, 0.0), (0.0, 0.0)).interval(), [0.0, 0.0]);
    }

    /// The gain of a model that leaves `kept` of what the baseline leaves, `missing`, both in white noise.
    fn of(missing: &[f64], kept: f64, random: &mut Random) -> Gain {
        let noise: Vec<f64> = missing.iter().map(|_| 0.1 * random.normal()).collect();
        let errors = |part: f64| missing.iter().zip(&noise).map(|(m, e)| part * m + e).collect();
        let scored = |part| Scored { errors: vec![errors(part)], ..Scored::default() };
        let floor = Floor { std: 0.1, method: "known", doubt: 0.0, excess: None };
        gain(&scored(1.0), &scored(kept), &[Some(floor)])
    }

    #[test]
    fn what_is_missing_in_one_of_sixteen_blocks_is_no_less_surely_gained() {
        let mut random = Random::new(1);
        let missing: Vec<f64> =
            (0..1600).map(|k| if k / 100 == 7 { (k as f64).sin() } else { 0.0 }).collect();
        let gain = of(&missing, 0.0, &mut random);
        let [low, high] = gain.interval95;
        assert!(low > 0.8 && high == 1.0, "{gain:?}");
    }

    #[test]
    fn nineteen_of_twenty_intervals_hold_the_share_that_another_record_gives() {
        let mut random = Random::new(2);
        let mut missing = || {
            let mut state = 0.0;
            let mut next = |_| {
                state = 0.8 * state + 0.2 * random.normal();
                state
            };
            (0..1000).map(&mut next).collect()
        };
        let records: Vec<Vec<f64>> = (0..400).map(|_| missing()).collect();
        for kept in [0.6, 0.3] {
            let holds = records.iter().filter(|missing| {
                let [low, high] = of(missing, kept, &mut random).interval95;
                (low..=high).contains(&(1.0 - kept * kept))
            });
            let holds = holds.count();
            assert!((368..=392).contains(&holds), "{kept}: {holds} of 400");
        }
    }
}
