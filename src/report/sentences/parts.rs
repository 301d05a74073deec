//! The further laws of a cause that is a sum: `, with a linear part (coefficient -19.40 +- 0.20 N s/m)`.

use crate::diagnose::{Cause, LawPart};
use crate::digits::interval;

/// What stands beside the headline's law; nothing for a plain law.
pub(super) fn beside(cause: &Cause) -> String {
    // the headline's own part is told already
    let own = cause.parts.iter().position(|part| part.effect == cause.effect);
    let others = cause.parts.iter().enumerate();
    let others = others.filter(|(i, part)| Some(*i) != own && !part.parameters.is_empty());
    let others: Vec<String> = others.map(|(_, part)| one(part)).collect();
    match others.is_empty() {
        true => String::new(),
        false => format!(", with {}", others.join(" and ")),
    }
}

/// `a linear part (coefficient -19.40 +- 0.20 N s/m)`.
fn one(part: &LawPart) -> String {
    let name = part.effect.replace('_', " ");
    let article = if name.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" };
    let finite = part.parameters.iter().filter(|v| v.value.is_finite());
    let values = finite.map(|v| format!("{} {}", v.name, interval(v.value, v.std_error, &v.unit)));
    format!("{article} {name} part ({})", values.collect::<Vec<_>>().join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::Value;

    #[test]
    fn further_laws_are_told_with_their_numbers() {
        let part = |effect: &str, name: &str, value: f64| LawPart {
            effect: effect.into(),
            parameters: vec![Value { name: name.into(), value, std_error: None, unit: "N".into() }],
        };
        let mut cause = Cause {
            effect: "coulomb_friction".into(),
            parts: vec![part("coulomb_friction", "level", -10.0)],
            ..Cause::default()
        };
        assert_eq!(beside(&cause), "");
        cause.parts.push(part("bias", "value", 3.0));
        let said = beside(&cause);
        assert!(said.starts_with(", with a bias part (value 3") && said.ends_with("N)"), "{said}");
    }
}
