//! A search from its start to the final fit on all data.

use std::sync::Arc;

use super::candidates::library::Allowed;
use super::fit::covariance::Precision;
use super::fit::efficient::efficient;
use super::fit::finished::{Finished, moved_along_ridge};
use super::fit::found::Found;
use super::fit::hypothesis::{Moved, Track};
use super::fit::nuisance::Nuisance;
use super::fit::problem::{Grain, Model, Problem};
use super::fit::refit::{Fitted, MANY, Refit, Stop, refit_until};
use super::prepare::input_dependence::dependence;
use super::prepare::operating_range::Nominal;
use super::search::{self, BreaksOff, Searched};
use crate::watch::Watch;

/// What a search is made of.
pub(crate) struct Tracks<'a, 'b> {
    pub problem: &'a mut Problem<'b>,
    pub nominal: &'a Nominal,
    /// Where it begins.
    pub start: &'a Model,
    pub allowed: &'a Allowed,
    pub most: usize,
    pub breaks_off: BreaksOff<'a>,
    pub watch: &'a dyn Watch,
}

impl<'a, 'b> Tracks<'a, 'b> {
    /// Searches, and fits what was found to all data.
    pub fn run(mut self) -> Option<Finished> {
        let Self { nominal, start, allowed, most, breaks_off, watch, .. } = self;
        let Searched { found, free, nuisance } =
            search::search(self.problem, nominal, allowed, most, start, breaks_off, watch)?;
        let track = if free { Track::ParametersFree } else { Track::ParametersTrusted };
        let chosen = self.finish(track, found, nuisance)?;
        if watch.stopped() {
            return Some(chosen);
        }
        let chosen = self.off_the_ridge(chosen)?;
        let undetermined = self.undetermined(&chosen);
        Some(self.doubting(Finished { undetermined, ..chosen }))
    }

    /// A model fitted to all data, and its outputs.
    fn fitted_to_all(
        &self,
        nuisance: &Nuisance,
        model: &Model,
    ) -> Option<(Fitted, Arc<Vec<Vec<f64>>>)> {
        let model = std::slice::from_ref(model);
        let asked = || self.watch.stopped();
        let stop = Stop::Keep(&asked);
        let fitted =
            refit_until(self.problem, nuisance, model, Refit::last(), stop).swap_remove(0)?;
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
        let mut precision = Precision::new(self.problem, &nuisance, &fitted);
        let mut by = None;
        let stop = || self.watch.stopped();
        let errors = precision.as_ref();
        if let Some(again) =
            errors.and_then(|e| efficient(self.problem, &nuisance, &fitted, e, &stop))
        {
            (fitted, y, precision) = (again.fitted, again.y, Some(again.precision));
            by = Some(again.by);
        }
        let moved_along_ridge = moved_along_ridge(&nuisance, &fitted, precision.as_ref());
        let dependence = dependence(self.problem, self.nominal, &y);
        let mut finished = Finished {
            track,
            found,
            fitted,
            nuisance,
            precision,
            by,
            moved: vec![],
            moved_along_ridge,
            y,
            dependence,
            undetermined: vec![],
            inside: None,
            doubt: 0.0,
        };
        let mut moved = finished.went(&self.problem.base.signals);
        moved.retain(Moved::is_far);
        finished.moved = moved;
        Some(finished)
    }
}

#[cfg(test)]
#[path = "final_fit_tests.rs"]
mod tests;
