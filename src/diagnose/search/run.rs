//! The search from end to end: chains with parameters held and free, laws without a name, the veto.

use std::ops::ControlFlow;
use std::sync::Arc;

use super::beam::{Fit, SetKey};
use super::chain::{ROUNDS, chain};
use super::fits::Wish;
use super::instead::{better_than_moved, instead_of_parameters};
use super::laws::{Asked, laws_of_places};
use super::nameless::nameless;
use super::selected::{screened, slots};
use super::study::Study;
use super::veto::vetoed;
use crate::candidates::candidate::Wire;
use crate::candidates::library::Allowed;
use crate::candidates::screen::Screen;
use crate::evidence::{NoiseModel, price};
use crate::fit::found::{Found, Instead, Off};
use crate::fit::nuisance::Nuisance;
use crate::fit::problem::{Added, Grain, Model, Part, Problem};
use crate::prepare::input_dependence::DEPENDS;
use crate::prepare::known_clipping::limited;
use crate::prepare::operating_range::Nominal;
use crate::watch::Watch;

/// Iterations of the model without causes, and of a model with parameters the other way.
const ITERATIONS: usize = 8;
/// Distance of the best with free parameters from the best within which these are searched too.
const NEAR: f64 = 10.0;
/// Part of what laws have gained after a first round that parameters alone have to gain for a first round,
/// too. It saves work only: the family is searched later where the other ends near it.
const RIVAL: f64 = 2.0 / 3.0;
/// Causes beside held parameters from which on wrong parameters are a rival.
const SEVERAL: usize = 3;
/// Sets whose parameters are let go or put back: so many within so much of the best.
const TOGGLED: (usize, f64) = (6, 5.0);
const POLISHED: f64 = 8.0;
/// Distance from the best within which fits are compared by the integrator's own steps, and iterations.
const SETTLED: (f64, usize) = (12.0, 8);

