//! The models that were fitted, with their posterior probabilities.
//!
//! P(M | data) = exp(ln p(M) - ln sum exp ln p(M')) over the models of the beam; P(cause) is the sum
//! over the models that have it (Bayesian model averaging: Hoeting et al., Statistical Science 14, 1999).

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::candidates::candidate::Candidate;
use crate::criteria::{AS_GOOD, LEAVES};
use crate::evidence::Whitener;
use crate::fit::problem::Model;
use crate::statistics::rms;

/// Rise of a logarithm of a posterior that makes one fit better than another of the same causes.
const BETTER: f64 = 0.01;

/// A fitted model.
#[derive(Debug, Clone)]
pub(crate) struct Fit {
    pub model: Model,
    /// Whether all parameters may move.
    pub free: bool,
    /// Its disturbance.
    pub noise: Arc<dyn Whitener>,
    /// What it leaves of the part that is fitted, not whitened.
    pub residual: Vec<f64>,
    /// Logarithms of its likelihood, of the Occam factor and of the prior.
    pub likelihood: f64,
    pub occam: f64,
    pub prior: f64,
}

impl Fit {
    /// Logarithm of the posterior, but for a constant of the data.
    pub fn posterior(&self) -> f64 {
        self.likelihood - self.occam + self.prior
    }

    /// What identifies it.
    pub fn key(&self) -> SetKey {
        SetKey::new(self.free, self.model.added.iter().map(|added| name(&added.cause)))
    }

    /// Causes beside the limits that were known before.
    pub fn causes(&self) -> usize {
        self.model.added.len() - self.model.known()
    }

    /// Whether it has no causes and its parameters are held.
    pub fn is_nothing(&self) -> bool {
        !self.free && self.causes() == 0
    }

    /// How many places it has a law at.
    fn places(&self) -> usize {
        let all = &self.model.added;
        let is_first = |i: &usize| !all[..*i].iter().any(|a| a.cause.same_place(&all[*i].cause));
        (0..all.len()).filter(is_first).count()
    }

    /// How it is ordered among what is as probable: fewer places, held parameters, fewer numbers, the
    /// plainer laws.
    fn order(&self) -> impl Ord + use<> {
        let mut all: Vec<_> = self.model.added.iter().map(|a| a.cause.order()).collect();
        all.sort();
        let numbers: usize = self.model.added.iter().map(|a| a.cause.unknowns()).sum();
        (self.places() + usize::from(self.free), numbers, all)
    }
}

/// A set of names, and whether parameters may move beside it.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct SetKey {
    pub free: bool,
    pub names: Vec<String>,
}

impl SetKey {
    /// A key of names in any order.
    pub fn new(free: bool, names: impl Iterator<Item = String>) -> Self {
        let mut names: Vec<String> = names.collect();
        names.sort();
        Self { free, names }
    }

    /// Whether a name stands in it twice.
    pub fn repeats(&self) -> bool {
        self.names.windows(2).any(|pair| pair[0] == pair[1])
    }
}

/// A cause's name in keys.
pub(crate) fn name(cause: &Candidate) -> String {
    let also = if cause.also_into.is_empty() { "" } else { "+" };
    let of = cause.coordinates().join("&");
    format!("{}>{}{also}<{of}", cause.effect, cause.into)
}

/// All models that were fitted, the best fit of every set of names.
#[derive(Debug, Default)]
pub(crate) struct Beam {
    fits: BTreeMap<SetKey, Fit>,
}

impl Beam {
    /// Takes a fit in; whether it is better than what was there.
    pub fn keep(&mut self, fit: Fit) -> bool {
        let key = fit.key();
        let leaves = |fit: &Fit| rms(&fit.residual).powi(2);
        let is_nothing = fit.is_nothing();
        if !is_nothing && self.nothing().is_some_and(|none| leaves(&fit) > LEAVES * leaves(none)) {
            return false;
        }
        let known = self.fits.get(&key).map(Fit::posterior);
        let better = known.is_none_or(|known| fit.posterior() > known + BETTER);
        if better {
            self.fits.insert(key, fit);
        }
        better
    }

    /// The fit without causes, parameters held.
    fn nothing(&self) -> Option<&Fit> {
        self.fits().find(|fit| fit.is_nothing())
    }

    /// The fit of a set.
    pub fn get(&self, key: &SetKey) -> Option<&Fit> {
        self.fits.get(key)
    }

    /// The same, to change.
    pub fn get_mut(&mut self, key: &SetKey) -> Option<&mut Fit> {
        self.fits.get_mut(key)
    }

    /// Takes a set out.
    pub fn remove(&mut self, key: &SetKey) {
        self.fits.remove(key);
    }

