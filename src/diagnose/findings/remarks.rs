//! What was looked for and not found, and what else is worth knowing.

use crate::candidates::candidate::{Candidate, Wire};
use crate::findings::by_direction::by_direction;
use crate::findings::cause::Cause;
use crate::findings::context::Context;
use crate::findings::finding::NotFound;
use crate::findings::note::Note;
use crate::fit::finished::Finished;
use crate::fit::found::LeftOut;
use crate::fit::hypothesis::Track;
use crate::fit::nuisance::too_many;
use crate::fit::problem::Part;
use crate::plan::natural;
use crate::prepare::input_dependence::DEPENDS;
use crate::statistics::{corrected_score, rms};

/// Least score, as a normal one, of what a record is said to show.
const SEEN: f64 = 3.45;

impl Context<'_, '_> {
    /// The smallest size of every candidate that would have been seen.
    pub fn not_found(&self, chosen: &Finished) -> Vec<NotFound> {
        let Some(screen) = &chosen.found.first else { return vec![] };
        let left = rms(&self.problem.residual(&chosen.y, Part::Fit));
        let bar = corrected_score(screen.columns).max(SEEN);
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
                _ => cause.card.parameters[i].unit.text(&cause.units.0, &cause.units.1),
            });
            entries.push(NotFound {
                effect: cause.effect.into(),
                into: cause.into.clone(),
                of: cause.of.clone(),
                smallest_visible: (!cause.blended() && smallest.is_finite()).then_some(smallest),
                unit,
                kappa: scored.kappa,
                visible: smallest.is_finite() && smallest <= natural(cause),
            });
        }
        entries
    }

    /// What else is worth knowing of what was found.
    pub fn notes(&self, chosen: &Finished, causes: &[Cause]) -> Vec<Note> {
        let mut notes = vec![];
        let model = &chosen.fitted.model;
        if !model.added.is_empty() && chosen.dependence > DEPENDS {
            notes.push(Note::NotAll { score: chosen.dependence });
        }
        if model.added.len() > 1 {
            notes.push(Note::JointLookAlikes);
        }
        if let Some(parameters) = too_many(self.problem, &self.allowed.fixed) {
            let samples = self.problem.samples(Part::Fit).count();
            notes.push(Note::TooManyParameters { parameters, samples });
        }
        if let Some(LeftOut { laws, of, whole }) = chosen.found.left_out {
            let memory = self.problem.memory;
            notes.push(match whole {
                Some(whole) => Note::LawsLeftOut { laws, of, memory, whole },
                None => Note::LawsRanked { laws, of },
            });
        }
        if chosen.found.full {
            notes.push(Note::MostCauses);
        }
        let undetermined = chosen.undetermined.iter().map(|combination| combination.text.clone());
        notes.extend(undetermined.map(|parameters| Note::Undetermined { parameters }));
        if chosen.is_doubting() {
            notes.push(Note::AllParametersDoubted { prior: crate::fit::nuisance::PRIOR });
        }
        // causes begin with those that were added to the model, place by place
        let places = model.places();
        let parts = places.iter().zip(causes).flat_map(|(own, cause)| {
            let of = |&i: &usize| model.added[i].cause.clone();
            own.iter().map(of).filter_map(move |law| {
                let part = cause.parts.iter().find(|part| part.effect == law.effect)?;
                Some((law, part))
            })
        });
        for (law, part) in parts {
            let smooth = law.card.properties.smoothing_width;
            let width = part.parameters.iter().find(|v| smooth == Some(v.name.as_str()));
            if let Some(width) = width.filter(|w| w.std_error.is_none_or(|e| e > 0.5 * w.value)) {
                notes.push(Note::WidthUnresolved {
                    into: law.into.clone(),
                    at_most: width.value + 2.0 * width.std_error.unwrap_or(0.0),
                    unit: width.unit.clone(),
                });
            }
        }
        for added in &model.added {
            let cause = &added.cause;
            if let Wire::Stage(route) = &cause.wire
                && cause.card.properties.smoothing_width.is_some()
                && keeps_its_sign(self.nominal.series(route.source))
            {
                let note = Note::KeepsItsSign { into: cause.into.clone(), of: cause.of.clone() };
                if !notes.contains(&note) {
                    notes.push(note);
                }
            }
        }
        notes.extend(by_direction(causes));
        notes
    }
}

/// Where parameters make up for each other: each that is named, taken back alone, costs little of the
/// share `removed`.
pub(crate) fn made_up_for(track: Track, causes: &[Cause], removed: f64) -> Option<Note> {
    let mut named = causes.iter().filter(|c| !c.is_data_fault()).peekable();
    if track != Track::ParametersFree || named.peek().is_none() || removed <= 0.0 {
        return None;
    }
    let mut shares = 0.0;
    for cause in named {
        if !cause.is_parameter() {
            return None;
        }
        shares += cause.error_removed;
    }
    (shares < 0.5 * removed).then(|| Note::ParametersMakeUp { removed, each: shares / removed })
}

/// Whether a series goes to one side of 0 only, but for a fiftieth of its largest value.
fn keeps_its_sign(series: &[f64]) -> bool {
    let low = series.iter().copied().fold(0.0, f64::min);
    let high = series.iter().copied().fold(0.0, f64::max);
    f64::min(-low, high) < 0.02 * f64::max(-low, high)
}

#[cfg(test)]
mod tests {
    use super::{Cause, Note, Track, keeps_its_sign, made_up_for};
    use crate::findings::cause::{ColumnFault, Site, Wording};
    use crate::findings::causes::of_column;

    fn cause(site: Site, error_removed: f64) -> Cause {
        let fault = of_column("parameter", "inertia", ColumnFault::SwappedSign, vec![], vec![]);
        let wording = Wording { site, ..Wording::default() };
        Cause { error_removed, rows: None, wording, ..fault }
    }

    #[test]
    fn parameters_that_make_up_for_each_other_are_noted() {
        let noted = |track, causes: &[Cause]| made_up_for(track, causes, 0.99);
        let hardly = [cause(Site::Parameter, 0.001), cause(Site::Parameter, 0.01)];
        let note = noted(Track::ParametersFree, &hardly).unwrap();
        let Note::ParametersMakeUp { removed, each } = note else { panic!("{note:?}") };
        assert!(removed == 0.99 && (each - 0.011 / 0.99).abs() < 1e-12, "{removed} {each}");
        assert_eq!(noted(Track::ParametersTrusted, &hardly), None);
        assert_eq!(noted(Track::ParametersFree, &[cause(Site::Parameter, 0.9)]), None);
        let law = [cause(Site::Channel, 0.1), hardly[0].clone()];
        assert_eq!(noted(Track::ParametersFree, &law), None);
        assert_eq!(noted(Track::ParametersFree, &[]), None);
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
