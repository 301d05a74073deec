//! Laws without a name where named ones leave something: free curves of one coordinate, then learned
//! laws of two. They are fits like any other; their prior says that a name is more probable.

use std::sync::Arc;

use super::beam::Fit;
use super::fits::Wish;
use super::laws::read_as_laws;
use super::starts;
use super::study::Study;
use crate::candidates::candidate::Candidate;
use crate::candidates::free_curve::{self, Drawing};
use crate::candidates::free_surface;
use crate::candidates::library::{Allowed, library};
use crate::candidates::network_start::start;
use crate::findings::formula::read;
use crate::fit::problem::Grain;
use crate::prepare::input_dependence::DEPENDS;
use crate::statistics::is_white;

/// Curves that are fitted, and their sizes as shares of what is foretold.
const CURVES: usize = 4;
const SIZES: [f64; 2] = [1.0, 0.4];
/// Curves that are read as laws.
const READ: usize = 2;
/// Learned laws that are tried, seeds of their first weights, iterations of a first look and of a fit.
const LEARNED: usize = 3;
const SEEDS: [u64; 2] = [1, 2];
const FIRST: usize = 4;
const ITERATIONS: usize = 12;
/// Share of what is left that a law must predict where it was not fitted, to be fitted at all.
const WORTH: f64 = 0.02;

/// Fits laws without a name on top of the best model and in the place of all that it names.
pub(super) fn nameless(study: &mut Study<'_, '_>) {
    let Some(best) = study.beam.best().cloned() else { return };
    let asked = |name: &str| study.allowed.only.iter().any(|only| only == name);
    let (curve, law) = (asked(free_curve::NAME), asked(free_surface::NAME));
    if study.most == 0 || study.watch.stopped() {
        return;
    }
    let hidden = |study: &Study<'_, '_>, best: &Fit| {
        let left = best.noise.whiten(&best.residual);
        let n = (left.len() / study.problem.y.len().max(1)).max(1);
        left.chunks(n).any(|r| !is_white(r))
            || study.dependence(&best.model) > DEPENDS
            || best.noise.remembers() && study.unforeseen(best) > DEPENDS
    };
    if curve || hidden(study, &best) {
        study.watch.report(0.9, "drawing free curves");
        for base in bases(study, &best) {
            curves(study, &base, best.posterior());
        }
    }
    let Some(best) = study.beam.best().cloned() else { return };
    if (law || hidden(study, &best)) && study.allowed.effect(free_surface::NAME) {
        study.watch.report(0.93, "learning a law");
        for base in bases(study, &best) {
            learned(study, &base);
        }
    }
}

/// The best model, and the one without causes.
fn bases(study: &Study<'_, '_>, best: &Fit) -> Vec<Fit> {
    let mut bases = vec![];
    if best.causes() < study.most {
        bases.push(best.clone());
    }
    let empty = study.beam.fits().filter(|fit| fit.free == best.free && fit.causes() == 0);
    bases.extend(empty.filter(|_| best.causes() > 0).cloned());
    bases
}

fn drawing<'s>(study: &'s Study<'_, '_>, base: &Fit) -> Drawing<'s, 's> {
    let nuisance = study.nuisance(base.free);
    Drawing { problem: study.problem, nominal: study.nominal, nuisance, watch: study.watch }
}

