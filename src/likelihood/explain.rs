//! All causes of a record: one place after the other, each with its laws.
//!
//! ```text
//! causes that are given (`given.rs`), none as a rule
//! repeat  the most probable place and its laws, given the causes before (`places.rs`)
//!         all causes fitted together, the noise anew
//! until nothing more is probable, fitted together with the others too (`joint.rs`)
//! a given law is weighed as one that is found (`given_weighed.rs`), and
//! a law that is a parameter in disguise becomes the parameter (`exchange.rs`), a lag or a delay moves to another
//! instrument (`instruments.rs`), all free parameters are one cause (`all_parameters.rs`), the pole of a slow force
//! is chosen anew, with a constant or without (`steady.rs`), and so is the law of a place, the other causes being
//! there (`joint.rs`), an improbable error of a parameter is taken back (`taken_back.rs`); then more causes
//! causes that are not needed beside the others are left out, those that held samples speak against withdrawn
//! (`elimination.rs`); the rest fitted to all samples
//! ```
//!
//! A search that is far behind another (`Given::rival`) once no further cause is probable goes no further (`racing.rs`).
//!
//! Source: Miller, "Subset Selection in Regression", 2nd ed., 2002.

use std::collections::BTreeSet;
use std::ops::Range;

use nalgebra::DMatrix;

use super::error::LikelihoodError;
use super::explanation::{Explanation, NamedCause};
use super::found::{First, Found, dealt, joined, laws};
use super::given::{Begun, Given};
use super::hypothesis::Hypothesis;
use super::layout::Layout;
use super::noise::Noise;
use super::predictor::{Predictor, starts};
use super::racing::RACED;
use super::ranked::MISSING;
use super::replay::Pass;
use super::savage_dickey::probability;
use super::tangent::Site;
use super::weigh::{Weighed, plainest};

