//! The search on both tracks: parameters trusted, parameters free; and which to believe.

use std::sync::Arc;

use super::believe::WINS;
use super::candidate::Wire;
use super::dependence::{DEPENDS, dependence};
use super::finding::{Moved, Track};
use super::finished::{Finished, moved_together};
use super::found::{Found, Slot};
use super::library::{Allowed, Method};
use super::nominal::Nominal;
use super::nuisance::Nuisance;
use super::posterior::{self, Searched};
use super::precision::Precision;
use super::problem::{Grain, Model, Part, Problem};
use super::refit::{Fitted, MANY, Refit, refit};
use super::search::Search;
use crate::watch::Watch;

/// Score at which moved parameters that leave nothing beat a single cause.
const ENOUGH: f64 = 1.0;
/// Causes from which on the free track is searched from its own beginning.
const SEVERAL: usize = 3;
/// Moved parameters, at most, that may stand in for a cause.
const FEW: usize = 2;
/// Share of the mean square left at which wrong parameters are no suspects any more.
const SOLVED: f64 = 0.01;
/// Score from which on a residual is not white.
const COLOURED: f64 = 10.0;

/// What both tracks share.
pub(crate) struct Tracks<'a, 'b> {
    pub problem: &'a mut Problem<'b>,
    pub nominal: &'a Nominal,
    /// Where both begin.
    pub start: &'a Model,
    pub allowed: &'a Allowed,
    pub most: usize,
    pub watch: &'a dyn Watch,
}

impl<'a, 'b> Tracks<'a, 'b> {
    /// Searches both tracks; the chosen one comes first.
    pub fn run(mut self) -> Option<(Finished, Option<Finished>)> {
        if self.allowed.method == Method::Posterior {
            return self.by_posterior();
        }
        let (chosen, other) = self.both()?;
        let chosen = self.off_the_ridge(chosen)?;
        Some((self.doubting(chosen), other))
    }

    /// The search by posterior probabilities.
    fn by_posterior(mut self) -> Option<(Finished, Option<Finished>)> {
        let (nominal, allowed, most, watch) = (self.nominal, self.allowed, self.most, self.watch);
        let Searched { found, free, nuisance } =
            posterior::search(self.problem, nominal, allowed, most, self.start, watch)?;
        let track = if free { Track::ParametersFree } else { Track::ParametersTrusted };
        let chosen = self.finish(track, found, nuisance)?;
        let chosen = self.off_the_ridge(chosen)?;
        Some((self.doubting(chosen), None))
    }