/// Whether a model, and what it leaves, are for another search; asked once a chain has named something and
/// what is left is coloured.
pub(crate) type BreaksOff<'a> = &'a dyn Fn(&Problem<'_>, &Nominal, &Model) -> bool;

/// What a search ended with: causes, whether parameters are free, and what moves beside causes.
pub(crate) struct Searched {
    pub found: Found,
    pub free: bool,
    pub nuisance: Nuisance,
}

/// Searches from a model of the baseline; `None` where it cannot be simulated.
pub(crate) fn search(
    problem: &mut Problem<'_>,
    nominal: &Nominal,
    allowed: &Allowed,
    most: usize,
    start: &Model,
    breaks_off: BreaksOff<'_>,
    watch: &dyn Watch,
) -> Option<Searched> {
    watch.report(0.0, "simulating the baseline");
    if let Some(y) = problem.simulate(start, Grain::Coarse) {
        problem.flag_spikes(&y);
    }
    let start = limited(problem, nominal, allowed, most, start.clone(), watch);
    problem.recorrect(&start);
    let y = problem.simulate(&start, Grain::Coarse)?;
    problem.rescale(&y);
    let mut study = Study::new(problem, nominal, allowed, most, watch);
    empty(&mut study, &start, &y);
    let first = study.beam.best_of(false)?.clone();
    study.stand_on(&first.model);
    let mut screen = None;
    if most > 0 {
        watch.report(0.05, "screening candidates");
        chain(&mut study, false, 0..1);
        screen = screened(&study, &first);
        if families(&mut study, breaks_off).is_continue() {
            and_nameless(&mut study);
        }
    }
    watch.report(0.95, "checking what was named");
    study.settle(SETTLED.0, SETTLED.1);
    while better_than_moved(&mut study) {
        searched(&mut study, true, 1);
        study.settle(SETTLED.0, SETTLED.1);
    }
    concluded(study, screen)
}

/// Laws without a name; and on from what those are read as.
fn and_nameless(study: &mut Study<'_, '_>) {
    let before = study.beam.best().map(Fit::key);
    nameless(study);
    let named = |fit: &&Fit| !fit.model.added.iter().any(|added| added.cause.is_drawn());
    let now = study.beam.best().filter(named).map(Fit::key);
    if let Some(key) = now.filter(|key| before.as_ref() != Some(key)) {
        searched(study, key.free, 1);
    }
}

/// The model without causes, parameters held and free.
fn empty(study: &mut Study<'_, '_>, start: &Model, y: &Arc<Vec<Vec<f64>>>) {
    let noise = study.disturbance.white(&study.problem.residual(y, Part::Fit));
    let wish = [Wish { model: start.clone(), noise }];
    study.fit_and_keep(false, &wish, ITERATIONS);
    if !study.free.free.is_empty() {
        study.fit_and_keep(true, &wish, ITERATIONS);
    }
    study.polish(POLISHED);
}

/// Whether letting all parameters move is more probable than what is known with parameters held.
fn is_behind(study: &Study<'_, '_>) -> bool {
    let best = |free: bool| study.beam.best_of(free).map(Fit::posterior);
    best(true).zip(best(false)).is_some_and(|(free, held)| free > held)
}

/// The chains with parameters held and free, the more probable family first: where parameters are
/// wrong, laws that stand in for them would be searched in vain. Breaks where what is left is for another
/// search.
fn families(study: &mut Study<'_, '_>, breaks_off: BreaksOff<'_>) -> ControlFlow<()> {
    if study.free.free.is_empty() {
        searched(study, false, 1);
        return asked(study, breaks_off);
    }
    let is_open = is_open(study);
    if is_open {
        stand_on_best(study, true, "letting parameters move");
        chain(study, true, 0..1);
    }
    if is_behind(study) {
        free_chain(study, usize::from(is_open));
        asked(study, breaks_off)?;
        stand_on_best(study, false, "holding parameters");
        // a law that stands beside what was found with parameters free may do without them
        chain(study, false, 0..2);
        let best = |free: bool| study.beam.best_of(free).map(Fit::posterior);
        let near = best(false).zip(best(true)).is_some_and(|(held, free)| held > free - NEAR);
        if near || leaves_more_than_noise(study) {
            searched(study, false, 1);
            toggle(study);
        }
        return ControlFlow::Continue(());
    }
    if is_open {
        // the library and its columns are those of the other family
        stand_on_best(study, false, "holding parameters");
        if let Some(best) = study.beam.best_of(false).cloned() {
            study.look_up(&best);
        }
        study.items.clear();
    }
    searched(study, false, 1);
    asked(study, breaks_off)?;
    toggle(study);
    if let (Some(held), Some(free)) = (study.beam.best_of(false), study.beam.best_of(true)) {
        let near = free.posterior() > held.posterior() - NEAR;
        let many = held.causes() >= SEVERAL;
        let model = if near { &free.model } else { &held.model };
        if many || near || study.dependence(model) > DEPENDS {
            free_chain(study, 0);
        }
    }
    ControlFlow::Continue(())
}

/// Whether to go on after a chain.
fn asked(study: &Study<'_, '_>, breaks_off: BreaksOff<'_>) -> ControlFlow<()> {
    if study.watch.stopped() {
        return ControlFlow::Continue(());
    }
    match study.beam.best().filter(|best| best.causes() > 0 && best.noise.is_coloured()) {
        Some(best) if breaks_off(study.problem, study.nominal, &best.model) => {
            ControlFlow::Break(())
        }
        _ => ControlFlow::Continue(()),
    }
}

/// Whether the family with parameters free is still a rival after a first round of the other: that leaves
/// more than white noise, and free parameters come nearly as far without any law.
fn is_open(study: &Study<'_, '_>) -> bool {
    let none = |free: bool| study.beam.get(&SetKey::new(free, std::iter::empty()));
    let (Some(best), Some(held), Some(free)) = (study.beam.best(), none(false), none(true)) else {
        return false;
    };
    let gained = |fit: &Fit| fit.posterior() - held.posterior();
    !best.free && best.noise.is_coloured() && gained(free) > RIVAL * gained(best)
}

/// Whether what the best leaves depends on the inputs.
fn leaves_more_than_noise(study: &Study<'_, '_>) -> bool {
    study.beam.best().is_some_and(|best| study.dependence(&best.model) > DEPENDS)
}

/// The chain with parameters free, from a round on.
fn free_chain(study: &mut Study<'_, '_>, from: usize) {
    if study.watch.stopped() {
        return;
    }
    stand_on_best(study, true, "letting parameters move");
    searched(study, true, from);
    toggle(study);
}

/// Goes on from the best of a family.
fn stand_on_best(study: &mut Study<'_, '_>, free: bool, what: &str) {
    study.watch.report(0.5, what);
    if let Some(model) = study.beam.best_of(free).map(|fit| fit.model.clone()) {
        study.stand_on(&model);
    }
}

/// A chain, and on from what its places are asked to be, until that is nothing better.
fn searched(study: &mut Study<'_, '_>, free: bool, from: usize) {
    let (mut asked, mut from) = (Asked::new(), from);
    loop {
        chain(study, free, from..ROUNDS);
        let before = study.beam.best_of(free).map(Fit::key);
        let any = laws_of_places(study, free, &mut asked);
        study.polish(POLISHED);
        if !any || study.beam.best_of(free).map(Fit::key) == before {
            return;
        }
        from = 1;
    }
}

/// The leading sets with their parameters the other way.
fn toggle(study: &mut Study<'_, '_>) {
    let mut wishes: [Vec<Wish>; 2] = [vec![], vec![]];
    for fit in study.beam.within(TOGGLED.1) {
        let mut model = fit.model.clone();
        match fit.free {
            false => model.added.retain(|a| !matches!(a.cause.wire, Wire::Parameter(_))),
            true => model.theta = study.problem.base.signals.theta(),
        }
        let other = Fit { model: model.clone(), free: !fit.free, ..fit.clone() };
        let count = wishes[0].len() + wishes[1].len();
        if study.beam.get(&other.key()).is_none() && count < TOGGLED.0 {
            wishes[usize::from(other.free)].push(Wish { model, noise: fit.noise.clone() });
        }
    }
    for (free, wishes) in [(false, &wishes[0]), (true, &wishes[1])] {
        study.fit_and_keep(free, wishes, ITERATIONS);
    }
    study.polish(POLISHED);
}

/// The headline after the veto, with its look-alikes.
fn concluded(mut study: Study<'_, '_>, first: Option<Screen>) -> Option<Searched> {
    study.concludes = true;
    let (headline, withdrawn) = vetoed(&mut study)?;
    let nothing = study.beam.probability(Fit::is_nothing);
    let instead = instead_of_parameters(&mut study, &headline);
    let found = Found {
        slots: slots(study.problem, &study.beam, &headline),
        model: headline.model.clone(),
        choice: price(&headline.model, headline.free, study.choices),
        first,
        left_out: study.left_out,
        spikes: study.problem.spikes(),
        full: headline.causes() >= study.most && study.most > 0,
        nothing,
        suspected: vec![],
        off: off(&study, instead),
        withdrawn,
        refuted: vec![],
    };
    let nuisance = study.nuisance(headline.free).clone();
    Some(Searched { found, free: headline.free, nuisance })
}

/// How probable it is that parameters are off: all of them, or one alone.
fn off(study: &Study<'_, '_>, instead: Vec<Instead>) -> Off {
    let has = |fit: &Fit, p: usize| {
        let is_it = |added: &Added| matches!(added.cause.wire, Wire::Parameter(q) if q == p);
        !fit.free && fit.model.added.iter().any(is_it)
    };
    let parameters = 0..study.problem.base.signals.parameters.len();
    Off {
        all: study.beam.probability(|fit| fit.free),
        single: parameters.map(|p| study.beam.probability(|fit| has(fit, p))).collect(),
        instead,
    }
}

#[cfg(test)]
#[path = "run_tests.rs"]
mod tests;
