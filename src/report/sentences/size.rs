//! Sizes that are no plain coefficient: waves, factors, shapes without a name, and sizes that are told
//! from none by no record.

use super::stated::{HALF, amplitude, headline_value};
use crate::diagnose::{Cause, FoundShape, Site, Value};
use crate::digits::{interval, number, percent, rough, spaced};
use crate::effect::Size;

/// Names that a factor may go by, and the factor.
const FACTORS: [(&str, f64); 6] = [
    ("degrees written in the place of radians", 180.0 / std::f64::consts::PI),
    ("radians written in the place of degrees", std::f64::consts::PI / 180.0),
    ("revolutions written in the place of radians", 0.5 / std::f64::consts::PI),
    ("radians written in the place of revolutions", std::f64::consts::TAU),
    ("thousandths of the unit", 1000.0),
    ("thousands of the unit", 1e-3),
];
/// Relative difference at which a factor is one of these.
const NEAR_FACTOR: f64 = 0.01;
/// Probability from which on it is sure that something is there.
const SURE: f64 = 0.95;

/// a sin(n z) + b cos(n z) by amplitude, order and phase.
pub(super) fn wave(cause: &Cause, order: &str, sine: &str, cosine: &str) -> String {
    let find = |name: &str| cause.parameters.iter().find(|v| v.name == name);
    let Some(((size, error), n)) = amplitude(cause, sine, cosine).zip(find(order)) else {
        return String::new();
    };
    let unit = find(sine).map_or("", |v| &v.unit);
    let (a, b) = (find(sine).map_or(0.0, |v| v.value), find(cosine).map_or(0.0, |v| v.value));
    let phase = b.atan2(a);
    let z = cause.of.as_deref().unwrap_or("z");
    let counted = origin(cause)
        .map_or_else(|| z.into(), |from| format!("({z} - {})", number(from.value, None)));
    let said = |value: f64, error: Option<f64>| interval(value, error, "");
    let often = if z == "time" {
        let turn = std::f64::consts::TAU;
        format!("{} Hz", said(n.value / turn, n.std_error.map(|e| e / turn)))
    } else {
        let once = (n.value - 1.0).abs() < NEAR_FACTOR.max(n.std_error.map_or(0.0, |e| HALF * e));
        let weight = if once {
            ", as the weight of an arm is: look at what the model says of it"
        } else {
            ""
        };
        format!("{} periods per turn{weight}", said(n.value, n.std_error))
    };
    let phase_error = error.filter(|_| size > 0.0).map(|e| HALF * e / size);
    format!(
        ", amplitude {}, {often}: {} sin({} {counted} {} {})",
        interval(size, error, unit),
        number(size, error.map(|e| HALF * e)),
        number(n.value, n.std_error.map(|e| HALF * e)),
        if phase < 0.0 { "-" } else { "+" },
        number(phase.abs(), phase_error),
    )
}

/// 1 + g as a factor, and what to do.
pub(super) fn factor(cause: &Cause, name: &str) -> String {
    let Some(v) = cause.parameters.iter().find(|v| v.name == name) else { return String::new() };
    let factor = 1.0 + v.value;
    let text = interval(factor, v.std_error, "");
    let unit = FACTORS.iter().find(|(_, known)| (factor / known - 1.0).abs() < NEAR_FACTOR);
    let unit = unit.map_or_else(String::new, |(name, _)| format!(" (as if by {name})"));
    let what = match cause.wording.site {
        Site::Output => format!("it reads so many times the true value{unit}, divide by it"),
        Site::Input => format!("what acts is so many times what is recorded{unit}"),
        _ => return format!(", factor {text}{unit}"),
    };
    format!(", factor {text}: {what}")
}

/// Value from which a cause counts its coordinate, where that is not 0.
pub(super) fn origin(cause: &Cause) -> Option<&Value> {
    let name = cause.wording.origin.as_ref()?;
    cause.parameters.iter().find(|v| v.name == *name)
}