    fn both(&mut self) -> Option<(Finished, Option<Finished>)> {
        let start = self.start;
        let held = Nuisance::new(self.problem, self.nominal);
        let free = held.clone().with_parameters(self.problem, &self.allowed.fixed);
        let moved = (!free.free.is_empty()).then(|| self.moved_alone(&free)).flatten();
        let rival = moved.as_ref().map(|(_, y)| {
            // where nothing is left that depends on the inputs, moved parameters are enough
            let enough = dependence(self.problem, self.nominal, y) < DEPENDS;
            (y.clone(), if enough { ENOUGH } else { WINS })
        });
        let mut found = self.search(held.clone(), start, (0.0, 0.6), rival)?;
        if let (true, Some((moved, _))) = (found.given_up, &moved) {
            // many parameters are wrong: a list of causes is no way to say so
            let on_free = self.search(free.clone(), moved, (0.2, 0.95), None);
            let on_free = on_free.and_then(|f| self.finish(Track::ParametersFree, f, free));
            let is_enough = |of: &Finished| of.dependence < DEPENDS && !of.found.full;
            // a few that moved beside a cause may stand in for a second one
            let few = |of: &Finished| !of.found_nothing() && of.moved.len() <= FEW;
            let is_told = |of: &Finished| of.found_nothing() || !of.found.named().is_empty();
            let alone = |of: &Finished| {
                is_enough(of) && is_told(of) && !few(of) && self.colour(&of.y) < COLOURED
            };
            let enough = self.watch.stopped() || on_free.as_ref().is_some_and(alone);
            let begun = on_free.as_ref().map_or(vec![], |free| free.found.named());
            let settled = self.watch.stopped() || begun.is_empty();
            if !enough || on_free.is_none() {
                found = self.search(held.clone(), start, (0.6, 0.95), None)?;
            } else if !settled {
                // beside what is named, a few laws may leave as little as parameters that moved
                let mut search = self.begin(held.clone(), self.most.min(begun.len() + FEW));
                (search.share, search.begun) = ((0.6, 0.95), begun);
                let first = (found.first, found.dependence);
                found = search.run(start.clone())?;
                (found.first, found.dependence) = first;
            }
            let trusted = self.finish(Track::ParametersTrusted, found, held)?;
            return Some(match on_free {
                Some(free) if enough && settled => (free, Some(trusted)),
                Some(free) => self.chosen(trusted, free),
                None => (trusted, None),
            });
        }
        let settled = found.slots.len() < SEVERAL && !found.full;
        let trusted = self.finish(Track::ParametersTrusted, found, held)?;
        if self.watch.stopped() || free.free.is_empty() {
            return Some((trusted, None));
        }
        let baseline = self.problem.simulate(start, Grain::Fine);
        let left = baseline.map_or(1.0, |y| {
            let mean_square = |y: &[Vec<f64>]| self.problem.mean_square(y, Part::Choose);
            mean_square(&trusted.y) / mean_square(&y).max(f64::MIN_POSITIVE)
        });
        // nothing named, and yet what is left is not white: parameters that were fitted to
        // make up for a cause may hide it while they are held
        let hidden = trusted.found_nothing() && self.colour(&trusted.y) > COLOURED;
        // a curve is the last resort: whether moved parameters make it superfluous is asked first
        let drawn = trusted.is_drawn();
        let explained = settled && trusted.dependence < DEPENDS && !hidden || left < SOLVED;
        let clean = explained && !drawn;
        let on_free = if clean {
            self.carried_over(&free, start, &trusted)
        } else {
            let mut search = self.begin(free.clone(), self.most);
            search.share = (0.6, 0.95);
            search.told = (trusted.structural() > 0 && !drawn).then(|| trusted.y.clone());
            let found = search.run(start.clone());
            found.and_then(|found| self.finish(Track::ParametersFree, found, free.clone()))
        };
        let simpler = (clean && trusted.structural() > 1).then_some(moved).flatten();
        let simpler = simpler.and_then(|(moved, _)| self.one_cause(&free, &moved));
        let on_free = match (simpler, on_free) {
            (Some(one), Some(many)) => {
                Some(if self.evidence(&many, &one) > 0.0 { one } else { many })
            }
            (_, on_free) => on_free,
        };
        match on_free {
            Some(free) => Some(self.chosen(trusted, free)),
            None => Some((trusted, None)),
        }
    }

    /// The baseline with its parameters moved and no cause, and its outputs.
    fn moved_alone(&self, free: &Nuisance) -> Option<(Model, Arc<Vec<Vec<f64>>>)> {
        let model = std::slice::from_ref(self.start);
        let model = refit(self.problem, free, model, Refit::search()).swap_remove(0)?.model;
        let y = self.problem.simulate(&model, Grain::Coarse)?;
        Some((model, y))
    }

    /// The search from moved parameters for a single cause beside them, if that leaves nothing.
    fn one_cause(&mut self, free: &Nuisance, moved: &Model) -> Option<Finished> {
        let mut search = self.begin(free.clone(), 1);
        search.share = (0.9, 0.95);
        let found = search.run(moved.clone())?;
        let finished = self.finish(Track::ParametersFree, found, free.clone())?;
        (finished.dependence < DEPENDS).then_some(finished)
    }

    fn begin(&mut self, nuisance: Nuisance, most: usize) -> Search<'_, 'b> {
        let Self { nominal, allowed, watch, .. } = *self;
        Search::new(self.problem, nominal, nuisance, allowed, most, watch)
    }

