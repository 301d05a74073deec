//! A share of cases, with Wilson's 95 % interval (Brown, Cai and DasGupta, Statistical Science 16, 2001).

use serde::Serialize;

/// A share with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Share {
    /// How often it could have been.
    pub of: usize,
    /// How often it was.
    pub count: usize,
    /// The share; `None` of nothing.
    pub share: Option<f64>,
    /// Wilson's 95 % interval.
    pub interval95: [f64; 2],
}

impl Share {
    /// Of what was, and was not.
    pub fn of(all: impl IntoIterator<Item = bool>) -> Self {
        let (mut of, mut count) = (0, 0);
        for yes in all {
            (of, count) = (of + 1, count + usize::from(yes));
        }
        let (n, z) = (of as f64, 1.959_963_984_540_054_f64);
        let p = count as f64 / n.max(1.0);
        let whole = 1.0 + z * z / n.max(1.0);
        let middle = (p + z * z / (2.0 * n.max(1.0))) / whole;
        let half =
            z / whole * (p * (1.0 - p) / n.max(1.0) + (z / (2.0 * n.max(1.0))).powi(2)).sqrt();
        let interval95 = match of {
            0 => [0.0, 1.0],
            _ => {
                let low = if count == 0 { 0.0 } else { middle - half };
                [low, if count == of { 1.0 } else { middle + half }]
            }
        };
        Self { of, count, share: (of > 0).then_some(p), interval95 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_have_intervals_that_hold_them() {
        let none = Share::of([]);
        assert_eq!((none.share, none.interval95), (None, [0.0, 1.0]));
        // Wilson's interval of 0 in 60: 0 to z^2 / (n + z^2)
        let clean = Share::of((0..60).map(|_| false));
        assert!(clean.interval95[0] == 0.0 && (clean.interval95[1] - 0.0602).abs() < 1e-3);
    }
}
