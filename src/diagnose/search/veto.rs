//! The veto of data that were not fitted: a likelihood is exact, the model is not.
//!
//! A cause goes where the part of the record that chooses speaks against it (`likelihood::refutes`),
//! ln p(y | with) - ln p(y | without), both with the numbers of the laws that were fitted elsewhere
//! (prequential: Dawid, JRSS A 147, 1984). The disturbance is a nuisance of either model and is estimated
//! where it is judged: what a model still lacks may be larger here than where it was fitted, and the noise
//! of that part would count it against a cause that has nothing to do with it.

use super::beam::Fit;
use super::fits::Wish;
use super::study::Study;
use crate::evidence::Stretches;
use crate::fit::problem::{Added, Grain, Part};
use crate::likelihood::refutes;

/// Iterations of a fit without a cause.
const ITERATIONS: usize = 8;

/// The most probable set of causes none of which the held part refutes, and the causes that it does.
/// A set that has a refuted cause is no hypothesis any more, and probabilities are those of the others.
pub(super) fn vetoed(study: &mut Study<'_, '_>) -> Option<(Fit, Vec<Added>)> {
    let mut withdrawn: Vec<Added> = vec![];
    let held = study.stretches(Part::Choose);
    let mut fit = study.beam.headline()?.clone();
    while let Some(index) = refuted(study, &fit, &held) {
        let gone = fit.model.added[index].clone();
        study.beam.rule_out(&gone.cause);
        withdrawn.push(gone);
        fit = study.beam.headline()?.clone();
    }
    // where another law stands at its place now, a cause was replaced
    withdrawn.retain(|gone| !fit.model.added.iter().any(|a| a.cause.same_place(&gone.cause)));
    Some((fit, withdrawn))
}

/// The cause that the held part speaks against most.
fn refuted(study: &mut Study<'_, '_>, fit: &Fit, held: &Stretches) -> Option<usize> {
    let all: Vec<usize> = (fit.model.known()..fit.model.added.len()).collect();
    if study.problem.samples(Part::Choose).next().is_none() || all.is_empty() {
        return None;
    }
    let without: Vec<Fit> = all.iter().map(|&i| less(study, fit, i)).collect::<Option<_>>()?;
    let models: Vec<_> = std::iter::once(fit).chain(&without).map(|fit| &fit.model).collect();
    let outputs = study.problem.simulate_all(&models, Grain::Coarse);
    let density = |y: crate::fit::problem::Simulated| {
        let residual = study.problem.residual(&y?, Part::Choose);
        let value = held.coloured(&residual).1;
        value.is_finite().then_some(value)
    };
    let mut densities = outputs.into_iter().map(density);
    let with = densities.next()??;
    let gains = densities.map(|bare| bare.map_or(f64::INFINITY, |bare| with - bare));
    let (at, gain) = gains.enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let odds = fit.posterior() - without[at].posterior();
    refutes(gain, odds).then_some(all[at])
}

/// The fit without one of its causes.
fn less(study: &mut Study<'_, '_>, fit: &Fit, index: usize) -> Option<Fit> {
    let model = fit.model.without(index);
    let key = Fit { model: model.clone(), ..fit.clone() }.key();
    if let Some(known) = study.beam.get(&key) {
        return Some(known.clone());
    }
    // a model that is no explanation by itself is still what the cause is judged against
    let wish = Wish { model, noise: fit.noise.clone() };
    let rest = study.fit(fit.free, &[wish], ITERATIONS).pop()?;
    study.beam.keep(rest.clone());
    Some(rest)
}
