//! What a search knows: data, library, fits.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::beam::{Beam, Fit, SetKey};
use super::dictionary::Item;
use super::fits::{Judge, Wish};
use super::starts;
use crate::candidates::candidate::Candidate;
use crate::candidates::library::{Allowed, library};
use crate::evidence::{Choices, NoiseModel, Stretches};
use crate::fit::found::LeftOut;
use crate::fit::nuisance::Nuisance;
use crate::fit::problem::{Grain, Model, Part, Problem, Simulated, Span};
use crate::fit::refit::{Fitted, Stop};
use crate::fit::segment_restart::restarted;
use crate::prepare::input_dependence::dependence;
use crate::prepare::operating_range::Nominal;
use crate::statistics::{outstanding, strongest};
use crate::watch::Watch;

/// Lines of the residual that hums are tried at.
const LINES: usize = 3;
/// Distance from the best within which fits are judged again when the data are looked at anew.
const JUDGED_AGAIN: f64 = 40.0;

/// A search under way.
pub(super) struct Study<'a, 'b> {
    pub problem: &'a mut Problem<'b>,
    pub nominal: &'a Nominal,
    pub allowed: &'a Allowed,
    /// Causes allowed.
    pub most: usize,
    pub watch: &'a dyn Watch,
    /// Initial states only; with all parameters.
    pub held: Nuisance,
    pub free: Nuisance,
    pub disturbance: Stretches,
    /// The model that was stood on, through whose sensors the records are read.
    pub seen_by: Option<Model>,
    pub beam: Beam,
    pub candidates: Vec<Arc<Candidate>>,
    pub choices: Choices,
    pub items: Vec<Item>,
    /// Laws that memory did not hold, and the causes of the model that the items are about.
    pub left_out: Option<LeftOut>,
    pub about: Vec<String>,
    /// Whether the search is over and what it found is looked at once more.
    pub concludes: bool,
    /// Sets that were fitted from a move, and those that were fitted as neighbours.
    pub tried: BTreeSet<SetKey>,
    pub settled: BTreeSet<SetKey>,
    /// Laws in the place of parameters of a set, the last that was asked: parameter and fit.
    pub exchanged: Option<(SetKey, Vec<(usize, Fit)>)>,
}

impl<'a, 'b> Study<'a, 'b> {
    pub fn new(
        problem: &'a mut Problem<'b>,
        nominal: &'a Nominal,
        allowed: &'a Allowed,
        most: usize,
        watch: &'a dyn Watch,
    ) -> Self {
        let held = Nuisance::new(problem, nominal);
        let free = held.clone().with_parameters(problem, &allowed.fixed);
        let disturbance = Stretches::new(problem, Part::Fit);
        Self {
            problem,
            nominal,
            allowed,
            most,
            watch,
            held,
            free,
            disturbance,
            seen_by: None,
            beam: Beam::default(),
            candidates: vec![],
            choices: Choices::default(),
            items: vec![],
            left_out: None,
            about: vec![],
            concludes: false,
            tried: BTreeSet::new(),
            settled: BTreeSet::new(),
            exchanged: None,
        }
    }

    /// What moves beside causes.
    pub fn nuisance(&self, free: bool) -> &Nuisance {
        if free { &self.free } else { &self.held }
    }

    /// Fits, none of them kept yet; none where somebody asks to stop, but to conclude or where nothing is
    /// known.
    pub fn fit(&self, free: bool, wishes: &[Wish], iterations: usize) -> Vec<Fit> {
        self.fit_with(self.nuisance(free), free, wishes, iterations)
    }

    /// The same where something else moves beside causes.
    pub fn fit_with(
        &self,
        nuisance: &Nuisance,
        free: bool,
        wishes: &[Wish],
        iterations: usize,
    ) -> Vec<Fit> {
        let asked = || self.watch.stopped();
        let stop = match self.beam.best() {
            None => Stop::Keep(&asked),
            Some(_) if self.concludes => Stop::Never,
            Some(_) => Stop::Discard(&asked),
        };
        let judge = Judge {
            stop,
            problem: self.problem,
            nuisance,
            free,
            disturbance: &self.disturbance,
            choices: self.choices,
        };
        judge.fit(wishes, iterations)
    }

