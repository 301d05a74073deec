//! The missing force as a signal: a smoother with a slow process on one channel, or in an output equation that is
//! a balance of its own, no law assumed.
//!
//! x[k+1] = F(x, u, m), m[k+1] = pole m[k] + increments, y = h(x, u, m) + v: the variances of increments and of
//! v and the pole by maximum likelihood, then E(m[k] | all y) and its standard deviation, and the share that each
//! coordinate, along the smoothed states, explains of it. A picture and a proposer, no judge: a smoother
//! blurs steps, and an offset of the channel is part of the force.
//! Sources: Rauch, Tung and Striebel, AIAA J. 3, 1965; Durbin and Koopman, 2012, ch. 4.

use rayon::prelude::*;

use super::error::LikelihoodError;
use super::follow::Wanted;
use super::intensities::most_likely;
use super::lacking::{ALIKE, Lacking, POLES};
use super::layout::Layout;
use super::noise::Noise;
use super::path::Path;
use super::predictor::{Predictor, column, starts};
use super::replay::Pass;
use super::share::share;
use crate::system::Transition;

/// Samples left out at both ends of the record: a smoother knows one side only there.
const ENDS: f64 = 0.01;

/// One channel's missing force.
#[derive(Debug, Clone, PartialEq)]
pub struct MissingForce {
    /// Channel, input or output that it would enter.
    pub channel: String,
    /// Its unit.
    pub unit: String,
    /// Root mean square of the force about 0, in its unit.
    pub rms: f64,
    /// How much more likely the record is with it than with measurement noise alone (natural
    /// logarithm).
    pub gain: f64,
    /// The smoothed force, sample by sample.
    pub values: Vec<f64>,
    /// Its standard deviation, sample by sample.
    pub band: Vec<f64>,
    /// What explains it, the largest share first.
    pub explained_by: Vec<Explained>,
    /// Other channels that explain the record as well.
    pub alike: Vec<String>,
}

/// The share of a missing force that one coordinate explains.
#[derive(Debug, Clone, PartialEq)]
pub struct Explained {
    /// Coordinate.
    pub coordinate: String,
    /// Its unit.
    pub unit: String,
    /// R^2 on data not used to fit the curve, between 0 and 1.
    pub share: f64,
    /// The curve: coordinate and force.
    pub curve: Vec<(f64, f64)>,
    /// The coordinate along the smoothed states, sample by sample.
    pub values: Vec<f64>,
}

impl MissingForce {
    /// Whether the record calls for it: odds of more than 20 to 1 against measurement noise alone.
    pub fn is_seen(&self) -> bool {
        self.gain > ALIKE
    }
}

impl Predictor {
    /// The missing force of every channel and input, and of outputs that are balances of their own (torques
    /// of an inverse dynamic model), the one that is explained best first.
    ///
    /// Channels that push as an earlier one does are left out.
    ///
    /// # Errors
    ///
    /// [`LikelihoodError::Diverges`] if no noise keeps the predictor among the finite numbers.
    pub fn missing(&self) -> Result<Vec<MissingForce>, LikelihoodError> {
        self.missing_of(usize::MAX, &|| false)
    }

