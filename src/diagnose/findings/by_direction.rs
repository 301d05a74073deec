//! Friction and a constant of one channel: friction that differs by direction.
//!
//! ```text
//! c sign(v) + b   =   c + b  where v > 0,   b - c  where v < 0,   anything between them at rest
//! ```
//!
//! Both are one law, at rest as well: a set-valued friction holds what lies between its two sides. Source:
//! Armstrong-Helouvry, Dupont and Canudas de Wit, Automatica 30, 1994, section 2 (friction that is not symmetric).

use crate::effect::Size;
use crate::findings::cause::{Cause, LawPart, Site, Value};
use crate::findings::note::Note;

/// A note for every channel that has dry friction and a smaller constant among its causes.
pub(super) fn by_direction(causes: &[Cause]) -> Vec<Note> {
    let laws = || {
        let all = causes.iter().filter(|cause| cause.onset.is_none());
        all.flat_map(|cause| cause.parts.iter().map(move |part| (cause, part)))
            .filter(|(_, part)| part.wording.site == Site::Channel)
    };
    let is_dry = |part: &LawPart| {
        part.wording.is_friction && !matches!(part.wording.size, Size::Growing { .. })
    };
    let constant = |into: &str| {
        let mut own = laws().filter(|(c, part)| c.into == into && part.wording.is_constant);
        own.find_map(|(_, part)| first(part))
    };
    let note = |(cause, part): (&Cause, &LawPart)| {
        let (level, offset) = (first(part)?, constant(&cause.into)?);
        let is_friction = level.value.abs() > offset.value.abs();
        let error = level.std_error.zip(offset.std_error).map(|(a, b)| a.hypot(b));
        let sign = level.value.signum();
        let side = |name: &str, force: f64| Value {
            name: name.into(),
            value: sign * force,
            std_error: error,
            unit: level.unit.clone(),
        };
        let forward = side("forward", level.value + offset.value);
        let backward = side("backward", level.value - offset.value);
        is_friction.then(|| Note::ByDirection {
            into: cause.into.clone(),
            of: cause.of.clone(),
            sides: [forward, backward],
        })
    };
    laws().filter(|(_, part)| is_dry(part)).filter_map(note).collect()
}

/// The number by which a law is stated first.
fn first(part: &LawPart) -> Option<&Value> {
    let name = part.wording.first.as_ref()?;
    part.parameters.iter().find(|value| value.name == *name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::cause::Wording;

    fn cause(level: f64, is_friction: bool) -> Cause {
        let wording = Wording {
            first: Some("level".into()),
            is_friction,
            is_constant: !is_friction,
            ..Wording::default()
        };
        let value = Value {
            name: "level".into(),
            value: level,
            std_error: Some(if is_friction { 3.0 } else { 4.0 }),
            unit: "N".into(),
        };
        let parts = vec![LawPart { parameters: vec![value], wording, ..LawPart::default() }];
        let of = is_friction.then(|| "speed".into());
        Cause { into: "rod".into(), of, parts, ..Cause::default() }
    }

    #[test]
    fn friction_with_a_constant_differs_by_direction() {
        let notes = by_direction(&[cause(-785.0, true), cause(-265.0, false)]);
        let [Note::ByDirection { into, of, sides: [forward, backward] }] = &notes[..] else {
            panic!("{notes:?}")
        };
        assert_eq!((&into[..], of.as_deref()), ("rod", Some("speed")));
        assert_eq!((forward.value, forward.std_error), (1050.0, Some(5.0)));
        assert_eq!((backward.value, backward.std_error), (520.0, Some(5.0)));
    }

    #[test]
    fn a_larger_constant_drives_and_another_channel_has_no_part_in_it() {
        assert!(by_direction(&[cause(-100.0, true), cause(-265.0, false)]).is_empty());
        let other = Cause { into: "piston".into(), ..cause(-265.0, false) };
        assert!(by_direction(&[cause(-785.0, true), other]).is_empty());
        assert!(by_direction(&[cause(-785.0, true)]).is_empty());
    }
}