/// Free curves beside a model, and the laws that the leading ones are read as; fits that are hopelessly
/// below `top` are let go.
fn curves(study: &mut Study<'_, '_>, base: &Fit, top: f64) {
    let Some(y) = study.problem.simulate(&base.model, Grain::Coarse) else { return };
    let mut sketches = drawing(study, base).sketches(&base.model, &y);
    // beside a law of the same coordinate neither would have a size of its own
    let is_free = |of: &Candidate| {
        !base.model.added.iter().any(|a| a.cause.into == of.into && a.cause.of == of.of)
    };
    sketches.retain(|sketch| sketch.share > WORTH && is_free(&sketch.cause));
    sketches.truncate(CURVES);
    let begun = sketches.iter().flat_map(|sketch| SIZES.map(|size| (sketch, size)));
    let wish = |(sketch, size): (&free_curve::Sketch, f64)| {
        let values = sketch.values.iter().map(|v| size * v).collect();
        Wish { model: base.model.with(&sketch.cause, values), noise: base.noise.clone() }
    };
    let wishes: Vec<Wish> = begun.map(wish).collect();
    let mut fits = study.fit(base.free, &wishes, ITERATIONS);
    fits.sort_by(|a, b| b.posterior().total_cmp(&a.posterior()));
    for fit in fits.iter().take(READ) {
        read_as_laws(study, fit, top);
    }
    if study.allowed.effect(free_curve::NAME) {
        fits.into_iter().for_each(|fit| {
            study.beam.keep(fit);
        });
    }
}

fn learned(study: &mut Study<'_, '_>, base: &Fit) {
    let Some(y) = study.problem.simulate(&base.model, Grain::Coarse) else { return };
    let (mut surfaces, _) = drawing(study, base).surfaces(&base.model, &y);
    surfaces.retain(|surface| surface.share > WORTH);
    surfaces.truncate(LEARNED);
    let first = |surface: &free_surface::Surface, seed: u64| {
        let values = start(surface, study.nominal, seed)?;
        let model = base.model.with(&surface.cause, values);
        Some(Wish { model, noise: base.noise.clone() })
    };
    // a few iterations show which place it is; the best is fitted to the end, from elsewhere too
    let looked: Vec<(usize, Fit)> = surfaces
        .iter()
        .enumerate()
        .filter_map(|(i, surface)| {
            let wish = first(surface, SEEDS[0])?;
            Some((i, study.fit(base.free, &[wish], FIRST).into_iter().next()?))
        })
        .collect();
    let best = looked.into_iter().max_by(|a, b| a.1.posterior().total_cmp(&b.1.posterior()));
    let Some((at, fit)) = best else { return };
    let mut wishes = vec![Wish { model: fit.model, noise: fit.noise }];
    wishes.extend(first(&surfaces[at], SEEDS[1]));
    let fits = study.fit(base.free, &wishes, ITERATIONS);
    let best = fits.into_iter().max_by(|a, b| a.posterior().total_cmp(&b.posterior()));
    let Some(best) = best else { return };
    by_its_name(study, base, &best);
    study.beam.keep(best);
}

/// Fits the shape of the library that a learned law looks like.
fn by_its_name(study: &mut Study<'_, '_>, base: &Fit, learned: &Fit) {
    let Some(index) = learned.model.added.len().checked_sub(1) else { return };
    let Some(reading) = read(study.problem, &learned.model, index) else { return };
    let Some((effect, of)) = reading.is_shape() else { return };
    let into = &learned.model.added[index].cause.into;
    let here = |c: &&Arc<Candidate>| {
        c.effect == effect && c.into == *into && c.of.as_deref() == of && c.also_into.is_empty()
    };
    // its name may be told although the search was confined to laws without one, but where it was
    // excluded
    let without = study.allowed.without.clone();
    let only = Allowed { only: vec![effect.into()], without, ..Allowed::default() };
    let all = library(study.problem, study.nominal, &base.model, vec![], &only, study.watch);
    let wishes: Vec<Wish> = all
        .iter()
        .filter(here)
        .flat_map(|cause| {
            let size = vec![cause.probe; cause.linear.len().max(1)];
            let points = starts::points(cause, 0, &size, cause.probe, None);
            points.into_iter().map(move |parameters| (cause, parameters))
        })
        .map(|(cause, parameters)| Wish {
            model: base.model.with(cause, parameters),
            noise: base.noise.clone(),
        })
        .collect();
    study.fit_and_keep(base.free, &wishes, ITERATIONS);
}

#[cfg(test)]
#[path = "nameless_tests.rs"]
mod tests;
