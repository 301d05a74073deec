//! Parameters that a fit moved beyond their standard errors, as causes.

use crate::candidates::naming::{parameter_effect, title_of};
use crate::error::DiagnoseError;
use crate::findings::cause::{Alternative, Cause, LawPart, Site, Value, Wording};
use crate::findings::context::Context;
use crate::findings::scoring::Scores;
use crate::fit::extended::extended;
use crate::fit::finished::Finished;
use crate::fit::found::{Instead, SET};
use crate::fit::nuisance::Key;
use crate::fit::problem::Model;
use crate::fit::refit::{Refit, Stop, refit_until};
use crate::likelihood::has_moved;
use crate::validate::false_discovery::{either, on_test};
use crate::validate::test_error::removed;
use crate::watch::Watch;

/// Others that are said beside a set.
const OTHERS: usize = 4;

impl Context<'_, '_> {
    /// Parameters that the chosen track moved, as causes.
    pub(crate) fn moved(
        &self,
        chosen: &Finished,
        by: &Scores<'_>,
    ) -> Result<Vec<Cause>, DiagnoseError> {
        let mut causes = vec![];
        for moved in &chosen.moved {
            let parameters = &self.problem.base.signals.parameters;
            let Some(p) = parameters.iter().position(|q| q.name == moved.name) else { continue };
            let back = self.back(chosen, p, moved.from, by.watch);
            let (share, by_test) = match &back {
                Some(back) => {
                    let scored = by.test.score(&extended(self.problem, back)?)?;
                    let share = removed(by.before, &scored, by.after, by.floors);
                    let on_test = match by.predicted {
                        None => on_test(&scored, by.after),
                        Some(errors) => {
                            let mut without = chosen.fitted.model.clone();
                            without.theta[p] = moved.from;
                            self.by_predictions(errors, &without)?
                        }
                    };
                    (share, on_test)
                }
                None => (0.0, 1.0),
            };
            let records =
                back.filter(|_| by.several).and_then(|back| self.per_record(&back, &chosen.y));
            let unit = parameters[p].unit.clone();
            let value = Value {
                name: "value".into(),
                value: moved.to,
                std_error: chosen.error_of(&moved.name, moved.std_error),
                unit: unit.clone(),
            };
            let probability = self.probability_of(chosen, p);
            let effect = parameter_effect();
            let (indistinguishable, runners_up) = self.alike(chosen, &moved.name, share);
            causes.push(Cause {
                effect: effect.into(),
                into: moved.name.clone(),
                of: None,
                also_into: vec![],
                also_of: vec![],
                parts: vec![LawPart {
                    effect: effect.into(),
                    parameters: vec![value.clone()],
                    ..LawPart::default()
                }],
                wording: Wording {
                    title: title_of(effect),
                    site: Site::Parameter,
                    nominal: Some(moved.from),
                    first: Some(value.name.clone()),
                    units: (unit, String::new()),
                    ..Wording::default()
                },
                parameters: vec![value],
                p_value: Some(either(by_test, moved.distance(), 2 * chosen.nuisance.free.len())),
                probability,
                // a parameter is a place of its own
                place_probability: probability,
                error_removed: share,
                indistinguishable,
                runners_up,
                onset: None,
                acts_where: None,
                most_like: None,
                records,
                rows: None,
            });
        }
        Ok(causes)
    }

    /// Laws that do what a parameter does, and those beyond the members of a set: of the first one also
    /// those in the stead of parameters that are not named, which it stands for.
    fn alike(
        &self,
        chosen: &Finished,
        name: &str,
        share: f64,
    ) -> (Vec<Alternative>, Vec<Alternative>) {
        let parameters = &self.problem.base.signals.parameters;
        let is_named = |p: usize| chosen.moved.iter().any(|one| one.name == parameters[p].name);
        let is_first = chosen.moved.first().is_some_and(|first| first.name == name);
        let off = &chosen.found.off;
        let own = off.instead.iter().filter(|one| {
            parameters[one.parameter].name == name || is_first && !is_named(one.parameter)
        });
        let mut own: Vec<&Instead> = own.collect();
        own.sort_by(|a, b| b.probability.total_cmp(&a.probability));
        let mut alike: Vec<Alternative> = vec![];
        for one in own {
            let said = one.cause.alternative(share).weighed(one.probability);
            let same = |known: &Alternative| {
                (&known.effect, &known.into, &known.of) == (&said.effect, &said.into, &said.of)
            };
            if !alike.iter().any(same) {
                alike.push(said);
            }
        }
        let mut others = alike.split_off((SET - 1).min(alike.len()));
        others.truncate(OTHERS);
        (alike, others)
    }

    /// Probability that a parameter is off: with all others free, or it alone. `None` where nothing is known of
    /// its value.
    fn probability_of(&self, chosen: &Finished, p: usize) -> Option<f64> {
        let key = Key::Theta(p);
        let unknown = chosen.nuisance.unknown(self.problem, &chosen.fitted.model, key);
        let (from, width) = unknown.prior?;
        let own = has_moved(chosen.fitted.model.theta[p] - from, chosen.error(key)?, width);
        let off = &chosen.found.off;
        let single = off.single.get(p).copied().unwrap_or(0.0);
        Some((off.all * own + single).clamp(0.0, 1.0))
    }

    /// The chosen model with one parameter where it began, refitted.
    fn back(&self, chosen: &Finished, p: usize, from: f64, watch: &dyn Watch) -> Option<Model> {
        let mut back = chosen.fitted.model.clone();
        back.theta[p] = from;
        let mut nuisance = chosen.nuisance.clone();
        nuisance.free.retain(|&(q, _)| q != p);
        let models = std::slice::from_ref(&back);
        let asked = || watch.stopped();
        let stop = Stop::Keep(&asked);
        let fitted =
            refit_until(self.problem, &nuisance, models, Refit::last(), stop).swap_remove(0);
        fitted.map(|fitted| fitted.model)
    }
}
