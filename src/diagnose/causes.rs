//! Causes as plain data: numbers, sentences, shares.

use std::sync::Arc;

use super::candidate::{Candidate, Wire};
use super::certify::{either, on_test};
use super::error::DiagnoseError;
use super::finding::{Alternative, Cause, Value};
use super::finished::Finished;
use super::floor::Floor;
use super::problem::{Grain, Model};
use super::profile;
use super::refit::{Refit, refit};
use super::score::{Scored, TestData, removed};
use super::sets::SET;
use super::teller::Teller;
use super::words::sentence;

/// Spikes below this number and this share are chance.
const SPIKES: usize = 3;
const SPIKE_SHARE: f64 = 5e-4;
/// Candidates that are supposed where their number was not kept.
const MANY: usize = 1000;

impl Teller<'_, '_> {
    pub fn causes(
        &self,
        chosen: &Finished,
        test: &TestData,
        before: &Scored,
        after: &Scored,
        floors: &[Option<Floor>],
    ) -> Result<Vec<Cause>, DiagnoseError> {
        let model = &chosen.fitted.model;
        let screen = chosen.found.first.as_ref().or(chosen.found.last.as_ref());
        let candidates = screen.map_or(MANY, |screen| screen.columns);
        let mut causes = vec![];
        for (index, added) in model.added.iter().enumerate() {
            let cause = &added.cause;
            let bare = model.without(index);
            let without = if model.added.len() == 1 && chosen.moved.is_empty() {
                None
            } else {
                self.refitted(chosen, &bare)
            };
            let slot = &chosen.found.slots[index];
            let without = match without {
                Some(without) => Some(test.score(&self.extend(&without)?)?),
                None => None,
            };
            let without = without.as_ref().unwrap_or(before);
            let share = removed(before, without, after, floors);
            let p_value = either(on_test(without, after), slot.score, candidates);
            // the weights of a learned law stand in the extended model; no number of them says anything
            let values = match cause.is_learned() {
                true => vec![],
                false => self.values(chosen, index),
            };
            let nominal = match cause.wire {
                Wire::Parameter(p) => Some(self.problem.base.signals.parameters[p].value),
                _ => None,
            };
            // what holds of the headline's place holds of its twins', and need not be said again
            let twins = cause.twins.iter().map(|(into, of, _)| Alternative {
                effect: cause.effect.into(),
                into: into.clone(),
                of: of.clone(),
                error_removed: share,
            });
            let as_data =
                |(c, gain): &(Arc<Candidate>, f64)| alternative(c, gain.clamp(0.0, 1.0) * share);
            let members = slot.set.iter().filter(|(member, _)| !member.same_cause(cause));
            // other laws before twins: where there are too many, twins are missed least
            let mut indistinguishable: Vec<Alternative> =
                members.map(as_data).chain(twins).collect();
            let mut said = vec![cause.name()];
            indistinguishable.retain(|a: &Alternative| {
                let name = (a.effect.clone(), a.into.clone(), a.of.clone());
                let new = !said.contains(&name);
                said.push(name);
                new
            });
            let too_many = indistinguishable.split_off((SET - 1).min(indistinguishable.len()));
            let runners_up =
                too_many.into_iter().chain(slot.others.iter().map(as_data)).take(4).collect();
            if cause.is_known_limit() {
                causes.push(self.clipping(cause, values, share, p_value));
                continue;
            }
            causes.push(Cause {
                effect: cause.effect.into(),
                into: cause.into.clone(),
                of: cause.of.clone(),
                also_into: cause.also_into.iter().map(|a| a.channel().to_string()).collect(),
                also_of: cause.also_of.clone(),
                sentence: match cause.is_drawn() {
                    true if cause.is_learned() => self.learned_in_words(model, index, share),
                    true => self.curve_in_words(cause, &added.knobs, share),
                    false => sentence(cause, &values, share, nominal),
                },
                parameters: values,
                p_value,
                error_removed: share,
                indistinguishable,
                runners_up,
                acts_where: None,
                records: None,
                rows: None,
            });
        }
        Ok(causes)
    }

    /// Readings that were cut off by the instrument. The extended model has its limits, as a
    /// saturation of the output, which is the other name for it.
    fn clipping(&self, limit: &Candidate, values: Vec<Value>, share: f64, p_value: f64) -> Cause {
        let outputs = &self.problem.base.signals.outputs;
        let o = outputs.iter().position(|signal| signal.name == limit.into);
        let at = |y: f64| values.iter().any(|limit| limit.value == y);
        let rows: Vec<usize> = o.map_or_else(Vec::new, |o| {
            (0..self.problem.len()).filter(|&k| at(self.problem.y[o][k])).map(|k| k + 1).collect()
        });
        let said: Vec<String> = values.iter().map(|v| super::words::magnitude(v, true)).collect();
        let sentence = format!(
            "The readings of {} are cut off at {}: {} samples stand there.",
            limit.into,
            said.join(" and "),
            rows.len()
        );
        let named = |v: Value| Value { name: "value".into(), ..v };
        Cause {
            effect: "clipping".into(),
            into: limit.into.clone(),
            of: None,
            also_into: vec![],
            also_of: vec![],
            sentence,
            parameters: values.into_iter().map(named).collect(),
            p_value,
            error_removed: share,
            indistinguishable: vec![alternative(limit, share)],
            runners_up: vec![],
            acts_where: None,
            records: None,
            rows: Some(rows),
        }
    }

