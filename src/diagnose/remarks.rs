//! What was looked for and not found, and what else is worth knowing.

use super::candidate::{Candidate, Wire};
use super::dependence::DEPENDS;
use super::finding::{Cause, NotFound, Track};
use super::finished::Finished;
use super::problem::Part;
use super::teller::Teller;
use crate::statistics::rms;

impl Teller<'_, '_> {
    /// The smallest size of every candidate that would have been seen.
    pub fn not_found(&self, chosen: &Finished) -> Vec<NotFound> {
        let Some(screen) = chosen.found.last.as_ref().or(chosen.found.first.as_ref()) else {
            return vec![];
        };
        let left = rms(&self.problem.residual(&chosen.y, Part::Fit));
        let bar = super::stage::gate(screen.columns);
        let named = |c: &Candidate| chosen.fitted.model.added.iter().any(|a| a.cause.same_cause(c));
        let mut seen: Vec<(String, String, Option<String>)> = vec![];
        let mut entries = vec![];
        for scored in screen.scored.iter().filter(|s| !named(&s.cause)) {
            let cause = &scored.cause;
            let triple = (cause.effect.to_string(), cause.into.clone(), cause.of.clone());
            if seen.contains(&triple) {
                continue;
            }
            seen.push(triple);
            let smallest = bar * left / scored.unit_effect;
            let unit = cause.linear.first().map_or_else(String::new, |&i| match cause.wire {
                Wire::Parameter(_) => cause.units.0.clone(),
                Wire::Drift(_) => format!("{}/s", cause.units.0),
                _ => cause.card.knobs[i].unit.text(&cause.units.0, &cause.units.1),
            });
            entries.push(NotFound {
                effect: cause.effect.into(),
                into: cause.into.clone(),
                of: cause.of.clone(),
                smallest_visible: (!cause.blended() && smallest.is_finite()).then_some(smallest),
                unit,
                kappa: scored.kappa,
            });
        }
        entries
    }

    pub fn remarks(&self, chosen: &Finished, causes: &[Cause]) -> Vec<String> {
        let mut remarks = vec![];
        if !chosen.fitted.model.added.is_empty() && chosen.dependence > DEPENDS {
            remarks.push(format!(
                "What is named is not all of it: what is left still depends on the inputs (score {:.1}).",
                chosen.dependence
            ));
        }
        if chosen.fitted.model.added.len() > 1 {
            remarks.push(
                "Each set of look-alikes holds for the other causes as named: two causes can jointly imitate two others."
                    .into(),
            );
        }
        if chosen.found.full {
            remarks.push("The search stopped at the largest number of causes allowed.".into());
        }
        if chosen.is_doubting() {
            remarks.push(format!(
                "A parameter is named as wrong, so the standard errors allow for the others to be wrong too (prior: {}). Hold with --fix those that you are sure of.",
                super::words::percent(super::nuisance::PRIOR)
            ));
        }
        let bound = |effect: &str| matches!(effect, "coulomb_friction" | "stribeck_friction");
        for cause in causes.iter().filter(|c| bound(&c.effect)) {
            let width = cause.parameters.iter().find(|v| v.name == "width");
            if let Some(width) = width.filter(|w| w.std_error.is_none_or(|e| e > 0.5 * w.value)) {
                remarks.push(format!(
                    "The record does not resolve the width of the friction on {}: it is at most about {}.",
                    cause.into,
                    super::words::number(width.value + 2.0 * width.std_error.unwrap_or(0.0), None)
                ));
            }
        }
        for added in &chosen.fitted.model.added {
            let cause = &added.cause;
            if let Wire::Stage(route) = &cause.wire
                && bound(cause.effect)
                && keeps_its_sign(self.nominal.series(route.source))
            {
                remarks.push(format!(
                    "{} keeps its sign: while it moves, dry friction on {} looks like an offset; only rest, starts and stops tell them apart.",
                    cause.of.as_deref().unwrap_or("The velocity"),
                    cause.into
                ));
            }
        }
        remarks
    }
}

/// Says where parameters make up for each other: each that is named, taken back alone, costs little
/// of the share `removed`.
pub(crate) fn made_up_for(track: Track, causes: &[Cause], removed: f64) -> Option<String> {
    let mut named = causes.iter().filter(|c| c.rows.is_none()).peekable();
    if track != Track::ParametersFree || named.peek().is_none() || removed <= 0.0 {
        return None;
    }
    let mut shares = 0.0;
    for cause in named {
        if cause.effect != "parameter" {
            return None;
        }
        shares += cause.error_removed;
    }
    (shares < 0.5 * removed).then(|| {
        format!(
            "The extended model removes {} of the removable error; without what is named, the other parameters would make up for all but {} of that. The record tells that parameters are wrong, hardly which: hold with --fix those that you are sure of.",
            super::words::percent(removed),
            super::words::percent(shares / removed),
        )
    })
}

/// Whether a series goes to one side of 0 only, but for a fiftieth of its largest value.
fn keeps_its_sign(series: &[f64]) -> bool {
    let low = series.iter().copied().fold(0.0, f64::min);
    let high = series.iter().copied().fold(0.0, f64::max);
    f64::min(-low, high) < 0.02 * f64::max(-low, high)
}

#[cfg(test)]
mod tests {
    use super::{Cause, Track, keeps_its_sign, made_up_for};

    fn cause(effect: &str, error_removed: f64) -> Cause {
        Cause {
            effect: effect.into(),
            into: "inertia".into(),
            of: None,
            also_into: vec![],
            also_of: vec![],
            sentence: String::new(),
            parameters: vec![],
            p_value: 0.0,
            error_removed,
            indistinguishable: vec![],
            runners_up: vec![],
            acts_where: None,
            records: None,
            rows: None,
        }
    }

    #[test]
    fn parameters_that_make_up_for_each_other_are_said_to() {
        let said = |track, causes: &[Cause]| made_up_for(track, causes, 0.99);
        let hardly = [cause("parameter", 0.001), cause("parameter", 0.01)];
        let text = said(Track::ParametersFree, &hardly).unwrap();
        assert!(
            text.contains("99.0 %") && text.contains("but 1 %") && text.contains("--fix"),
            "{text}"
        );
        assert_eq!(said(Track::ParametersTrusted, &hardly), None);
        assert_eq!(said(Track::ParametersFree, &[cause("parameter", 0.9)]), None);
        assert_eq!(said(Track::ParametersFree, &[cause("drag", 0.1), hardly[0].clone()]), None);
        assert_eq!(said(Track::ParametersFree, &[]), None);
        assert_eq!(made_up_for(Track::ParametersFree, &hardly, 0.0), None);
    }

    #[test]
    fn one_stroke_keeps_its_sign_and_there_and_back_does_not() {
        assert!(keeps_its_sign(&[0.0, -0.001, 0.3, 0.6, 0.2, 0.0]));
        assert!(keeps_its_sign(&[0.0, -0.3, 0.001]));
        assert!(!keeps_its_sign(&[0.0, 0.3, -0.1]));
        assert!(!keeps_its_sign(&[]));
    }
}
