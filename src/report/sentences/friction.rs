//! What a record tells of friction, and what it cannot tell.

use crate::diagnose::Value;
use crate::digits::{interval, rough, spaced};

/// How sharp the step at rest is, at most.
pub(super) fn width_unresolved(into: &str, at_most: f64, unit: &str) -> String {
    let width = rough(at_most) + &spaced(unit);
    format!(
        "The record does not resolve how sharp the step at zero on {into} is: its width is at most about {width}."
    )
}

/// Why friction may be an offset.
pub(super) fn keeps_its_sign(into: &str, of: Option<&str>) -> String {
    format!(
        "{} keeps its sign: while it moves, dry friction on {into} looks like an offset; only rest, \
         starts and stops tell them apart.",
        of.unwrap_or("The velocity")
    )
}

/// Friction and a constant as one law; `forward` and `backward` are its two sides.
pub(super) fn by_direction(
    into: &str,
    of: Option<&str>,
    [forward, backward]: [&Value; 2],
) -> String {
    let of = of.unwrap_or("the velocity");
    let size = |side: &Value| interval(side.value, side.std_error, &side.unit);
    format!(
        "Dry friction with a constant offset on {into} is the same as friction that differs by direction: {} where \
         {of} is positive, {} where it is negative (a seal, a worm gear). No record tells one from the other; a slope \
         or a weight would be an offset without friction, too.",
        size(forward),
        size(backward)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_sides_have_a_size_and_an_error() {
        let side =
            |value| Value { name: String::new(), value, std_error: Some(2.0), unit: "N".into() };
        let said = by_direction("rod", Some("speed"), [&side(1050.0), &side(520.0)]);
        assert!(said.contains("1050.0 +- 4.0 N where speed is positive, 520.0 +- 4.0 N"), "{said}");
    }
}
