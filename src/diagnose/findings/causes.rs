//! Causes as plain data: numbers, shares, what each record says of them.

use std::sync::Arc;

use crate::candidates::candidate::{Candidate, Wire};
use crate::candidates::naming::{parameter_effect, title_of};
use crate::candidates::sums::by_likeness;
use crate::error::DiagnoseError;
use crate::findings::cause::{
    Alternative, Cause, ColumnFault, LawPart, Site, Unweighed, Value, Wording,
};
use crate::findings::context::Context;
use crate::findings::note::Note;
use crate::findings::scoring::Scores;
use crate::fit::extended::extended;
use crate::fit::finished::Finished;
use crate::fit::found::SET;
use crate::fit::problem::Added;
use crate::validate::false_discovery::{either, on_test};
use crate::validate::test_error::removed;

/// Spikes below this number and this share are chance.
const SPIKES: usize = 3;
const SPIKE_SHARE: f64 = 5e-4;
/// Candidates that are supposed where their number was not kept.
const MANY: usize = 1000;

impl Context<'_, '_> {
    /// The causes that were added to the model, then the parameters that moved.
    pub fn causes(&self, chosen: &Finished, by: &Scores<'_>) -> Result<Vec<Cause>, DiagnoseError> {
        let places = chosen.fitted.model.places().into_iter();
        let at_place = |own| self.at_place(chosen, own, by);
        let mut causes = places.map(at_place).collect::<Result<Vec<_>, _>>()?;
        causes.extend(self.moved(chosen, by)?);
        Ok(causes)
    }

    /// The same causes by their names alone, with the names that cannot be told from them; nothing is
    /// measured of them.
    pub fn names(&self, chosen: &Finished) -> Vec<Cause> {
        let model = &chosen.fitted.model;
        let is_law = |own: &Vec<usize>| !model.added[own[0]].cause.is_known_limit();
        let law = |own| {
            let own = by_likeness(self.problem, self.nominal, model, own);
            let cause = &model.added[own[0]].cause;
            let laws = own.iter().map(|&i| model.added[i].cause.name()).collect();
            let (effect, into, of) = cause.heading();
            let (indistinguishable, _) =
                alternatives(cause, &chosen.found.slots[own[0]], 0.0, laws);
            Cause { effect, into, of, indistinguishable, ..Cause::default() }
        };
        let laws = model.places().into_iter().filter(is_law).map(law);
        let moved = chosen.moved.iter().map(|moved| Cause {
            effect: parameter_effect().into(),
            into: moved.name.clone(),
            ..Cause::default()
        });
        laws.chain(moved).collect()
    }

