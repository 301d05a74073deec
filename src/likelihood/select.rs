//! Which noise there is: forward selection of components by Schwarz's criterion.
//!
//! Measurement noise is always there. White forces, slow forces and wander are added one at a time,
//! the one that raises log L most, as long as log L rises by more than (numbers added) / 2 ln(samples);
//! the poles of slow parts are chosen (`poles.rs`); what has become superfluous is taken out again, and the linearisation is renewed at the end.
//! Sources: Schwarz, Annals of Statistics 6, 1978; Kristensen, Madsen and Jorgensen, Automatica 40, 2004.

use rayon::prelude::*;

use super::error::LikelihoodError;
use super::follow::{Followed, Wanted};
use super::hypothesis::Hypothesis;
use super::intensities::{concentrated, leading_fitted, most_likely, nearly_most_likely};
use super::noise::{Component, Noise, Slow};
use super::parametrised::Model;
use super::path::Path;
use super::predictor::Predictor;
use super::replay::Pass;

/// Sizes that a component is begun with, in units of its signal's variance.
const SIZES: [f64; 5] = [1e-8, 1e-6, 1e-4, 1e-2, 1.0];
/// What of the measurement noise may turn out to be something else.
const LEFT: [f64; 2] = [1.0, 1e-2];
/// Components that are fitted in every round, of all that are looked at.
const FITTED: usize = 3;
/// Components at most: each is named in the result, and a record tells no more apart.
const MOST: usize = 6;
/// Renewals of the linearisation at most, and the change of log L at which it is settled.
const RENEWED: usize = 3;
const SETTLED: f64 = 0.5;

/// A noise, what it makes likely, and the run that belongs to it.
#[derive(Debug, Clone)]
pub(crate) struct Chosen {
    pub noise: Noise,
    pub log_likelihood: f64,
    pub run: Followed,
}

impl Predictor {
    /// The noise that the data call for under a model, about one linearisation, from measurement noise alone.
    pub(super) fn chosen_on(
        &self,
        model: &Model,
        tracking: &Path,
    ) -> Result<Chosen, LikelihoodError> {
        let mut chosen = self.renewed(model, &self.selected(tracking), RENEWED)?;
        if !chosen.log_likelihood.is_finite() {
            // the path of the selected noise leaves the numbers: stay with one that tracks
            chosen = self.renewed(model, &self.tracking_noise(tracking), RENEWED)?;
        }
        let fewer = self.pruned(&chosen.run.path, chosen.noise.clone(), 1);
        if fewer != chosen.noise
            && let Some(other) =
                self.as_good(model, &chosen.noise, chosen.log_likelihood, &fewer)?
        {
            chosen = other;
        }
        Ok(chosen)
    }

    /// The noise of fewer components beside causes that were found, where they can do without the others: it was
    /// chosen before them, and had to stand for them.
    pub(super) fn needed_noise(
        &self,
        of: &Hypothesis,
        path: &Path,
    ) -> Result<Option<Noise>, LikelihoodError> {
        let fewer = self.pruned(path, of.noise.clone(), 0);
        if fewer == of.noise {
            return Ok(None);
        }
        let model = self.extended(&of.parts, &of.theta)?;
        let other = self.as_good(&model, &of.noise, of.log_likelihood, &fewer)?;
        Ok(other.map(|other| other.noise))
    }

    /// A noise of fewer components, on a path of its own, where it loses less than the others take.
    fn as_good(
        &self,
        model: &Model,
        noise: &Noise,
        value: f64,
        fewer: &Noise,
    ) -> Result<Option<Chosen>, LikelihoodError> {
        let other = self.renewed(model, fewer, 1)?;
        let saved = noise.count() as f64 - other.noise.count() as f64;
        let is_as_good = value - other.log_likelihood < 0.5 * self.observed().ln() * saved;
        Ok(is_as_good.then_some(other))
    }

    /// The same components fitted anew under another model.
    pub(crate) fn renewed(
        &self,
        model: &Model,
        noise: &Noise,
        times: usize,
    ) -> Result<Chosen, LikelihoodError> {
        let gate = Some(self.gate());
        let wanted = |gate| Wanted { gate, ..Wanted::default() };
        // the gate needs a noise of the right size first
        let mut run = self.run(model, noise, wanted(None))?;
        let mut best: Option<Chosen> = None;
        let mut noise = noise.clone();
        for _ in 0..times.max(1) {
            if run.log_likelihood.is_finite() {
                noise = most_likely(&run.path, &noise, &noise.components()).0;
            }
            run = self.run(model, &noise, wanted(gate))?;
            let value = run.log_likelihood;
            let gained = best.as_ref().map_or(f64::INFINITY, |b| value - b.log_likelihood);
            if gained > 0.0 || best.is_none() {
                let found =
                    Chosen { noise: noise.clone(), log_likelihood: value, run: run.clone() };
                best = Some(found);
            }
            if !(gained > SETTLED) {
                break;
            }
        }
        best.ok_or(LikelihoodError::Diverges { sample: 0, time: 0.0 })
    }

