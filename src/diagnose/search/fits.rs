//! Fits of many models at once, each in the disturbance of its own, and their posteriors.

use std::sync::Arc;

use rayon::prelude::*;

use super::beam::Fit;
use crate::evidence::{Choices, NoiseModel, Whitener, occam, price, width};
use crate::fit::nuisance::{Key, Nuisance, get};
use crate::fit::problem::{Grain, Model, Problem, Span};
use crate::fit::refit::{Fitted, Refit, Stop, refit_whitened};
use crate::optimise::Settings;

/// A model to be fitted, and the disturbance to weigh its residual by.
#[derive(Debug, Clone)]
pub(super) struct Wish {
    pub model: Model,
    pub noise: Arc<dyn Whitener>,
}

impl From<&Fit> for Wish {
    /// A fit that goes on.
    fn from(fit: &Fit) -> Self {
        Self { model: fit.model.clone(), noise: fit.noise.clone() }
    }
}

/// What fits are made and judged with.
pub(super) struct Judge<'a, 'b> {
    pub problem: &'a Problem<'b>,
    pub nuisance: &'a Nuisance,
    /// Whether all parameters may move.
    pub free: bool,
    pub disturbance: &'a dyn NoiseModel,
    pub choices: Choices,
    /// Whether somebody asks to stop: what is not fitted then is left out, or ends where it has come to
    /// where nothing is known yet.
    pub stop: Stop<'a>,
}

impl Judge<'_, '_> {
    /// Fits all; each is judged in the disturbance that suits what it leaves. What cannot be
    /// simulated is left out.
    pub fn fit(&self, wishes: &[Wish], iterations: usize) -> Vec<Fit> {
        let settings = Settings { iterations, tolerance: 1e-5, difference: 2e-3 };
        let how = Refit { settings, grain: Grain::Coarse, whole: false };
        let keys = |wish: &Wish| self.nuisance.keys(&wish.model).len() + 1;
        let numbers = wishes.iter().map(keys).max().unwrap_or(1);
        // a simulation, a residual and a derivative for every number that moves
        let at_once = (self.problem.at_once(Span::Fit) / numbers).max(1);
        wishes.chunks(at_once).flat_map(|wishes| self.fit_at_once(wishes, how)).collect()
    }

    /// Fits as many as memory holds; each does not know of the others.
    fn fit_at_once(&self, wishes: &[Wish], how: Refit) -> Vec<Fit> {
        let models: Vec<Model> = wishes.iter().map(|wish| wish.model.clone()).collect();
        let noises: Vec<_> = wishes.iter().map(|wish| wish.noise.clone()).collect();
        let fitted = refit_whitened(self.problem, self.nuisance, &models, &noises, how, self.stop);
        let both: Vec<_> = fitted.into_iter().zip(&noises).collect();
        both.into_par_iter().filter_map(|(fitted, by)| self.judged(fitted?, by.as_ref())).collect()
    }

    /// The posterior of a model that was fitted in a metric.
    fn judged(&self, fitted: Fitted, by: &dyn Whitener) -> Option<Fit> {
        let residual = by.colour(&fitted.residuals);
        let estimated = self.disturbance.likelier(&residual, by);
        let Fitted { model, keys, columns, residuals } = fitted;
        let widths: Vec<f64> =
            keys.iter().map(|&key| width(self.problem, self.nuisance, &model, key)).collect();
        let squares: f64 = residuals.iter().map(|r| r * r).sum();
        let variance = squares / residuals.len().max(1) as f64;
        let prior = self.expected(&model, &keys) - price(&model, self.free, self.choices);
        let fit = Fit {
            occam: self.of_numbers(&keys, &columns, &widths, variance),
            likelihood: estimated.log_likelihood,
            noise: estimated.whitener,
            free: self.free,
            model,
            residual,
            prior,
        };
        fit.posterior().is_finite().then_some(fit)
    }

    /// The Occam factor of parameters and laws, initial states being a nuisance that all models share
    /// (Kass and Vaidyanathan, JRSS B 54, 1992): ln det of what is left of the others once these are
    /// accounted for. A record that is cut into stretches has as many of them as stretches.
    fn of_numbers(&self, keys: &[Key], columns: &[Vec<f64>], widths: &[f64], variance: f64) -> f64 {
        let starts = |i: &usize| matches!(keys[*i], Key::Start(..));
        let shared: Vec<usize> = (0..keys.len().min(columns.len())).filter(starts).collect();
        let own: Vec<Vec<f64>> = shared.iter().map(|&i| columns[i].clone()).collect();
        let own_widths: Vec<f64> = shared.iter().map(|&i| widths[i]).collect();
        occam(columns, widths, variance) - occam(&own, &own_widths, variance)
    }

    /// Logarithm of the Gaussian priors of parameters, initial states and the numbers of curves.
    fn expected(&self, model: &Model, keys: &[Key]) -> f64 {
        let one = |&key: &Key| {
            let prior = match key {
                Key::EffectParameter(..) => None,
                _ => self.nuisance.unknown(self.problem, model, key).prior,
            };
            prior
                .map_or(0.0, |(centre, deviation)| ((get(model, key) - centre) / deviation).powi(2))
        };
        -0.5 * keys.iter().map(one).sum::<f64>()
    }
}