    /// The laws of one place as one cause.
    fn at_place(
        &self,
        chosen: &Finished,
        own: Vec<usize>,
        by: &Scores<'_>,
    ) -> Result<Cause, DiagnoseError> {
        let model = &chosen.fitted.model;
        let only = model.added.len() == own.len() && chosen.moved.is_empty();
        let bare = (by.several || !only)
            .then(|| self.refitted(chosen, &model.without_all(&own), by.watch))
            .flatten();
        let without = match bare.as_ref().filter(|_| !only) {
            Some(bare) => Some(by.test.score(&extended(self.problem, bare)?)?),
            None => None,
        };
        let without = without.as_ref().unwrap_or(by.before);
        let share = removed(by.before, without, by.after, by.floors);
        let candidates = chosen.found.first.as_ref().map_or(MANY, |screen| screen.columns);
        // all of them together do no less than one of them
        let score = own.iter().map(|&i| chosen.found.slots[i].score).fold(0.0, f64::max);
        let on_test = match by.predicted {
            None => on_test(without, by.after),
            Some(errors) => self.by_predictions(errors, &model.without_all(&own))?,
        };
        let p_value = Some(either(on_test, score, candidates));
        let own = by_likeness(self.problem, self.nominal, model, own);
        let mut parts: Vec<LawPart> = own.iter().map(|&i| self.part(chosen, i)).collect();
        let (cause, slot) = (&model.added[own[0]].cause, &chosen.found.slots[own[0]]);
        let values = parts[0].parameters.clone();
        if cause.is_known_limit() {
            return Ok(self.clipping(cause, values, share, p_value, by.firsts));
        }
        let laws: Vec<_> = own.iter().map(|&i| model.added[i].cause.name()).collect();
        let (indistinguishable, runners_up) = alternatives(cause, slot, share, laws);
        let is_moment = |own: &Value| {
            cause.card.properties.begins.is_some_and(|begins| own.name == begins.from)
        };
        let records =
            bare.filter(|_| by.several).and_then(|bare| self.per_record(&bare, &chosen.y));
        let acts_where = self.acts_where(model, &own);
        parts[0].wording.rectifies = self.rectifies(model, &own);
        parts[0].wording.is_line_here = acts_where.is_none() && self.is_straight(model, &own);
        let (effect, into, of) = cause.heading();
        Ok(Cause {
            effect,
            into,
            of,
            also_into: cause.also_into.iter().map(|a| a.channel().to_string()).collect(),
            also_of: cause.also_of.clone(),
            parameters: values.into_iter().filter(|own| !is_moment(own)).collect(),
            p_value,
            probability: slot.belief.as_ref().map(|belief| belief.law),
            place_probability: slot.belief.as_ref().map(|belief| belief.place),
            error_removed: share,
            indistinguishable,
            runners_up,
            onset: cause.onset(&parts[0].parameters),
            acts_where,
            most_like: self.most_like(model, &own),
            records,
            rows: None,
            wording: parts[0].wording.clone(),
            parts,
        })
    }

    /// One law with its numbers and what sentences need.
    fn part(&self, chosen: &Finished, index: usize) -> LawPart {
        let model = &chosen.fitted.model;
        let Added { cause, parameters } = &model.added[index];
        // the weights of a learned law stand in the extended model; no number of them says anything
        let values = match cause.is_learned() {
            true => vec![],
            false => self.values(chosen, index),
        };
        let nominal = match cause.wire {
            Wire::Parameter(p) | Wire::Drift(p) => {
                Some(self.problem.base.signals.parameters[p].value)
            }
            _ => None,
        };
        let shape = cause.is_drawn().then(|| match cause.is_learned() {
            true => self.found_law(model, index),
            false => self.found_curve(cause, parameters),
        });
        let total = self.total(chosen, index);
        let wording = Wording { shape, total, ..cause.wording(nominal) };
        LawPart { wording, ..cause.as_part(&values) }
    }

    /// Readings that were cut off by the instrument. The extended model has its limits, as a
    /// saturation of the output, which is the other name for it.
    fn clipping(
        &self,
        limit: &Candidate,
        values: Vec<Value>,
        share: f64,
        p_value: Option<f64>,
        firsts: &[usize],
    ) -> Cause {
        let outputs = &self.problem.base.signals.outputs;
        let o = outputs.iter().position(|signal| signal.name == limit.into);
        let at = |y: f64| values.iter().any(|limit| limit.value == y);
        let rows: Vec<usize> = o.map_or_else(Vec::new, |o| {
            let stand = (0..self.problem.len()).filter(|&k| at(self.problem.y[o][k]));
            stand.map(|k| self.joined.row(k, firsts)).collect()
        });
        let named = |v: Value| Value { name: "value".into(), ..v };
        let parameters = values.into_iter().map(named).collect();
        let unweighed = Some(Unweighed::SameModel);
        let other = Alternative { unweighed, ..limit.alternative(share) };
        let fault = of_column("clipping", &limit.into, ColumnFault::Clipping, parameters, rows);
        Cause { p_value, error_removed: share, indistinguishable: vec![other], ..fault }
    }