impl Predictor {
    /// What explains the records, at most `most` causes beside parameters that move, from causes that are given on; `held` are samples
    /// that nothing is fitted to until causes are chosen, and that may refute them. `noise` is that of the
    /// model with the given causes alone, where it is known. `stop` is asked between causes.
    ///
    /// # Errors
    ///
    /// As [`Predictor::fit_noise`].
    pub fn explain(
        &self,
        (given, most): (&Given, usize),
        held: &[Range<usize>],
        noise: Option<&Noise>,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Result<Explanation, LikelihoodError> {
        let mut fit = self.blinded(held);
        let Begun { null, mut found, mut now } = fit.first_hypothesis(given, noise)?;
        let gain = fit.merit(&now, &found) - fit.merit(&null, &[]);
        let nothing = if found.is_empty() { 1.0 } else { probability(-gain) };
        let mut first = First { nothing, sets: vec![] };
        let (mut seen, mut elsewhere) = (BTreeSet::new(), vec![]);
        let is_far = |now: &Hypothesis, found: &[Found]| {
            given.rival.is_some_and(|rival| fit.merit(now, found) < rival - RACED)
        };
        let given_up = loop {
            (found, now) = fit.one_by_one((found, now), most, stop, &mut first)?;
            if is_far(&now, &found) {
                break true;
            }
            // laws that give way to each other in turn end where they were before
            let mut exchanged = || {
                fit.given_weighed(&mut found, &mut now, stop)
                    || fit.exchanged(&mut found, &mut now, stop)
                    || fit
                        .moved_between_instruments(&mut found, &mut now, stop)
                        .map(|tried| elsewhere = tried)
                        .is_none()
                    || !stop() && fit.parameters_exchanged(&mut found, &mut now, &null)
                    || fit.steadied((&mut found, &mut now), most, stop)
                    || fit.laws_anew((&mut found, &mut now), most, stop) && seen.insert(now.names())
                    || fit.taken_back(&mut found, &mut now, stop)
            };
            if stop() || !exchanged() {
                break false;
            }
        };
        let full = laws(&found) >= most;
        // what is known is told at once to somebody who asks to stop
        let is_over = || given_up || stop();
        if !is_over() {
            fit.note_instruments(&mut found, &elsewhere);
            fit.pruned_causes(&mut found, &mut now, &null);
        }
        let merit = fit.merit(&now, &found);
        let all = Self { start: fit.start.clone(), ..self.clone() };
        let mut withdrawn = vec![];
        if !is_over()
            && let Some(other) = all.otherwise((&found, &now), held, stop)
        {
            (found, now) = other;
        }
        while !is_over()
            && let Some(worst) = all.refuted(&fit, &found, &now, &null, held)
        {
            withdrawn.push(found.remove(worst.0));
            now = worst.1;
        }
        let fitted = if is_over() { None } else { all.fit_all(&mut found, &now.theta, &now.noise) };
        let finished = all.finished((found, withdrawn), fitted.unwrap_or(now), first)?;
        Ok(Explanation { full, merit, ..finished })
    }

    /// Causes one after the other, beside those that are known.
    fn one_by_one(
        &self,
        (mut found, mut now): (Vec<Found>, Hypothesis),
        most: usize,
        stop: &(dyn Fn() -> bool + Sync),
        first: &mut First,
    ) -> Result<(Vec<Found>, Hypothesis), LikelihoodError> {
        while laws(&found) < most && !stop() {
            let survey = self.holding(&now)?.survey(&now.noise, None, stop)?;
            if found.is_empty() {
                *first = First::of(&survey);
            }
            // a place is chosen twice at most, a parameter once
            let settled = |set: &&Weighed| {
                let at = |cause: &&Found| cause.place == set.place;
                let is_moved = |p: usize| found.iter().any(|cause| cause.moves().any(|q| q == p));
                match set.place.0 {
                    Site::Parameter(p) => is_moved(p),
                    _ => found.iter().find(at).is_some_and(|cause| cause.chosen_again),
                }
            };
            let open: Vec<Weighed> = survey.sets.iter().filter(|s| !settled(s)).cloned().collect();
            if stop() {
                break;
            }
            let Some(best) = plainest(&open).filter(|set| set.log_odds > MISSING) else {
                let Some(more) = self.joint_fit(&survey, &open, (&found, &now), stop) else {
                    break;
                };
                (found, now) = more;
                continue;
            };
            let known = found.iter().position(|cause| cause.place == best.place);
            let (mut kept, cause) = match known {
                None => (found.clone(), self.of(&survey, best)),
                Some(at) => {
                    let mut kept = found.clone();
                    let old = kept.remove(at);
                    let parts = joined(&kept);
                    let rest = Hypothesis { parts, ..now.clone() };
                    let again = self.holding(&rest)?.survey(&now.noise, Some(old.place), stop)?;
                    let Some(first) = plainest(&again.sets) else { break };
                    let cause = self.of(&again, first);
                    // the place was chosen among all of them
                    (kept, Found { chosen_again: true, choice: old.choice, ..cause })
                }
            };
            let start = best.hypothesis.clone();
            kept.push(cause);
            let joint = self.fit_all(&mut kept, &start.theta, &start.noise);
            let better = |h: &Hypothesis| self.merit(h, &kept) > self.merit(&now, &found);
            match (joint.filter(better), known) {
                (Some(joint), _) => (found, now) = (kept, joint),
                // it stays as it was; another place may still lack something
                (None, Some(at)) => found[at].chosen_again = true,
                (None, None) => break,
            }
        }
        Ok((found, now))
    }

    /// The predictor of a model that has a hypothesis in it.
    pub(super) fn holding(&self, of: &Hypothesis) -> Result<Self, LikelihoodError> {
        let mut here = self.clone();
        here.model = self.extended(&of.parts, &of.theta)?;
        here.system.effects.extend(self.placed(&of.parts));
        Ok(here)
    }

    /// Criterion of a hypothesis, how probable its parameters are beforehand, less what its causes were chosen
    /// from.
    pub(crate) fn merit(&self, of: &Hypothesis, found: &[Found]) -> f64 {
        let choice: f64 = found.iter().map(|cause| cause.choice).sum();
        of.criterion(self.observed()) + self.log_prior(of) - choice
    }

    /// The causes that are left, as they are said.
    fn finished(
        &self,
        (mut found, withdrawn): (Vec<Found>, Vec<Found>),
        now: Hypothesis,
        first: First,
    ) -> Result<Explanation, LikelihoodError> {
        dealt(&mut found, &now);
        let (mut now, mut run) = self.evaluated(now)?;
        if let Some(noise) = self.needed_noise(&now, &run.path)? {
            (now, run) = self.evaluated(Hypothesis { noise, ..now })?;
        }
        let covariances = self.covariances(&now, &run);
        let (covariances, doubt) = self.averaged(&mut found, &now, covariances);
        let pass = Pass::of(&run.path, &now.noise, true);
        let smoothed = pass.smoothed(&run.path, &now.noise);
        let nx = self.start.p0.len();
        let begun = starts(&run.path, &smoothed.mean, &Layout::of(&run.path, &now.noise));
        let mut covariances = covariances.into_iter();
        let choice = found.iter().map(|cause| cause.choice).sum::<f64>() + now.occam;
        let choice = choice - self.log_prior(&now);
        let mut moved = vec![];
        // what is found is told
        let least = usize::from(found.len() == 1);
        let dealt_out = found.into_iter().flat_map(|cause| {
            let own: Vec<_> = covariances.by_ref().take(cause.parts.len()).collect();
            if !cause.is_all_parameters() {
                return vec![(cause, own)];
            }
            let (causes, others) = self.dealt_out((&cause, least), own, &now.theta);
            moved = others;
            causes
        });
        let causes = dealt_out.map(|(cause, own)| self.said(cause, &now.theta, own));
        let causes: Vec<NamedCause> = causes.collect();
        let said = |cause: Found| self.said(cause, &now.theta, vec![]);
        let suspected = if causes.is_empty() { first.sets } else { vec![] };
        Ok(Explanation {
            causes,
            moved,
            doubt,
            withdrawn: withdrawn.into_iter().map(said).collect(),
            nothing: first.nothing,
            suspected: suspected.into_iter().map(|set| self.fitted_laws(set)).collect(),
            numbers: now.unknowns(),
            log_likelihood: now.log_likelihood,
            choice,
            samples: self.observed() as usize,
            full: false,
            merit: f64::NEG_INFINITY,
            starts: begun.into_iter().map(|x| x[..nx].to_vec()).collect(),
            noise: now.noise,
        })
    }

    fn said(&self, cause: Found, theta: &[f64], covariances: Vec<DMatrix<f64>>) -> NamedCause {
        let parameter = match cause.place.0 {
            Site::Parameter(p) => {
                let variance = covariances.first().map_or(0.0, |own| own[(0, 0)]);
                Some((theta[p], (variance > 0.0).then(|| variance.sqrt())))
            }
            _ => None,
        };
        NamedCause {
            into: self.name(cause.place.0),
            of: cause.place.1.map(|e| self.model.plan.sources.entries[e].0.name.clone()),
            laws: self.placed(&cause.parts),
            covariances: if parameter.is_some() { vec![] } else { covariances },
            parameter,
            log_odds: cause.log_odds,
            probability: cause.law,
            place_probability: cause.at_place,
            others: cause.others,
            disguised: cause
                .disguised
                .into_iter()
                .map(|(part, p, chance)| (part, self.name(Site::Parameter(p)), chance))
                .collect(),
        }
    }
}
