//! A hypothesis fitted exactly: laws at their places and moved parameters, the noise estimated anew.
//!
//! Gauss-Newton steps (Levenberg's damping) on coefficients, shapes and parameters by the tangents of the
//! innovations along the extended model's own path, every step judged by the exact log likelihood of
//! the innovations and the prior of the parameters (`prior.rs`); then the intensities of the noise, then again.
//! Sources: Ljung, "System Identification", 2nd ed., section 10.2; Astrom, Automatica 16, 1980.

use nalgebra::{DMatrix, DVector};

use super::error::LikelihoodError;
use super::follow::{Followed, Wanted};
use super::laws::Law;
use super::noise::Noise;
use super::parametrised::Model;
use super::predictor::Predictor;
use super::replay::Pass;
use super::tangent::{Site, gram};
use crate::effect::Role;
use crate::system::{Placed, Plan};

/// Iterations at most between two estimates of the noise, dampings tried in each, and the change of
/// log L at which a fit is settled.
const ITERATIONS: usize = 8;
const DAMPINGS: usize = 6;
const SETTLED: f64 = 0.02;
/// Estimates of the noise in one fit, each followed by one of the numbers.
const NOISES: usize = 3;
/// Largest step of a positive shape on the log scale, of any other number in units of its size.
const STEP: f64 = 0.5;

/// One part of a hypothesis.
#[derive(Debug, Clone)]
pub(crate) enum Part {
    Law { site: Site, source: Option<usize>, law: Box<Law> },
    Parameter(usize),
}

/// A fitted hypothesis.
#[derive(Debug, Clone)]
pub(crate) struct Hypothesis {
    pub parts: Vec<Part>,
    pub theta: Vec<f64>,
    pub noise: Noise,
    pub log_likelihood: f64,
    /// What its free parameters cost (`prior.rs`).
    pub occam: f64,
}

impl Hypothesis {
    /// What its parts are called.
    pub fn names(&self) -> Vec<(Site, Option<usize>, &'static str)> {
        names(&self.parts)
    }

    /// Numbers that were fitted, the noise's apart.
    pub fn numbers(&self) -> usize {
        numbers(&self.parts)
    }

    /// Numbers of laws and noise, of which nothing is known beforehand.
    pub fn unknowns(&self) -> usize {
        let parameters = self.parts.iter().filter(|part| matches!(part, Part::Parameter(_)));
        self.numbers() + self.noise.count() - parameters.count()
    }

    /// log L - (numbers of laws and noise) / 2 ln(samples), less what free parameters cost.
    pub fn criterion(&self, samples: f64) -> f64 {
        self.log_likelihood - 0.5 * self.unknowns() as f64 * samples.ln() - self.occam
    }
}

/// Numbers of parts.
pub(crate) fn numbers(parts: &[Part]) -> usize {
    let one = |part: &Part| match part {
        Part::Law { law, .. } => law.numbers(),
        Part::Parameter(_) => 1,
    };
    parts.iter().map(one).sum()
}

/// What the parts are called, whatever their order.
pub(crate) fn names(parts: &[Part]) -> Vec<(Site, Option<usize>, &'static str)> {
    let mut names: Vec<_> = parts
        .iter()
        .map(|part| match part {
            Part::Law { site, source, law } => (*site, *source, law.name),
            Part::Parameter(p) => (Site::Parameter(*p), None, "parameter"),
        })
        .collect();
    names.sort_unstable();
    names
}

impl Predictor {
    /// Fits a hypothesis from the values that its parts have at the noise given; `None` where it
    /// cannot be built or run.
    pub(crate) fn fit(&self, parts: Vec<Part>, theta: &[f64], noise: &Noise) -> Option<Hypothesis> {
        self.fit_in(ITERATIONS, parts, theta, noise)
    }

    /// The same in so many iterations at most.
    pub(crate) fn fit_in(
        &self,
        iterations: usize,
        parts: Vec<Part>,
        theta: &[f64],
        noise: &Noise,
    ) -> Option<Hypothesis> {
        let start = Hypothesis {
            parts,
            theta: theta.to_vec(),
            noise: noise.clone(),
            log_likelihood: f64::NEG_INFINITY,
            occam: 0.0,
        };
        let (best, run) = self.evaluated(start).ok()?;
        let (best, _) = self.improved(best, run, iterations)?;
        best.log_likelihood.is_finite().then_some(best)
    }

    /// The same hypothesis with its noise estimated anew, and its numbers after it, in turn.
    pub(crate) fn refit(&self, mut best: Hypothesis) -> Option<Hypothesis> {
        for _ in 0..NOISES {
            let before = best.log_likelihood;
            let model = self.extended(&best.parts, &best.theta).ok()?;
            let chosen = self.renewed(&model, &best.noise, 1).ok()?;
            if !(chosen.log_likelihood > before + SETTLED) {
                break;
            }
            best.noise = chosen.noise;
            best.log_likelihood = chosen.log_likelihood;
            let (next, run) = self.evaluated(best.clone()).ok()?;
            best = self.improved(next, run, ITERATIONS)?.0;
        }
        Some(best)
    }

    /// The model with a hypothesis in it.
    pub(crate) fn extended(&self, parts: &[Part], theta: &[f64]) -> Result<Model, LikelihoodError> {
        let mut effects = self.system.effects.clone();
        effects.extend(self.placed(parts));
        let plan = Plan::new(self.model.plan.base.clone(), &effects)?;
        Ok(Model { plan, theta: theta.to_vec() })
    }