    /// Spikes, where there are too many to be chance.
    pub fn outliers(
        &self,
        chosen: &Finished,
        firsts: &[usize],
        levels: &[Option<Note>],
    ) -> Vec<Cause> {
        let mut causes = vec![];
        for (o, rows) in chosen.found.spikes.iter().enumerate() {
            let rows = &self.problem.still_isolated(o, &chosen.y[o], rows);
            let far = match levels.get(o) {
                Some(Some(Note::HeavyTails { .. })) => continue,
                Some(Some(_)) => Some(self.far_from_near(chosen, o, rows)),
                _ => None,
            };
            let rows = far.as_ref().unwrap_or(rows);
            let share = rows.len() as f64 / self.problem.len().max(1) as f64;
            if rows.len() < SPIKES || share <= SPIKE_SHARE {
                continue;
            }
            let into = &self.problem.base.signals.outputs[o].name;
            let unit = String::new();
            let value = Value { name: "value".into(), value: share, std_error: None, unit };
            let rows = rows.iter().map(|&k| self.joined.row(k, firsts)).collect();
            causes.push(of_column(
                "outliers",
                into,
                ColumnFault::Outliers(share),
                vec![value],
                rows,
            ));
        }
        causes
    }
}

/// A fault of a column, with the number that goes with it and its rows.
pub(crate) fn of_column(
    effect: &str,
    into: &str,
    fault: ColumnFault,
    parameters: Vec<Value>,
    rows: Vec<usize>,
) -> Cause {
    Cause {
        effect: effect.into(),
        into: into.into(),
        parts: vec![LawPart {
            effect: effect.into(),
            parameters: parameters.clone(),
            ..LawPart::default()
        }],
        parameters,
        rows: Some(rows),
        wording: Wording {
            title: title_of(effect),
            site: Site::Column,
            fault: Some(fault),
            ..Wording::default()
        },
        ..Cause::default()
    }
}

/// What cannot be told from a cause that removes this share, and what comes next; `known`: its own laws.
fn alternatives(
    cause: &Arc<Candidate>,
    slot: &crate::fit::found::Slot,
    share: f64,
    mut known: Vec<(String, String, Option<String>)>,
) -> (Vec<Alternative>, Vec<Alternative>) {
    // what holds of the headline's place holds of its twins', and need not be said again
    let twins = cause.twins.iter().map(|(into, of, _)| Alternative {
        into: into.clone(),
        of: of.clone(),
        unweighed: Some(Unweighed::SameModel),
        ..cause.alternative(share)
    });
    let weighed = |list: &[(Arc<Candidate>, f64)], chances: Option<&Vec<f64>>| {
        let one = |(i, (other, gain)): (usize, &(Arc<Candidate>, f64))| {
            let plain = other.alternative(gain.clamp(0.0, 1.0) * share);
            match chances.and_then(|chances| chances.get(i)) {
                Some(&chance) => plain.weighed(chance),
                None => plain,
            }
        };
        list.iter().enumerate().map(one).collect::<Vec<Alternative>>()
    };
    let belief = slot.belief.as_ref();
    let members = weighed(&slot.set, belief.map(|belief| &belief.members)).into_iter();
    let others = weighed(&slot.others, belief.map(|belief| &belief.others));
    let members = members.zip(&slot.set).filter(|(_, (own, _))| !own.same_cause(cause));
    // other laws before twins: where there are too many, twins are missed least
    let mut alike: Vec<Alternative> =
        members.map(|(said, _)| said).chain(twins).chain(cause.fault_of_column(share)).collect();
    alike.retain(|a: &Alternative| {
        let name = (a.effect.clone(), a.into.clone(), a.of.clone());
        let new = !known.contains(&name);
        known.push(name);
        new
    });
    let too_many = alike.split_off((SET - 1).min(alike.len()));
    let next = too_many.into_iter().chain(others).take(4).collect();
    (alike, next)
}
