//! From which size on a cause shows.

use super::SHOWS;
use super::look::{Asked, Left};
use super::outlook::{Supposed, Visibility};
use crate::candidates::candidate::{Candidate, Preference, Wire};
use crate::effect::Mechanism;

pub(super) fn supposed(cause: &Candidate) -> Supposed {
    let (effect, into, of) = cause.name();
    Supposed { effect, into, of }
}

/// The first parameter's size at which an effect is as large as what drives its place anyway.
pub(crate) fn natural(cause: &Candidate) -> f64 {
    match (&cause.wire, cause.place) {
        _ if cause.blended() => 1.0,
        (Wire::Parameter(_) | Wire::Drift(_), _) => 100.0 * cause.probe.abs(),
        (_, Preference::Balance | Preference::Input | Preference::Output) => {
            100.0 * cause.probe.abs()
        }
        _ => 1000.0 * cause.probe.abs(),
    }
}

/// Whether an effect shows at its natural size.
pub(super) fn shows(cause: &Candidate, left: &Left, i: usize) -> bool {
    left.after[i] * natural(cause) >= SHOWS
}

pub(super) fn visibility(
    asked: &Asked,
    visible: bool,
    held: &Left,
    moved: &Left,
    i: usize,
    is_free: bool,
) -> Visibility {
    let cause = &asked.cause;
    let first = cause.linear.first().or(cause.refine.first()).copied();
    // a share of a short delay is a shorter one
    let by = match cause.card.mechanism {
        _ if !cause.blended() => Some(1.0),
        Mechanism::Delay | Mechanism::Lag => first.map(|k| asked.parameters[k]),
        _ => None,
    };
    let smallest = |left: &Left| {
        let size = by? * SHOWS / left.after[i];
        (left.after[i] > 0.0 && size.is_finite()).then_some(size)
    };
    let (of_into, of_of) = (&cause.units.0, &cause.units.1);
    let shapes = cause.refine.iter().filter(|&&k| asked.parameters[k].is_finite());
    Visibility {
        cause: supposed(cause),
        same_as: cause.twins.iter().map(|(into, ..)| into.clone()).collect(),
        shape: shapes
            .map(|&k| (cause.card.parameters[k].name.to_string(), asked.parameters[k]))
            .collect(),
        visible,
        smallest_visible: smallest(held),
        smallest_visible_free: smallest(moved).filter(|_| !is_free),
        unit: match (&cause.wire, first) {
            (Wire::Parameter(_), _) => of_into.clone(),
            (Wire::Drift(_), _) => format!("{of_into}/s"),
            (_, Some(k)) => cause.card.parameters[k].unit.text(of_into, of_of),
            _ => String::new(),
        },
        kappa: (!is_free && !matches!(cause.wire, Wire::Parameter(_)) && moved.before[i] > 0.0)
            .then(|| moved.after[i] / moved.before[i]),
    }
}