    /// Takes out every set that has a cause.
    pub fn rule_out(&mut self, cause: &Candidate) {
        self.fits.retain(|_, fit| {
            let own = &fit.model.added[fit.model.known()..];
            !own.iter().any(|added| added.cause.same_cause(cause))
        });
    }

    /// All fits, by their keys.
    pub fn fits(&self) -> impl Iterator<Item = &Fit> {
        self.fits.values()
    }

    /// The most probable one.
    pub fn best(&self) -> Option<&Fit> {
        self.fits().max_by(|a, b| a.posterior().total_cmp(&b.posterior()))
    }

    /// The most probable one with parameters held, or free.
    pub fn best_of(&self, free: bool) -> Option<&Fit> {
        let own = self.fits().filter(|fit| fit.free == free);
        own.max_by(|a, b| a.posterior().total_cmp(&b.posterior()))
    }

    /// Those within some nats of the best.
    pub fn within(&self, nats: f64) -> impl Iterator<Item = &Fit> {
        let top = self.best().map_or(0.0, Fit::posterior);
        self.fits().filter(move |fit| fit.posterior() > top - nats)
    }

    /// The plainest of what is as probable as the best.
    pub fn headline(&self) -> Option<&Fit> {
        let compared = |a: &&Fit, b: &&Fit| {
            a.order().cmp(&b.order()).then(b.posterior().total_cmp(&a.posterior()))
        };
        self.within(AS_GOOD).min_by(compared)
    }

    /// Probability of one more model, by the logarithm of its posterior.
    pub fn probability_of_another(&self, posterior: f64) -> f64 {
        let others = self.fits().map(|fit| (fit.posterior() - posterior).exp());
        1.0 / (1.0 + others.sum::<f64>())
    }

    /// Probability that a condition holds.
    pub fn probability(&self, holds: impl Fn(&Fit) -> bool) -> f64 {
        let top = self.best().map_or(0.0, Fit::posterior);
        let (mut own, mut all) = (0.0, 0.0);
        for fit in self.fits() {
            let share = (fit.posterior() - top).exp();
            all += share;
            own += if holds(fit) { share } else { 0.0 };
        }
        if all > 0.0 { (own / all).clamp(0.0, 1.0) } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::search::fixture::fit_of;

    fn fit(free: bool, likelihood: f64) -> Fit {
        Fit { free, likelihood, occam: 1.0, prior: -2.0, ..fit_of(&[], vec![1.0; 10]) }
    }

    #[test]
    fn probabilities_are_shares_of_the_beam() {
        let mut beam = Beam::default();
        assert!(beam.keep(fit(false, 3.0)));
        assert!(!beam.keep(fit(false, 2.0)), "worse than what is there");
        assert!(beam.keep(fit(true, 4.0)));
        let expected = 1.0 / (1.0 + 1f64.exp());
        assert!((beam.probability(|fit| !fit.free) - expected).abs() < 1e-12);
        let alike = beam.probability_of_another(fit(true, 4.0).posterior());
        assert!((alike - 1.0 / (2.0 + (-1f64).exp())).abs() < 1e-12);
        // within what is as good, the plainer one is told
        assert!(!beam.headline().unwrap().free);
        beam.keep(fit(true, 9.0));
        assert!(beam.headline().unwrap().free);
    }

    #[test]
    fn what_leaves_more_than_nothing_explains_nothing() {
        let mut beam = Beam::default();
        let leaves = |names: &[&str], size: f64| Fit {
            free: false,
            likelihood: 9.0,
            ..fit_of(names, vec![size; 10])
        };
        // before anything is known of nothing there is no bound
        assert!(beam.keep(leaves(&["early"], 3.0)));
        beam.keep(leaves(&[], 1.0));
        assert!(beam.keep(leaves(&["less"], 0.5)));
        assert!(beam.keep(leaves(&["chance"], 1.04)));
        assert!(!beam.keep(leaves(&["more"], 1.06)));
    }

    #[test]
    fn a_cause_that_is_ruled_out_takes_its_sets_with_it() {
        let mut beam = Beam::default();
        for names in [&[][..], &["a"], &["a", "b"], &["b"]] {
            beam.keep(fit_of(names, vec![1.0; 10]));
        }
        let gone = fit_of(&["a"], vec![]).model.added[0].cause.clone();
        beam.rule_out(&gone);
        let left: Vec<usize> = beam.fits().map(Fit::causes).collect();
        assert_eq!(left, [0, 1]);
        assert!(!beam.fits().any(|fit| fit.model.added.iter().any(|a| a.cause.same_cause(&gone))));
    }
}