    fn search(
        &mut self,
        nuisance: Nuisance,
        start: &Model,
        share: (f64, f64),
        rival: Option<(Arc<Vec<Vec<f64>>>, f64)>,
    ) -> Option<Found> {
        let mut search = self.begin(nuisance, self.most);
        (search.share, search.rival) = (share, rival);
        search.run(start.clone())
    }

    /// The trusted track's causes with parameters free, less those that are not needed any
    /// more: cheap, where the trusted track left nothing.
    fn carried_over(
        &mut self,
        free: &Nuisance,
        start: &Model,
        trusted: &Finished,
    ) -> Option<Finished> {
        self.watch.tell(0.9, "letting parameters move");
        let mut model = start.clone();
        model.added = trusted.fitted.model.added.clone();
        let mut slots: Vec<Slot> = trusted.found.slots.clone();
        for i in (0..model.added.len()).rev() {
            if matches!(model.added[i].cause.wire, Wire::Parameter(_)) {
                model.added.remove(i);
                slots.remove(i);
            }
        }
        let mut search = self.begin(free.clone(), self.most);
        model = search.fitted(model);
        search.prune_all(&mut model, &mut slots);
        let spikes = self.problem.spikes();
        let found = Found {
            model,
            slots,
            first: None,
            last: None,
            dependence: trusted.found.dependence,
            spikes,
            full: false,
            given_up: false,
            posterior: None,
        };
        let finished = self.finish(Track::ParametersFree, found, free.clone())?;
        if finished.moved.is_empty() {
            return Some(finished);
        }
        // while parameters are held, a richer shape may make up for them
        let mut found = finished.found;
        let mut search = self.begin(free.clone(), self.most);
        search.settle(&mut found.model, &mut found.slots);
        if found.model.same_causes(&finished.fitted.model) {
            // fitted before: to all data, and to the end
            found.model = finished.fitted.model;
        }
        self.finish(Track::ParametersFree, found, free.clone())
    }

    /// A model fitted to all data, and its outputs.
    fn fitted_to_all(
        &self,
        nuisance: &Nuisance,
        model: &Model,
    ) -> Option<(Fitted, Arc<Vec<Vec<f64>>>)> {
        let model = std::slice::from_ref(model);
        let fitted = refit(self.problem, nuisance, model, Refit::last()).swap_remove(0)?;
        let y = self.problem.simulate(&fitted.model, Grain::Fine)?;
        Some((fitted, y))
    }

    /// The final fit on all data.
    pub fn finish(
        &mut self,
        track: Track,
        mut found: Found,
        nuisance: Nuisance,
    ) -> Option<Finished> {
        let mut fitted_to_all = self.fitted_to_all(&nuisance, &found.model);
        // what diverges with all steps, or on all data, explains nothing: the last cause first
        while fitted_to_all.is_none() && found.model.added.len() > found.model.known() {
            found.model.added.pop();
            found.slots.pop();
            fitted_to_all = self.fitted_to_all(&nuisance, &found.model);
        }
        let (mut fitted, mut y) = fitted_to_all?;
        if nuisance.segments >= MANY {
            // the end of a stretch that was not fitted yet may be far off, and no fault of the data
            self.problem.flag_spikes(&y);
            let spikes = self.problem.spikes();
            if spikes != found.spikes {
                (fitted, y) = self.fitted_to_all(&nuisance, &fitted.model)?;
                found.spikes = spikes;
            }
        }
        let precision = Precision::new(self.problem, &nuisance, &fitted);
        let moved_together = moved_together(&nuisance, &fitted, precision.as_ref());
        let dependence = dependence(self.problem, self.nominal, &y);
        let mut finished = Finished {
            track,
            found,
            fitted,
            nuisance,
            precision,
            moved: vec![],
            moved_together,
            y,
            dependence,
            inside: None,
        };
        let mut moved = finished.went(&self.problem.base.signals);
        moved.retain(Moved::is_far);
        finished.moved = moved;
        Some(finished)
    }
}

#[cfg(test)]
#[path = "track_tests.rs"]
mod tests;
