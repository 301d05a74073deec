//! The search on both tracks: parameters trusted, parameters free; and which to believe.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::accept::DOUBLY_STRONG;
use super::candidate::Wire;
use super::dependence::{DEPENDS, dependence};
use super::finding::{Moved, Track};
use super::library::Allowed;
use super::nominal::Nominal;
use super::nuisance::{Fitted, Key, Nuisance, Refit, refit};
use super::precision::{covariance, standard_error};
use super::problem::{Grain, Model, Part, Problem};
use super::search::{Found, Search, Slot};
use crate::statistics::whiteness;
use crate::watch::Watch;

/// Standard errors beyond which a parameter counts as moved.
const MOVED: f64 = 3.0;
/// Score at which one track wins whatever it needs.
const WINS: f64 = 4.0;
/// Score at which moved parameters that leave nothing beat a single cause.
const ENOUGH: f64 = 1.0;
/// Causes from which on the free track is searched from its own beginning.
const MANY: usize = 3;
/// Share of the mean square left at which wrong parameters are no suspects any more.
const SOLVED: f64 = 0.01;
/// Share of the distance from white that is left where free parameters made way for a cause.
const WHITER: f64 = 0.5;
/// Score from which on a residual is not white.
const COLOURED: f64 = 10.0;

/// One track, finished.
pub(crate) struct Finished {
    pub track: Track,
    pub found: Found,
    /// The final fit on all data, with fine steps.
    pub fitted: Fitted,
    pub nuisance: Nuisance,
    pub covariance: Option<DMatrix<f64>>,
    pub moved: Vec<Moved>,
    /// Whether parameters moved along a ridge, where none of them has to.
    pub moved_together: bool,
    /// Outputs of the final fit over all data.
    pub y: Arc<Vec<Vec<f64>>>,
    /// Score that what is left depends on the inputs.
    pub dependence: f64,
}

/// Whether the free parameters, all together, are further from where they began than their
/// errors allow: along a ridge none of them alone may be.
fn moved_together(nuisance: &Nuisance, fitted: &Fitted, covariance: Option<&DMatrix<f64>>) -> bool {
    let places: Vec<(usize, f64)> = nuisance
        .free
        .iter()
        .filter_map(|&(p, from)| {
            let at = fitted.keys.iter().position(|key| *key == Key::Theta(p))?;
            Some((at, fitted.model.theta[p] - from))
        })
        .collect();
    let (Some(all), false) = (covariance, places.is_empty()) else { return false };
    let own = DMatrix::from_fn(places.len(), places.len(), |i, j| all[(places[i].0, places[j].0)]);
    let off = DVector::from_iterator(places.len(), places.iter().map(|p| p.1));
    // in units of each parameter's error, so that the decomposition is well scaled
    let errors = own.diagonal().map(f64::sqrt);
    let scaled =
        DMatrix::from_fn(places.len(), places.len(), |i, j| own[(i, j)] / (errors[i] * errors[j]));
    let off = off.component_div(&errors);
    scaled.cholesky().is_some_and(|c| off.dot(&c.solve(&off)) > MOVED.powi(2) * places.len() as f64)
}

impl Finished {
    /// Whether no cause was found but what was known before: limits of the instruments.
    fn found_nothing(&self) -> bool {
        self.fitted.model.added.len() == self.fitted.model.known()
    }

    /// How much it takes: causes plus parameters moved.
    fn price(&self) -> usize {
        let causes = self.fitted.model.added.iter();
        let causes: usize = causes.map(|added| added.cause.price()).sum();
        causes + self.moved.len().max(usize::from(self.moved_together))
    }
}

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