    /// The same of so many channels at most, those in which a walk makes the record most likely before any fit; of
    /// fewer where somebody asks to stop.
    ///
    /// # Errors
    ///
    /// As [`missing`](Self::missing).
    #[doc(hidden)]
    pub fn missing_of(
        &self,
        most: usize,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Result<Vec<MissingForce>, LikelihoodError> {
        if stop() {
            return Ok(vec![]);
        }
        let path = self.tracking(&self.model)?;
        let start = self.white(self.spread.iter().map(|s| s * s + f64::MIN_POSITIVE).collect());
        let without = most_likely(&path, &start, &start.components()).1;
        let mut sites = self.lacking(&path);
        if sites.len() > most {
            let likely = |(i, &site): (usize, &Lacking)| (self.begun(&path, site, POLES[0]).1, i);
            let mut order: Vec<(f64, usize)> = sites.par_iter().enumerate().map(likely).collect();
            order.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
            sites = order.into_iter().map(|(_, i)| sites[i]).take(most).collect();
        }
        let force = |&site: &Lacking| (!stop()).then(|| self.force(&path, site, without));
        let mut found = sites.par_iter().filter_map(force).collect::<Result<Vec<_>, _>>()?;
        let values: Vec<(String, f64)> =
            found.iter().map(|f| (f.channel.clone(), f.gain)).collect();
        for force in &mut found {
            let near = |gain: f64| (gain - force.gain).abs() < ALIKE && gain > ALIKE;
            let others = values.iter().filter(|(name, gain)| *name != force.channel && near(*gain));
            force.alike = others.map(|(name, _)| name.clone()).collect();
        }
        let first = |f: &MissingForce| f.explained_by.first().map_or(0.0, |e| e.share);
        found.sort_by(|a, b| first(b).total_cmp(&first(a)));
        Ok(found)
    }

    /// Where something may be missing: distinct forces, and measured outputs that are balances.
    fn lacking(&self, path: &Path) -> Vec<Lacking> {
        let is = |&o: &usize| self.model.plan.output_equations.balances[o] && self.spread[o] > 0.0;
        let outputs = (0..path.outputs).filter(is).map(Lacking::Output);
        self.distinct(path).into_iter().map(Lacking::Force).chain(outputs).collect()
    }

    fn force(
        &self,
        path: &Path,
        at: Lacking,
        without: f64,
    ) -> Result<MissingForce, LikelihoodError> {
        let mut noise = self.walking(path, at);
        let mut run = self.run(&self.model, &noise, Wanted::default())?;
        if run.log_likelihood.is_finite() {
            noise = most_likely(&run.path, &noise, &noise.components()).0;
            let gate = Some(self.gate());
            run = self.run(&self.model, &noise, Wanted { gate, ..Wanted::default() })?;
        }
        if let Some(sample) = run.diverged_at {
            let time = sample as f64 * self.model.plan.sampling_time;
            return Err(LikelihoodError::Diverges { sample, time });
        }
        let (path, layout) = (&run.path, Layout::of(&run.path, &noise));
        let smoothed = Pass::of(path, &noise, true).smoothed(path, &noise);
        let (n, na) = (path.n, layout.len());
        let values = column(&smoothed.mean, na, n);
        let band = column(&smoothed.variance, na, n).into_iter().map(f64::sqrt).collect();
        let states: Vec<f64> = (0..path.len * n)
            .map(|at| {
                let (k, i) = (at / n, at % n);
                path.states[at] - path.jump[at] + smoothed.mean[k * na + i]
            })
            .collect();
        let (channel, unit) = match at {
            Lacking::Output(o) => self.outputs().swap_remove(o),
            Lacking::Force(c) => self.forces().swap_remove(c),
        };
        let rms = (values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64).sqrt();
        let explained_by = self.explained(at, &states, &values)?;
        let gain = run.log_likelihood - without;
        let alike = vec![];
        Ok(MissingForce { channel, unit, rms, gain, values, band, explained_by, alike })
    }

    /// The shares of every coordinate in a force, the largest first; `states` are where to look.
    fn explained(
        &self,
        at: Lacking,
        states: &[f64],
        force: &[f64],
    ) -> Result<Vec<Explained>, LikelihoodError> {
        let plan = &self.model.plan;
        let entries = plan.sources.entries.len();
        let seen = self.seen(states)?;
        let n = force.len();
        let cut = (ENDS * n as f64) as usize;
        // an output has no law of an output
        let into_output = matches!(at, Lacking::Output(_));
        let mut found: Vec<Explained> = (0..plan.sources.named)
            .filter(|&e| !(into_output && plan.sources.is_output(e)))
            .filter(|&e| !(0..e).any(|other| plan.rates.same(e, other)))
            .filter_map(|e| {
                let values = column(&seen, entries, e);
                let own = share(&values[cut..n - cut], &force[cut..n - cut])?;
                let signal = &plan.sources.entries[e].0;
                Some(Explained {
                    coordinate: signal.name.clone(),
                    unit: signal.unit.clone(),
                    share: own.share,
                    curve: own.curve,
                    values,
                })
            })
            .collect();
        found.sort_by(|a, b| b.share.total_cmp(&a.share));
        Ok(found)
    }

    /// The table of sources along given states.
    pub(crate) fn seen(&self, states: &[f64]) -> Result<Vec<f64>, LikelihoodError> {
        let (plan, theta) = (&self.model.plan, &self.model.theta);
        let effect_values = plan.effect_values();
        let given = (&theta[..], &effect_values[..]);
        let plant = Transition::new(&self.system, plan, &self.drive, given, false);
        let mut plant = plant.ok_or(LikelihoodError::Diverges { sample: 0, time: 0.0 })?;
        let (n, ny, entries) = (plant.states(), plan.sizes.y, plan.sources.entries.len());
        let mut seen = vec![f64::NAN; self.len() * entries];
        let (mut y, mut c) = (vec![0.0; ny], vec![0.0; ny * n]);
        for (number, segment) in self.drive.segments.iter().enumerate() {
            plant.start(number);
            for k in segment.clone() {
                plant.place(&states[k * n..][..n]);
                plant.observe(k, &mut y, &mut c, &mut []);
                plant.see(&mut seen[k * entries..][..entries]);
            }
        }
        Ok(seen)
    }

    /// Starts each segment where the smoother of a fitted noise finds it.
    ///
    /// What is believed beforehand is a guess of the model file; after this it is what the whole
    /// record says, with the same uncertainty. Every hypothesis that is compared has the same.
    pub(crate) fn settle(&mut self, path: &Path, noise: &Noise) {
        let pass = Pass::of(path, noise, true);
        let layout = Layout::of(path, noise);
        let smoothed = pass.smoothed(path, noise);
        let nx = self.start.p0.len();
        let found = starts(path, &smoothed.mean, &layout);
        if found.iter().flatten().all(|x| x.is_finite()) {
            self.start.x = found.into_iter().map(|x| x[..nx].to_vec()).collect();
        }
    }
}