/// A size whose interval holds 0: by itself, or because other numbers of the same place change what it
/// changes, while something there is sure.
pub(super) fn unresolved(cause: &Cause) -> String {
    let stated = match cause.wording.size {
        Size::Wave { sine, cosine, .. } => {
            let unit = cause.parameters.iter().find(|v| v.name == sine);
            let unit = unit.map_or(String::new(), |v| v.unit.clone());
            amplitude(cause, sine, cosine).map(|(value, error)| interval(value, error, &unit))
        }
        _ => headline_value(cause).map(|v| interval(v.value, v.std_error, &v.unit)),
    };
    let stated = stated.unwrap_or_default();
    let numbers = cause.parameters.iter().filter(|v| v.std_error.is_some()).count();
    if (numbers > 1 || cause.parts.len() > 1) && cause.probability.is_some_and(|p| p > SURE) {
        return format!(", which its other numbers can make up for ({stated})");
    }
    format!(", of a size that this record does not tell from none ({stated})")
}

pub(super) fn found_shape(shape: &FoundShape, unit: &str) -> String {
    match shape {
        FoundShape::Curve { most, nearest } => {
            let alike = match nearest {
                Some((name, share)) => {
                    format!("`{name}` is most like it ({} of it)", percent(*share))
                }
                None => "no shape of the library is like it".into(),
            };
            format!(", up to {}{}; {alike}", rough(*most), spaced(unit))
        }
        FoundShape::Learned { most, formula: (terms, share) } => {
            let alike = match &terms[..] {
                [] => "no formula of one or two terms is like it".into(),
                terms => format!("it resembles {} ({} of it)", formula(terms), percent(*share)),
            };
            format!(", up to {}{}; {alike}", rough(*most), spaced(unit))
        }
    }
}

/// A sum of terms as text: `0.5000 z^2 - 1.200 sin(z)`.
pub fn formula(terms: &[(f64, String)]) -> String {
    let mut text = String::new();
    for (coefficient, term) in terms {
        text += match (text.is_empty(), *coefficient < 0.0) {
            (true, true) => "-",
            (true, false) => "",
            (false, true) => " - ",
            (false, false) => " + ",
        };
        text += &number(coefficient.abs(), None);
        if !term.is_empty() {
            text += &format!(" {term}");
        }
    }
    text
}

/// `, 0.31 +- 0.02 N and 0.120 +- 0.004 of load`.
pub(super) fn growing(cause: &Cause, unloaded: &str, by: &str) -> String {
    let find = |name: &str| cause.parameters.iter().find(|v| v.name == name);
    let (Some(unloaded), Some(by)) = (find(unloaded), find(by)) else { return String::new() };
    let magnitude = |v: &Value| interval(v.value.abs(), v.std_error, &v.unit);
    let load = cause.also_of.first().map_or("the load", String::as_str);
    format!(", {} and {} of {load}", magnitude(unloaded), magnitude(by))
}

/// The range in which the law is lost: ` lost within 0.0196 +- 0.0005 rad of zero`.
pub(super) fn gap(cause: &Cause) -> String {
    let own = cause.parameters.iter().find(|v| cause.wording.gap.as_ref() == Some(&v.name));
    own.map_or_else(String::new, |v| {
        format!(" lost within {} of zero", interval(v.value, v.std_error, &v.unit))
    })
}

#[cfg(test)]
mod tests {
    use crate::diagnose::{Cause, Value};
    use crate::sentences::cause::is_resolved;

    #[test]
    fn half_of_a_signal_is_missing_where_its_limit_is_0() {
        let (name, unit) = ("low".into(), "V".into());
        let low = Value { name, value: 2e-4, std_error: Some(3e-4), unit };
        let mut cause = Cause { parameters: vec![low], ..Cause::default() };
        assert!(!is_resolved(&cause));
        cause.wording.is_limit = true;
        assert!(is_resolved(&cause));
    }
}
