//! Causes in sentences.

use super::candidate::{Candidate, Wire};
use super::finding::Value;

/// A number with as many digits as its uncertainty deserves.
pub fn number(value: f64, error: Option<f64>) -> String {
    let digits = match error {
        Some(e) if e > 0.0 && e.is_finite() => 1 - e.log10().floor() as i32,
        _ if value == 0.0 => 1,
        _ => 3 - value.abs().log10().floor() as i32,
    };
    if value != 0.0 && (value.abs() >= 1e6 || value.abs() < 1e-4) {
        let significant = (digits + value.abs().log10().floor() as i32).clamp(0, 8) as usize;
        return format!("{value:.significant$e}");
    }
    format!("{value:.*}", digits.clamp(0, 12) as usize)
}

/// A magnitude with its uncertainty (two standard errors) and unit: `0.120 +- 0.006 N m`.
pub(crate) fn magnitude(value: &Value, signed: bool) -> String {
    let size = if signed { value.value } else { value.value.abs() };
    let unit = if value.unit.is_empty() { String::new() } else { format!(" {}", value.unit) };
    match value.std_error {
        Some(error) if error.is_finite() => {
            let two = 2.0 * error;
            format!("{} +- {}{unit}", number(size, Some(two)), number(two, Some(two)))
        }
        _ => format!("{}{unit}", number(size, None)),
    }
}

/// A share in per cent.
pub(crate) fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    match percent {
        0.0..0.05 => "less than 0.1 %".into(),
        0.05..0.95 | 99.0..100.0 => format!("{percent:.1} %"),
        _ => format!("{percent:.0} %"),
    }
}

/// The sentence of a cause.
pub(crate) fn sentence(
    cause: &Candidate,
    values: &[Value],
    removed: f64,
    nominal: Option<f64>,
) -> String {
    let share = format!("explains {} of the removable error", percent(removed));
    let first = values.first();
    let size = first.map_or(String::new(), |v| magnitude(v, false));
    match (&cause.wire, cause.of.as_deref()) {
        (Wire::Parameter(_), _) => {
            let was = nominal.map_or(String::new(), |v| format!(" instead of {}", number(v, None)));
            let value = first.map_or(String::new(), |v| magnitude(v, true));
            format!("Parameter {} is {value}{was}, {share}.", cause.into)
        }
        (Wire::Drift(_), _) => {
            let value = first.map_or(String::new(), |v| magnitude(v, true));
            format!("Parameter {} drifts by {value}, {share}.", cause.into)
        }
        (wire, of) => {
            let title = cause.shape.title(&cause.named);
            let own = matches!(wire, Wire::Path);
            let place = match of {
                Some(of) if !own && !friction(cause) && of != "time" => {
                    format!("{title} of {of} on {}", cause.into)
                }
                _ => format!("{title} on {}", cause.into),
            };
            let also: Vec<&str> = cause.also_into.iter().map(|a| a.channel()).collect();
            let place =
                if also.is_empty() { place } else { format!("{place} and {}", also.join(", ")) };
            let bounds: Vec<String> = values
                .iter()
                .filter(|v| cause.linear.is_empty() && v.value.is_finite())
                .map(|v| format!("{} {}", v.name, magnitude(v, true)))
                .collect();
            let size = if cause.linear.is_empty() { bounds.join(", ") } else { size };
            format!("{place}, {size}, {share}.")
        }
    }
}

/// Whether the title says enough without the coordinate.
fn friction(cause: &Candidate) -> bool {
    matches!(cause.effect, "coulomb_friction" | "stribeck_friction" | "drag")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_follow_the_uncertainty() {
        let value = |value, error| Value {
            name: "level".into(),
            value,
            std_error: Some(error),
            unit: "N m".into(),
        };
        assert_eq!(magnitude(&value(-0.12, 0.003), false), "0.1200 +- 0.0060 N m");
        assert_eq!(magnitude(&value(988.3, 4.0), false), "988.3 +- 8.0 N m");
        assert_eq!(number(0.1, None), "0.1000");
        assert_eq!(percent(0.984), "98 %");
        assert_eq!(percent(0.9984), "99.8 %");
        assert_eq!(percent(0.0031), "0.3 %");
        assert_eq!(percent(0.0), "less than 0.1 %");
    }
}