    /// How many outputs were measured.
    pub(crate) fn observed(&self) -> f64 {
        self.measured.iter().filter(|y| y.is_finite()).count().max(1) as f64
    }

    /// Forward selection on a path.
    fn selected(&self, path: &Path) -> Noise {
        let penalty = 0.5 * self.observed().ln();
        let start = self.wide_noise();
        let (mut noise, mut value) = nearly_most_likely(path, &start, &start.components());
        let scales = path.force_scales();
        for _ in 0..MOST {
            let Some((next, better)) = self.added(path, &noise, &scales) else { break };
            let more = (next.count() - noise.count()) as f64;
            if !(better - value > penalty * more) {
                break;
            }
            (noise, value) = (next, better);
        }
        self.poled(path, noise, value)
    }

    /// The most likely noise with one component more.
    fn added(&self, path: &Path, noise: &Noise, scales: &[f64]) -> Option<(Noise, f64)> {
        let looked: Vec<(Noise, f64)> = self
            .more(path, noise)
            .into_par_iter()
            .flat_map_iter(|(component, pole)| {
                let scale = match component {
                    Component::White(c) | Component::Slow(c) => scales[c],
                    Component::Measurement(o) | Component::Wander(o) => self.spread[o],
                };
                let tried = SIZES.iter().flat_map(move |size| {
                    LEFT.iter().map(move |left| {
                        let mut noise = noise.clone();
                        noise.measurement.iter_mut().for_each(|r| *r *= left);
                        place(&mut noise, component, size * scale * scale, pole);
                        concentrated(path, &noise)
                    })
                });
                tried.filter(|(_, value)| value.is_finite()).max_by(|a, b| a.1.total_cmp(&b.1))
            })
            .collect();
        leading_fitted(path, looked, FITTED).into_iter().max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Components that are not there yet, with the pole that they begin with. Forces that push the
    /// same way are one.
    fn more(&self, path: &Path, noise: &Noise) -> Vec<(Component, f64)> {
        let mut found = vec![];
        for c in self.distinct(path) {
            if noise.white[c] == 0.0 {
                found.push((Component::White(c), 1.0));
            }
            if !noise.slow[c].is_active() {
                found.extend([(Component::Slow(c), 1.0), (Component::Slow(c), 0.9)]);
            }
        }
        for o in 0..path.outputs {
            if self.spread[o] > 0.0 && !noise.wander[o].is_active() {
                found.extend([(Component::Wander(o), 1.0), (Component::Wander(o), 0.8)]);
            }
        }
        found
    }

    /// Forces of which none pushes as an earlier one does, and none does nothing or enters what is a
    /// definition.
    pub(crate) fn distinct(&self, path: &Path) -> Vec<usize> {
        self.pushing_alike(path).into_iter().map(|group| group[0]).collect()
    }

    /// Forces that do something, those together that push in the same direction.
    pub(crate) fn pushing_alike(&self, path: &Path) -> Vec<Vec<usize>> {
        let (n, nf) = (path.n, path.forces);
        let mut groups: Vec<Vec<usize>> = vec![];
        let plan = &self.model.plan;
        for c in (0..nf).filter(|&c| c >= plan.sizes.w || plan.may_push(c)) {
            let dot = |a: usize, b: usize| {
                path.g.chunks_exact((n * nf).max(1)).fold(0.0, |sum, g| {
                    sum + (0..n).map(|i| g[i * nf + a] * g[i * nf + b]).sum::<f64>()
                })
            };
            let own = dot(c, c);
            let alike = |other: usize| {
                let both = dot(c, other);
                both * both > (1.0 - 1e-9) * own * dot(other, other)
            };
            match groups.iter_mut().find(|group| alike(group[0])) {
                _ if !(own > 0.0) => {}
                Some(group) => group.push(c),
                None => groups.push(vec![c]),
            }
        }
        groups
    }

    /// The noise without what it can do without, of so many parts at least beside that of the sensors.
    fn pruned(&self, path: &Path, mut noise: Noise, least: usize) -> Noise {
        let penalty = 0.5 * self.observed().ln();
        let mut value = Pass::of(path, &noise, false).log_likelihood;
        let process = |c: &Component| !matches!(c, Component::Measurement(_));
        for component in noise.components().into_iter().filter(process) {
            if noise.components().iter().filter(|c| process(c)).count() <= least {
                break;
            }
            let mut less = noise.clone();
            place(&mut less, component, 0.0, 1.0);
            let (less, worse) = most_likely(path, &less, &less.components());
            if value - worse < penalty * (noise.count() - less.count()) as f64 {
                (noise, value) = (less, worse);
            }
        }
        noise
    }
}

/// Sets a component, with its pole.
pub(super) fn place(noise: &mut Noise, component: Component, variance: f64, pole: f64) {
    match component {
        Component::Slow(c) => noise.slow[c] = Slow::fading(variance, pole),
        Component::Wander(o) => noise.wander[o] = Slow::fading(variance, pole),
        _ => noise.set(component, variance),
    }
}
