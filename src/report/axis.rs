//! Axes: the range of what is drawn, round values within it, and their texts.

use super::figure::Scale;

/// The range of what is drawn along one axis.
pub(super) struct Range {
    scale: Scale,
    low: f64,
    high: f64,
}

impl Range {
    /// Nothing yet.
    pub fn new(scale: Scale) -> Self {
        Self { scale, low: f64::INFINITY, high: f64::NEG_INFINITY }
    }

    /// Takes in a value.
    pub fn add(&mut self, value: f64) {
        if value.is_finite() && (self.scale == Scale::Linear || value > 0.0) {
            self.low = self.low.min(value);
            self.high = self.high.max(value);
        }
    }

    /// The range with a margin on both sides; `None` where nothing was added.
    pub fn widened(&self, margin: f64) -> Option<(f64, f64)> {
        if self.low > self.high {
            return None;
        }
        if self.scale == Scale::Log {
            let ratio = (self.high / self.low).powf(margin).max(1.0 + 2.0 * margin);
            return Some((self.low / ratio, self.high * ratio));
        }
        let size = match self.high - self.low {
            0.0 if self.high == 0.0 => 1.0,
            0.0 => self.high.abs(),
            size => size,
        };
        let margin = if self.high == self.low { 0.5 } else { margin };
        Some((self.low - margin * size, self.high + margin * size))
    }
}

/// Where a value lies: 0 at the low end of the range, 1 at the high one.
pub(super) fn position(v: f64, (low, high): (f64, f64), scale: Scale) -> f64 {
    let share = match scale {
        Scale::Linear => (v - low) / (high - low),
        Scale::Log => (v.max(low) / low).ln() / (high / low).ln(),
    };
    share.clamp(-0.2, 1.2)
}

/// Round values within a range.
pub(super) fn ticks((low, high): (f64, f64), scale: Scale, about: usize) -> Vec<f64> {
    if scale == Scale::Log {
        let (first, last) = (low.log10().ceil() as i32, high.log10().floor() as i32);
        let step = ((last - first) / about as i32).max(1) as usize;
        let powers: Vec<f64> = (first..=last).step_by(step).map(|e| 10f64.powi(e)).collect();
        if powers.len() > 2 {
            return powers;
        }
        let decades = (first - 1..=last).map(|e| 10f64.powi(e));
        let all = decades.flat_map(|power| [1.0, 2.0, 5.0].map(|m| m * power));
        return all.filter(|tick| (low..=high).contains(tick)).collect();
    }
    let raw = (high - low) / about as f64;
    let power = 10f64.powf(raw.log10().floor());
    let step =
        [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * power).find(|s| *s >= raw).unwrap_or(raw);
    let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
    (first..=last).map(|k| k as f64 * step).collect()
}

/// A tick's text.
pub(super) fn label(v: f64, (low, high): (f64, f64), scale: Scale) -> String {
    // even steps share their digits with the largest, even ratios each have their own
    let size = if scale == Scale::Log { v.abs() } else { low.abs().max(high.abs()) };
    if v == 0.0 {
        return "0".into();
    }
    if !(1e-3..1e5).contains(&size) {
        let text = format!("{v:.2e}");
        // 2.00e-4 is 2e-4
        let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
        let digits = digits.trim_end_matches('0').trim_end_matches('.');
        return format!("{digits}e{power}").replace('-', "\u{2212}");
    }
    let text = format!("{v:.6}");
    text.trim_end_matches('0').trim_end_matches('.').replace('-', "\u{2212}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_of_few_powers_of_ten_is_marked_between_them() {
        let about = |range| ticks(range, Scale::Log, 5);
        assert_eq!(about((0.025, 0.3)), [0.05, 0.1, 0.2]);
        assert_eq!(about((0.5, 2e3)), [1.0, 10.0, 100.0, 1000.0]);
    }
}