    /// Fits, and keeps what is better than what is known.
    pub fn fit_and_keep(&mut self, free: bool, wishes: &[Wish], iterations: usize) {
        for fit in self.fit(free, wishes, iterations) {
            self.beam.keep(fit);
        }
    }

    /// Fits from better initial states, of those that have any: all else as it is.
    pub fn restarted(&self, free: bool, fits: &[Fit]) -> Vec<Wish> {
        let fitted = |fit: &Fit| {
            let (model, residuals) = (fit.model.clone(), fit.residual.clone());
            Fitted { model, keys: vec![], columns: vec![], residuals }
        };
        if self.watch.stopped() {
            return vec![];
        }
        let all: Vec<Fitted> = fits.iter().map(fitted).collect();
        let all: Vec<&Fitted> = all.iter().collect();
        let models = restarted(self.problem, self.nuisance(free), &all, (Grain::Coarse, Part::Fit));
        let wish = |(fit, model): (&Fit, Option<Model>)| {
            Some(Wish { model: model?, noise: fit.noise.clone() })
        };
        fits.iter().zip(models).filter_map(wish).collect()
    }

    /// Score that what a model leaves depends on the inputs.
    pub fn dependence(&self, model: &Model) -> f64 {
        let y = self.problem.simulate(model, Grain::Coarse);
        y.map_or(0.0, |y| dependence(self.problem, self.nominal, &y))
    }

    /// Score that what the noise of a fit does not foresee depends on the inputs: innovations of the right
    /// model follow from none of them (Ljung, System Identification, 1999, section 16.6).
    pub fn unforeseen(&self, fit: &Fit) -> f64 {
        let problem = &*self.problem;
        let Some(y) = problem.simulate(&fit.model, Grain::Coarse) else { return 0.0 };
        let residual = problem.residual(&y, Part::All);
        let all = Stretches::through_sensors_of(problem, &fit.model, Part::All);
        let innovations = fit.noise.over(&all, &residual).whitener.whiten(&residual);
        let n = problem.samples(Part::All).count().max(1);
        // as measured where there are no innovations
        let mut foreseen = problem.y.clone();
        for (foreseen, own) in foreseen.iter_mut().zip(innovations.chunks(n)) {
            problem.samples(Part::All).zip(own).for_each(|(k, e)| foreseen[k] -= e);
        }
        dependence(problem, self.nominal, &foreseen)
    }

    /// Fits the leading ones once more, each in its own disturbance, and what begins in them from its most
    /// likely moment.
    pub fn polish(&mut self, within: f64) {
        for free in [false, true] {
            let close = self.beam.within(within).filter(|fit| fit.free == free);
            let close: Vec<Fit> = close.cloned().collect();
            let mut wishes = self.dated(free, &close);
            wishes.extend(close.iter().filter(|fit| fit.noise.is_coloured()).map(Wish::from));
            self.fit_and_keep(free, &wishes, 4);
        }
    }

    /// Goes on from a model: what is an outlier, how fine its steps have to be. The leading fits are
    /// judged again by the same data and steps.
    pub fn stand_on(&mut self, model: &Model) {
        if let Some(y) = self.problem.simulate(model, Grain::Coarse) {
            self.problem.flag_spikes(&y);
        }
        if self.problem.are_too_coarse(&[model]) {
            self.problem.take_own_steps(&[model]);
        } else {
            self.problem.recorrect(model);
        }
        self.seen_by = Some(model.clone());
        self.judge_again();
    }

    /// Stretches of a part of the records, read through the sensors of the model that was stood on.
    pub fn stretches(&self, part: Part) -> Stretches {
        match &self.seen_by {
            Some(model) => Stretches::through_sensors_of(self.problem, model, part),
            None => Stretches::new(self.problem, part),
        }
    }