    /// Numbers of a cause: values of a parameter are the new value, not its change.
    fn values(&self, chosen: &Finished, index: usize) -> Vec<Value> {
        let added = &chosen.fitted.model.added[index];
        let cause = &added.cause;
        let knobs = cause.clipped(&added.knobs, self.problem.step(Grain::Fine));
        let errors = profile::errors(self.problem, chosen, index);
        let error = |i: usize| errors[i];
        if let Wire::Parameter(p) = cause.wire {
            return vec![Value {
                name: "value".into(),
                value: chosen.fitted.model.theta[p] + knobs[0],
                std_error: error(0),
                unit: cause.units.0.clone(),
            }];
        }
        let knobs = cause.card.knobs.iter().zip(knobs).enumerate();
        // where the values of a free curve stand is part of what was found
        let at = super::sketch::knots_of(cause).into_iter().enumerate().map(|(i, knot)| Value {
            name: format!("knots.{i}"),
            value: knot,
            std_error: None,
            unit: cause.units.1.clone(),
        });
        let values =
            knobs.filter(|(_, (_, value))| value.is_finite()).map(|(i, (knob, value))| Value {
                name: knob.name.to_string(),
                value,
                std_error: error(i),
                unit: match cause.wire {
                    Wire::Drift(_) if cause.units.0.is_empty() => "1/s".into(),
                    Wire::Drift(_) => format!("{}/s", cause.units.0),
                    _ => knob.unit.text(&cause.units.0, &cause.units.1),
                },
            });
        values.chain(at).collect()
    }

    /// Parameters that the chosen track moved, as causes.
    pub fn moved(
        &self,
        chosen: &Finished,
        test: &TestData,
        before: &Scored,
        after: &Scored,
        floors: &[Option<Floor>],
    ) -> Result<Vec<Cause>, DiagnoseError> {
        let mut causes = vec![];
        for moved in &chosen.moved {
            let parameters = &self.problem.base.signals.parameters;
            let Some(p) = parameters.iter().position(|q| q.name == moved.name) else { continue };
            let (share, by_test) = match self.back(chosen, p, moved.from) {
                Some(back) => {
                    let scored = test.score(&self.extend(&back)?)?;
                    (removed(before, &scored, after, floors), on_test(&scored, after))
                }
                None => (0.0, 1.0),
            };
            let unit = parameters[p].unit.clone();
            let value =
                Value { name: "value".into(), value: moved.to, std_error: moved.std_error, unit };
            causes.push(Cause {
                effect: "parameter".into(),
                into: moved.name.clone(),
                of: None,
                also_into: vec![],
                also_of: vec![],
                sentence: format!(
                    "Parameter {} is {} instead of {}, explains {} of the removable error.",
                    moved.name,
                    super::words::magnitude(&value, true),
                    super::words::number(moved.from, None),
                    super::words::percent(share),
                ),
                parameters: vec![value],
                p_value: either(by_test, moved.distance(), 2 * chosen.nuisance.free.len()),
                error_removed: share,
                indistinguishable: vec![],
                runners_up: vec![],
                acts_where: None,
                records: None,
                rows: None,
            });
        }
        Ok(causes)
    }

    /// The chosen model with one parameter where it began, refitted.
    pub fn back(&self, chosen: &Finished, p: usize, from: f64) -> Option<Model> {
        let mut back = chosen.fitted.model.clone();
        back.theta[p] = from;
        let mut nuisance = chosen.nuisance.clone();
        nuisance.free.retain(|&(q, _)| q != p);
        let models = std::slice::from_ref(&back);
        let fitted = refit(self.problem, &nuisance, models, Refit::last()).swap_remove(0);
        fitted.map(|fitted| fitted.model)
    }

    /// Spikes, where there are too many to be chance.
    pub fn outliers(&self, chosen: &Finished) -> Vec<Cause> {
        let mut causes = vec![];
        for (o, rows) in chosen.found.spikes.iter().enumerate() {
            let share = rows.len() as f64 / self.problem.len().max(1) as f64;
            if rows.len() < SPIKES || share <= SPIKE_SHARE {
                continue;
            }
            let into = self.problem.base.signals.outputs[o].name.clone();
            causes.push(Cause {
                effect: "outliers".into(),
                sentence: format!(
                    "Outliers in {into}: {} samples ({:.2} %) stand alone far off and were left out.",
                    rows.len(),
                    100.0 * share
                ),
                into,
                of: None,
                also_into: vec![],
                also_of: vec![],
                parameters: vec![Value {
                    name: "value".into(),
                    value: share,
                    std_error: None,
                    unit: String::new(),
                }],
                p_value: 1e-9,
                error_removed: 0.0,
                indistinguishable: vec![],
                runners_up: vec![],
                acts_where: None,
                records: None,
                rows: Some(rows.iter().map(|k| k + 1).collect()),
            });
        }
        causes
    }
}

pub fn alternative(cause: &Candidate, error_removed: f64) -> Alternative {
    Alternative {
        effect: cause.effect.into(),
        into: cause.into.clone(),
        of: cause.of.clone(),
        error_removed,
    }
}