    /// The laws of a hypothesis as entries of a model file.
    pub(crate) fn placed(&self, parts: &[Part]) -> Vec<Placed> {
        let plan = &self.model.plan;
        let law = |part: &Part| {
            let Part::Law { site, source: source_of, law } = part else { return None };
            let into = self.name(*site);
            let source = |e: usize| plan.sources.entries[e].0.name.clone();
            let of = source_of.map(source);
            let effect = law.effect.with_values(&law.values).ok()?;
            let also_of = law.load.map(source).into_iter().collect();
            Some(Placed { also_of, ..Placed::new(effect, &into, of.as_deref()) })
        };
        parts.iter().filter_map(law).collect()
    }

    /// The name of a site in model files.
    pub(crate) fn name(&self, site: Site) -> String {
        let signals = &self.model.plan.signals;
        match site {
            Site::Force(c) => self.forces()[c].0.clone(),
            Site::Output(o) => signals.outputs[o].name.clone(),
            Site::Parameter(p) => signals.parameters[p].name.clone(),
            Site::Parameters => "parameters".into(),
        }
    }

    /// The exact likelihood of a hypothesis, and its run.
    pub(crate) fn evaluated(
        &self,
        of: Hypothesis,
    ) -> Result<(Hypothesis, Followed), LikelihoodError> {
        let model = self.extended(&of.parts, &of.theta)?;
        let theta = of.parts.iter().any(|part| matches!(part, Part::Parameter(_)));
        let wanted = Wanted { theta, seen: true, gate: Some(self.gate()) };
        let run = self.run(&model, &of.noise, wanted)?;
        Ok((Hypothesis { log_likelihood: run.log_likelihood, ..of }, run))
    }

    /// A hypothesis with what its parameters cost, where it was not fitted.
    pub(super) fn costed(&self, of: Hypothesis) -> Hypothesis {
        if !of.parts.iter().any(|part| matches!(part, Part::Parameter(_))) {
            return of;
        }
        let Ok((_, run)) = self.evaluated(of.clone()) else { return of };
        let pass = Pass::of(&run.path, &of.noise, false);
        let sums = gram(&run.path, &pass, &of.noise, &self.slopes(&of, &run));
        Hypothesis { occam: self.occam(&of, &sums.square), ..of }
    }

    /// Damped Gauss-Newton steps at a fixed noise.
    fn improved(
        &self,
        mut best: Hypothesis,
        mut run: Followed,
        iterations: usize,
    ) -> Option<(Hypothesis, Followed)> {
        let mut damping = 1e-6;
        for _ in 0..iterations {
            if !best.log_likelihood.is_finite() || best.numbers() == 0 {
                return Some((best, run));
            }
            let columns = self.slopes(&best, &run);
            let pass = Pass::of(&run.path, &best.noise, false);
            let mut sums = gram(&run.path, &pass, &best.noise, &columns);
            best.occam = self.occam(&best, &sums.square);
            let (pull, known) = self.pull(&best);
            sums.slope -= pull;
            sums.square.set_diagonal(&(sums.square.diagonal() + known));
            let m = columns.len();
            let size = DVector::from_fn(m, |i, _| sums.square[(i, i)].max(1e-300).sqrt());
            let scaled = DMatrix::from_fn(m, m, |i, j| sums.square[(i, j)] / size[i] / size[j]);
            let posterior = |of: &Hypothesis| of.log_likelihood + self.log_prior(of);
            let before = posterior(&best);
            let mut moved = false;
            for _ in 0..DAMPINGS {
                let damped = &scaled + DMatrix::identity(m, m) * damping;
                let slope = sums.slope.component_div(&size);
                let step = damped.lu().solve(&slope).map(|s| -s);
                // what a quadratic of these slopes promises (Dennis and Schnabel, 1983, section 6.4)
                let promised = step.as_ref().map(|s| -slope.dot(s) - 0.5 * s.dot(&(&scaled * s)));
                if promised.is_some_and(|gain| gain < SETTLED) {
                    break;
                }
                let step = step.map(|step| step.component_div(&size));
                let next = step.map(|step| self.stepped(&best, step.as_slice()));
                let tried = next.and_then(|next| self.evaluated(next).ok());
                if let Some((next, path)) = tried
                    && posterior(&next) > before
                {
                    (best, run, moved) = (next, path, true);
                    damping = (damping / 10.0_f64).max(1e-9);
                    break;
                }
                damping = (damping * 10.0).max(1e-5);
            }
            if !moved || posterior(&best) - before < SETTLED {
                break;
            }
        }
        Some((best, run))
    }

    /// The hypothesis after a step, within the bounds of the parameters.
    fn stepped(&self, of: &Hypothesis, step: &[f64]) -> Hypothesis {
        let mut next = of.clone();
        let mut at = 0;
        for part in &mut next.parts {
            match part {
                Part::Parameter(p) => {
                    let parameter = &self.model.plan.signals.parameters[*p];
                    let value = next.theta[*p] + step[at];
                    next.theta[*p] = value.clamp(parameter.min, parameter.max);
                    at += 1;
                }
                Part::Law { law, .. } => {
                    for i in law.free.clone() {
                        let (effect_parameter, value) = (&law.card.parameters[i], law.values[i]);
                        let moved = match effect_parameter.role {
                            Role::Coefficient => value + step[at],
                            _ if effect_parameter.min >= 0.0 && value > 0.0 => {
                                value * (step[at] / value).clamp(-STEP, STEP).exp()
                            }
                            _ => {
                                let most = STEP * value.abs().max(1e-12);
                                value + step[at].clamp(-most, most)
                            }
                        };
                        law.values[i] = moved.clamp(effect_parameter.min, effect_parameter.max);
                        at += 1;
                    }
                }
            }
        }
        next
    }
}