    /// Judges the leading fits by the data and steps as they are now.
    fn judge_again(&mut self) {
        self.disturbance = self.stretches(Part::Fit);
        let keys: Vec<SetKey> = self.beam.within(JUDGED_AGAIN).map(Fit::key).collect();
        let model = |key: &SetKey| self.beam.get(key).map(|fit| &fit.model);
        // what is known of the whole record is known of the part that is fitted
        let mut runs: Vec<Simulated> =
            keys.iter().map(|key| self.problem.known_run(model(key)?, Grain::Coarse)).collect();
        let open: Vec<usize> = (0..keys.len()).filter(|&i| runs[i].is_none()).collect();
        let job = |&i: &usize| self.problem.job(model(&keys[i])?, Grain::Coarse);
        let jobs: Vec<_> = open.iter().map(job).collect();
        for (i, y) in open.into_iter().zip(self.problem.run_built(&jobs, Span::Fit)) {
            runs[i] = y;
        }
        for (key, y) in keys.iter().zip(runs) {
            let residual = y.map(|y| self.problem.residual(&y, Part::Fit));
            let finite = residual.filter(|r| r.iter().all(|v| v.is_finite()));
            match (finite, self.beam.get_mut(key)) {
                (Some(residual), Some(fit)) => {
                    let estimated = self.disturbance.likelier(&residual, fit.noise.as_ref());
                    fit.likelihood = estimated.log_likelihood;
                    fit.noise = estimated.whitener;
                    fit.residual = residual;
                }
                _ => self.beam.remove(key),
            }
        }
    }

    /// Fits the leading models to their end, by the integrator's own steps: none is favoured by a
    /// correction that was made about another, or by iterations that another did not have.
    pub fn settle(&mut self, within: f64, iterations: usize) {
        let models: Vec<Model> = self.beam.within(within).map(|fit| fit.model.clone()).collect();
        if models.len() < 2 {
            return self.nest(iterations);
        }
        if !self.problem.has_own_steps() {
            self.problem.take_own_steps(&models.iter().collect::<Vec<_>>());
            self.judge_again();
        }
        for free in [false, true] {
            let close = self.beam.within(within).filter(|fit| fit.free == free);
            let wishes: Vec<Wish> = close.map(Wish::from).collect();
            self.fit_and_keep(free, &wishes, iterations);
        }
        self.nest(iterations);
    }

    /// Fits what is left of the best without each of its causes, from where it stands, until that is not
    /// better: a model that holds another is compared with it from the same hill of the likelihood, and in the
    /// same noise.
    fn nest(&mut self, iterations: usize) {
        while let Some(best) = self.beam.best().filter(|best| best.causes() > 0).cloned() {
            let less = |i| Wish { model: best.model.without(i), noise: best.noise.clone() };
            let wishes: Vec<Wish> =
                (best.model.known()..best.model.added.len()).map(less).collect();
            self.fit_and_keep(best.free, &wishes, iterations);
            if self.beam.best().is_none_or(|now| now.key() == best.key()) {
                return;
            }
        }
    }

    /// Takes in all candidates for what a model leaves, with finer thresholds where they are blended in.
    pub fn look_up(&mut self, fit: &Fit) {
        let n = (fit.residual.len() / self.problem.y.len().max(1)).max(1);
        let step = self.problem.base.sampling_time;
        let mut lines: Vec<f64> = vec![];
        let of = |r| strongest(r, step, LINES).into_iter().chain(outstanding(r, step, 1));
        for line in fit.residual.chunks(n).flat_map(of) {
            if !lines.contains(&line) {
                lines.push(line);
            }
        }
        let all = library(self.problem, self.nominal, &fit.model, lines, self.allowed, self.watch);
        let finer = |cause: Arc<Candidate>| {
            if !(cause.blended() && cause.thresholds) {
                return cause;
            }
            let mut own = Candidate::clone(&cause);
            Arc::make_mut(&mut own.starts).extend(starts::thresholds(&cause));
            Arc::new(own)
        };
        let nuisance = self.nuisance(fit.free);
        let candidates: Vec<_> =
            all.into_iter().filter(|c| !nuisance.frees(c)).map(finer).collect();
        self.choices = Choices::of(&candidates);
        self.candidates = candidates;
    }
}
