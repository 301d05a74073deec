//! Numbers as text, with as many digits as their standard error allows.
//!
//! A value is rounded at the second significant digit of its error (Particle Data Group, Review of
//! Particle Physics, section "Rounding"; GUM 7.2.6): 0.12034 with an error of 0.0031 is 0.1203.

/// A number with as many digits as its uncertainty allows; four significant ones without any.
///
/// ```
/// use lacuna::digits::number;
///
/// assert_eq!(number(0.120_34, Some(0.0031)), "0.1203");
/// assert_eq!(number(9.81, None), "9.810");
/// assert_eq!(number(-0.4, Some(100.0)), "0");
/// ```
pub fn number(value: f64, error: Option<f64>) -> String {
    let digits = decimals(value, error);
    if value != 0.0 && (value.abs() >= 1e6 || value.abs() < 1e-4) {
        let significant = (digits + value.abs().log10().floor() as i32).clamp(0, 8) as usize;
        return format!("{value:.significant$e}");
    }
    fixed(value, digits, error.is_some())
}

/// Decimals that an error allows; so many that four digits are shown where there is none.
fn decimals(value: f64, error: Option<f64>) -> i32 {
    match error {
        Some(e) if e > 0.0 && e.is_finite() => 1 - e.log10().floor() as i32,
        _ if value == 0.0 => 1,
        _ => 3 - value.abs().log10().floor() as i32,
    }
}

/// So many decimals; fewer than none are rounded to tens and hundreds where an error asks for it.
fn fixed(value: f64, decimals: i32, is_rounded: bool) -> String {
    let scale = 10f64.powi(-decimals.min(0));
    let value = if is_rounded && decimals < 0 { (value / scale).round() * scale } else { value };
    let text = format!("{value:.*}", decimals.clamp(0, 12) as usize);
    // what rounds to nothing has no sign
    match text.strip_prefix('-') {
        Some(bare) if bare.bytes().all(|b| matches!(b, b'0' | b'.')) => bare.into(),
        _ => text,
    }
}

/// A number with its unit, four significant digits.
///
/// ```
/// use lacuna::digits::with_unit;
///
/// assert_eq!(with_unit(0.25, "V"), "0.2500 V");
/// assert_eq!(with_unit(0.25, ""), "0.2500");
/// ```
pub fn with_unit(value: f64, unit: &str) -> String {
    number(value, None) + &spaced(unit)
}

/// A unit as it stands behind a number: a blank and the unit, or nothing.
pub fn spaced(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(" {unit}") }
}

/// A value and plus or minus two standard errors (a 95 % interval where the error is normal), with
/// the unit: `0.1200 +- 0.0060 N m`. A value without an error is only about right, and has two digits.
///
/// ```
/// use lacuna::digits::interval;
///
/// assert_eq!(interval(0.12, Some(0.003), "N m"), "0.1200 +- 0.0060 N m");
/// assert_eq!(interval(0.1234, None, "N m"), "about 0.12 N m");
/// ```
pub fn interval(value: f64, std_error: Option<f64>, unit: &str) -> String {
    let unit = spaced(unit);
    match std_error {
        Some(error) if error.is_finite() && error > 0.0 => {
            let two = 2.0 * error;
            let (text, digits) = (number(value, Some(two)), decimals(value, Some(two)));
            // both in one notation, so that they can be compared
            let error = match text.contains('e') || digits > 9 {
                true => number(two, Some(two)),
                false => fixed(two, digits, true),
            };
            format!("{text} +- {error}{unit}")
        }
        Some(_) => format!("{}{unit}", number(value, None)),
        None => format!("about {}{unit}", rough(value)),
    }
}

/// An estimated value with its unit: with a 95 % interval where it has a standard error, else with four
/// significant digits.
///
/// ```
/// use lacuna::digits::estimated;
///
/// assert_eq!(estimated(0.12, Some(0.003), "N m"), "0.1200 +- 0.0060 N m");
/// assert_eq!(estimated(0.12, None, "N m"), "0.1200 N m");
/// ```
pub fn estimated(value: f64, std_error: Option<f64>, unit: &str) -> String {
    match std_error {
        Some(_) => interval(value, std_error, unit),
        None => with_unit(value, unit),
    }
}

/// Two significant digits.
///
/// ```
/// use lacuna::digits::rough;
///
/// assert_eq!(rough(33.31), "33");
/// assert_eq!(rough(0.012_34), "0.012");
/// ```
pub fn rough(value: f64) -> String {
    number(value, Some(value.abs()))
}

/// A share in per cent; what rounds to none or all of it is said with a digit more.
///
/// ```
/// use lacuna::digits::percent;
///
/// assert_eq!(percent(0.984), "98 %");
/// assert_eq!(percent(0.9984), "99.8 %");
/// assert_eq!(percent(0.0), "less than 0.1 %");
/// ```
pub fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    match percent {
        0.0..0.05 => "less than 0.1 %".into(),
        99.95..100.0 => "more than 99.9 %".into(),
        0.05..0.95 | 99.0..99.95 => format!("{percent:.1} %"),
        _ => format!("{percent:.0} %"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_follow_the_error() {
        assert_eq!(interval(-0.12, Some(0.003), "N m"), "-0.1200 +- 0.0060 N m");
        assert_eq!(interval(988.3, Some(4.0), "N m"), "988.3 +- 8.0 N m");
        assert_eq!(interval(181.0, Some(100.0), "N m"), "180 +- 200 N m");
        assert_eq!(interval(0.03, Some(7.5e-6), ""), "0.030000 +- 0.000015");
        assert_eq!(interval(3e-7, Some(1e-8), ""), "3.00e-7 +- 2.0e-8");
        assert_eq!(number(12345.0, None), "12345");
        assert_eq!(number(0.1, None), "0.1000");
        assert_eq!(number(1.234e-7, Some(1e-9)), "1.234e-7");
        assert_eq!(rough(628.4), "630");
        assert_eq!(percent(0.0031), "0.3 %");
        assert_eq!(percent(0.99999), "more than 99.9 %");
        assert_eq!(percent(1.0), "100 %");
    }
}