impl Tracks<'_, '_> {
    /// Searches both tracks; the chosen one comes first.
    pub fn run(mut self) -> Option<(Finished, Option<Finished>)> {
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
        if let (true, Some((moved, _))) = (found.given_up, moved) {
            // many parameters are wrong: a list of causes is no way to say so
            let on_free = self.search(free.clone(), &moved, (0.2, 0.95), None);
            let on_free = on_free.and_then(|f| self.finish(Track::ParametersFree, f, free));
            let is_enough = |of: &Finished| of.dependence < DEPENDS && !of.found.full;
            let enough = self.watch.stopped() || on_free.as_ref().is_some_and(is_enough);
            if !enough || on_free.is_none() {
                found = self.search(held.clone(), start, (0.6, 0.95), None)?;
            }
            let trusted = self.finish(Track::ParametersTrusted, found, held)?;
            return Some(match on_free {
                Some(free) if enough => (free, Some(trusted)),
                Some(free) => self.chosen(trusted, free),
                None => (trusted, None),
            });
        }
        let settled = found.slots.len() < MANY && !found.full;
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
        let drawn = trusted.fitted.model.added.iter().any(|added| added.cause.is_drawn());
        let explained = settled && trusted.dependence < DEPENDS && !hidden || left < SOLVED;
        let clean = explained && !drawn;
        let found = if clean {
            self.carried_over(&free, start, &trusted)
        } else {
            self.search(free.clone(), start, (0.6, 0.95), None)
        };
        let free = found.and_then(|found| self.finish(Track::ParametersFree, found, free));
        match free {
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

    /// The track to believe, and the other one.
    fn chosen(&self, trusted: Finished, free: Finished) -> (Finished, Option<Finished>) {
        let better = self.problem.better(&trusted.y, &free.y, Part::Choose);
        let whiter = trusted.found_nothing()
            && !free.found_nothing()
            && self.colour(&free.y) < WHITER * self.colour(&trusted.y);
        // causes that are only seen where parameters move, and that leave little
        let left = |of: &Finished| self.problem.mean_square(&of.y, Part::All);
        let strong = trusted.found_nothing()
            && !free.found_nothing()
            && left(&free) < DOUBLY_STRONG * left(&trusted);
        let take_free = match better {
            b if b > WINS || whiter || strong => true,
            b if b < -WINS => false,
            _ => free.price() < trusted.price(),
        };
        if take_free { (free, Some(trusted)) } else { (trusted, Some(free)) }
    }

    /// How far the residual is from white, as a normal score.
    fn colour(&self, y: &[Vec<f64>]) -> f64 {
        let r = self.problem.residual(y, Part::All);
        r.chunks(r.len() / self.problem.y.len()).map(whiteness).fold(0.0, f64::max)
    }

    fn search(
        &mut self,
        nuisance: Nuisance,
        start: &Model,
        share: (f64, f64),
        rival: Option<(Arc<Vec<Vec<f64>>>, f64)>,
    ) -> Option<Found> {
        let (allowed, most, watch) = (self.allowed, self.most, self.watch);
        let mut search = Search::new(self.problem, self.nominal, nuisance, allowed, most, watch);
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
    ) -> Option<Found> {
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
        let (allowed, most, watch) = (self.allowed, self.most, self.watch);
        let mut search =
            Search::new(self.problem, self.nominal, free.clone(), allowed, most, watch);
        model = search.fitted(model);
        search.prune_all(&mut model, &mut slots);
        let spikes = self.problem.spikes();
        Some(Found {
            model,
            slots,
            first: None,
            last: None,
            dependence: trusted.found.dependence,
            spikes,
            full: false,
            given_up: false,
        })
    }

    /// The final fit on all data.
    pub fn finish(&mut self, track: Track, found: Found, nuisance: Nuisance) -> Option<Finished> {
        let fitted =
            refit(self.problem, &nuisance, std::slice::from_ref(&found.model), Refit::last())
                .swap_remove(0)?;
        let y = self.problem.simulate(&fitted.model, Grain::Fine)?;
        let covariance = covariance(self.problem, &nuisance, &fitted);
        let moved = nuisance
            .free
            .iter()
            .filter_map(|&(p, from)| {
                let to = fitted.model.theta[p];
                let error = standard_error(&fitted, covariance.as_ref(), Key::Theta(p));
                let far = error.is_some_and(|e| (to - from).abs() > MOVED * e);
                let name = self.problem.base.signals.parameters[p].name.clone();
                far.then_some(Moved { name, from, to, std_error: error })
            })
            .collect();
        let moved_together = moved_together(&nuisance, &fitted, covariance.as_ref());
        let dependence = dependence(self.problem, self.nominal, &y);
        Some(Finished {
            track,
            found,
            fitted,
            nuisance,
            covariance,
            moved,
            moved_together,
            y,
            dependence,
        })
    }
}
