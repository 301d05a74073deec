//! Several laws of one place as one cause: a cause is a place with a law, which may be a sum.

use crate::cause::{Cause, Site};
use crate::certify::false_discovery;
use crate::finding::Curve;
use crate::searched::Searched;

/// What a search says, with the laws of one place put together.
pub(super) fn by_place(mut of: Searched) -> Searched {
    let mut found: Vec<Cause> = vec![];
    let mut stands = vec![];
    for cause in of.causes {
        match found.iter().position(|own| is_one(own, &cause)) {
            Some(at) => {
                stands.push(at);
                let own = found.remove(at);
                found.insert(at, together(own, cause));
            }
            None => {
                stands.push(found.len());
                found.push(cause);
            }
        }
    }
    of.false_discovery = false_discovery(&found);
    of.causes = found;
    of.series.curves = drawn(of.series.curves, &stands);
    of
}

/// Curves with the causes that theirs stand in; laws of one place add up.
fn drawn(curves: Vec<Curve>, stands: &[usize]) -> Vec<Curve> {
    let mut kept: Vec<Curve> = vec![];
    for curve in curves {
        let cause = stands.get(curve.cause).copied().unwrap_or(curve.cause);
        match kept.iter_mut().find(|own| own.cause == cause) {
            Some(own) if own.law.len() == curve.law.len() => {
                own.law.iter_mut().zip(&curve.law).for_each(|(a, b)| a.1 += b.1);
                // the free curve was drawn around one of them
                own.knots.clear();
            }
            Some(_) => {}
            None => kept.push(Curve { cause, ..curve }),
        }
    }
    kept
}

/// Whether two causes are laws of one place: the same channel and coordinate, or an offset of it.
fn is_one(a: &Cause, b: &Cause) -> bool {
    let law =
        |c: &Cause| !c.is_data_fault() && !matches!(c.wording.site, Site::Parameter | Site::Drift);
    let of = a.of == b.of || a.wording.is_constant || b.wording.is_constant;
    law(a) && law(b) && a.into == b.into && of
}

/// Two laws of a place as one cause, called what the one that removes more is called.
fn together(a: Cause, b: Cause) -> Cause {
    let offset = |c: &Cause| c.wording.is_constant;
    let first = offset(&b) || !offset(&a) && a.error_removed >= b.error_removed;
    let (mut main, other) = if first { (a, b) } else { (b, a) };
    main.parts.extend(other.parts);
    main.error_removed = main.error_removed.max(other.error_removed);
    main.p_value = match (main.p_value, other.p_value) {
        (Some(a), Some(b)) => Some(a.min(b)),
        (a, b) => a.or(b),
    };
    let own = |alternative: &crate::cause::Alternative| {
        main.parts.iter().any(|part| part.effect == alternative.effect)
            && alternative.into == main.into
    };
    let mut alike = main.indistinguishable.clone();
    alike.extend(other.indistinguishable);
    let mut known: Vec<String> = vec![];
    alike.retain(|alternative| {
        let name = alternative.to_string();
        let new = !own(alternative) && !known.contains(&name);
        known.push(name);
        new
    });
    main.indistinguishable = alike;
    main
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cause::{LawPart, Wording};

    fn law(effect: &str, into: &str, of: Option<&str>, removed: f64) -> Cause {
        Cause {
            effect: effect.into(),
            into: into.into(),
            of: of.map(Into::into),
            parts: vec![LawPart { effect: effect.into(), parameters: vec![] }],
            error_removed: removed,
            wording: Wording { is_constant: of.is_none(), ..Wording::default() },
            ..Cause::default()
        }
    }

    #[test]
    fn laws_of_a_place_are_one_cause_and_an_offset_is_part_of_it() {
        let viscous = law("linear", "force", Some("v"), 0.2);
        let dry = law("coulomb_friction", "force", Some("v"), 0.7);
        let offset = law("bias", "force", None, 0.9);
        assert!(is_one(&viscous, &dry) && is_one(&dry, &offset));
        assert!(!is_one(&dry, &law("coulomb_friction", "force", Some("w"), 0.7)));
        let one = together(together(viscous, dry), offset);
        assert_eq!((one.effect.as_str(), one.of.as_deref()), ("coulomb_friction", Some("v")));
        assert_eq!(one.parts.len(), 3);
        assert_eq!(one.error_removed, 0.9);
    }
}
