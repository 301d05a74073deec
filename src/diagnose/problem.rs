//! A baseline and a record, ready to be asked "and if this were in it?".

use std::collections::HashMap;
use std::ops::Range;
use std::sync::{Arc, Mutex};

use rayon::prelude::*;

use super::candidate::{Candidate, Wire};
use crate::statistics::{deviation, mixture, rms};
use crate::system::{Base, Drive, Lane, Placed, Plan, System, SystemError};

/// Lanes that are simulated side by side in one piece of work.
const TOGETHER: usize = 64;

/// A cause that is part of a model, with its knobs.
#[derive(Debug, Clone)]
pub(crate) struct Added {
    pub cause: Arc<Candidate>,
    pub knobs: Vec<f64>,
}

/// A baseline with parameters, initial states and added causes.
#[derive(Debug, Clone)]
pub(crate) struct Model {
    pub theta: Vec<f64>,
    pub starts: Vec<Vec<f64>>,
    pub added: Vec<Added>,
}

impl Model {
    /// The same with one more cause.
    pub fn with(&self, cause: &Arc<Candidate>, knobs: Vec<f64>) -> Self {
        let mut model = self.clone();
        model.added.push(Added { cause: cause.clone(), knobs });
        model
    }

    /// The same without one of its causes.
    pub fn without(&self, index: usize) -> Self {
        let mut model = self.clone();
        model.added.remove(index);
        model
    }
}

/// One simulation that is wanted.
#[derive(Debug, Clone)]
pub(crate) struct Job {
    pub plan: Arc<Plan>,
    pub lane: Lane,
}

/// Outputs of one simulation, `None` where it diverged.
pub(crate) type Simulated = Option<Arc<Vec<Vec<f64>>>>;

/// Error of rough steps, as a share of the outputs' spread, at which the direction of a
/// small change is still right.
const ROUGH: f64 = 0.02;

/// Which integration steps a simulation takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Grain {
    /// As the model file says.
    Fine,
    /// Fewer, corrected by what that changes about the present model.
    Coarse,
    /// As few as still show in which direction a small change moves the outputs.
    Rough,
}

/// Which samples a simulation runs over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Span {
    /// The part that is fitted.
    Fit,
    /// All of it.
    Whole,
}

/// Parts of the records.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    /// What is fitted.
    Fit,
    /// What chooses between explanations.
    Choose,
    /// Both.
    All,
}

/// Samples at the start of a segment that do not count.
const SKIP: usize = 20;

/// A baseline and a record.
pub(crate) struct Problem<'a> {
    pub system: &'a System,
    pub base: Arc<Base>,
    coarse: Arc<Base>,
    rough: Arc<Base>,
    pub drive: Drive,
    fit_drive: Drive,
    /// Measured outputs; 0 where weight is 0.
    pub y: Vec<Vec<f64>>,
    /// Whether each output was measured at each sample.
    pub known: Vec<Vec<bool>>,
    /// 0 or 1 per output and sample: known and no spike.
    pub weight: Vec<Vec<f64>>,
    /// Scale of each output: residuals are divided by it before outputs are added up.
    pub scale: Vec<f64>,
    /// Samples that count: those that are fitted, those that choose.
    fit: Vec<Range<usize>>,
    choose: Vec<Range<usize>>,
    /// What coarse steps must be corrected by, from the last call of `correct`.
    correction: Option<Vec<Vec<f64>>>,
    plans: Mutex<HashMap<(Grain, Vec<String>), Arc<Plan>>>,
}

impl<'a> Problem<'a> {
    /// A baseline and records, one after the other in `drive`; `spans` are the records, of
    /// which the first `share` is fitted and the rest chooses.
    pub fn new(
        system: &'a System,
        sampling_time: f64,
        drive: Drive,
        measured: &[Vec<f64>],
        spans: &[Range<usize>],
        share: f64,
    ) -> Result<Self, SystemError> {
        let base = system.base(sampling_time)?;
        let split = |span: &Range<usize>| span.start + (share * span.len() as f64) as usize;
        let split_of = |k: usize| spans.iter().find(|s| s.contains(&k)).map_or(k, split);
        // empty segments stay in their place, so that each keeps its initial state
        let fit_segments: Vec<Range<usize>> = drive
            .segments
            .iter()
            .map(|s| s.start..s.end.min(split_of(s.start)).max(s.start))
            .collect();
        let end = fit_segments.iter().map(|s| s.end).max().unwrap_or(0);
        let fit_drive = Drive {
            inputs: drive.inputs.iter().map(|u| u[..end.min(u.len())].to_vec()).collect(),
            segments: fit_segments.clone(),
            origins: drive.origins.clone(),
        };
        let counted = |s: &Range<usize>| (s.start + SKIP.min(s.len() / 10))..s.end;
        let fit = fit_segments.iter().map(counted).filter(|s| !s.is_empty()).collect();
        // a segment that begins in the part that chooses starts from nobody knows where
        let choose = drive
            .segments
            .iter()
            .map(|s| (split_of(s.start), s))
            .filter(|(split, s)| s.start < *split && *split < s.end)
            .map(|(split, s)| split..s.end)
            .collect();
        let simulated = |k: usize| drive.segments.iter().any(|s| s.contains(&k));
        let known: Vec<Vec<bool>> = measured
            .iter()
            .map(|y| y.iter().enumerate().map(|(k, v)| v.is_finite() && simulated(k)).collect())
            .collect();
        let weight = known
            .iter()
            .map(|known| known.iter().map(|&known| f64::from(u8::from(known))).collect())
            .collect();
        let y = measured
            .iter()
            .map(|y| y.iter().map(|v| if v.is_finite() { *v } else { 0.0 }).collect());
        Ok(Self {
            coarse: base.clone(),
            rough: base.clone(),
            fit_drive,
            y: y.collect(),
            weight,
            known,
            scale: vec![1.0; measured.len()],
            fit,
            choose,
            correction: None,
            plans: Mutex::new(HashMap::new()),
            system,
            base,
            drive,
        })
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.drive.len()
    }

    /// Integration step of a grain, in s.
    pub fn step(&self, grain: Grain) -> f64 {
        let base = self.base_of(grain);
        base.sampling_time / base.substeps as f64
    }

    fn base_of(&self, grain: Grain) -> &Arc<Base> {
        match grain {
            Grain::Fine => &self.base,
            Grain::Coarse => &self.coarse,
            Grain::Rough => &self.rough,
        }
    }

    /// The baseline as it stands.
    pub fn baseline(&self) -> Model {
        let initial = self.base.signals.initial();
        Model {
            theta: self.base.signals.theta(),
            starts: vec![initial; self.drive.segments.len()],
            added: vec![],
        }
    }

    /// The plan of a list of effects on top of the system's own.
    pub fn plan(&self, grain: Grain, placed: &[Placed]) -> Option<Arc<Plan>> {
        let name = |p: &Placed| {
            let values = p.effect.card().values();
            // which bounds are absent decides what is free; the values themselves come later
            let absent: String =
                values.iter().map(|v| if v.is_finite() { 'f' } else { 'i' }).collect();
            let also: Vec<&str> = p.also_into.iter().map(|a| a.channel()).collect();
            format!("{}>{}<{:?}{absent}{also:?}", p.effect.typetag_name(), p.into, p.of)
        };
        let key = (grain, placed.iter().map(name).collect::<Vec<_>>());
        if let Some(plan) = self.plans.lock().ok()?.get(&key) {
            return Some(plan.clone());
        }
        let base = self.base_of(grain);
        let mut all = self.system.effects.clone();
        all.extend_from_slice(placed);
        let plan = Arc::new(Plan::new(base.clone(), &all).ok()?);
        self.plans.lock().ok()?.insert(key, plan.clone());
        Some(plan)
    }

    /// A plan of its own for effects whose shape is part of them (a free curve's knots).
    pub fn plan_anew(&self, grain: Grain, placed: &[Placed]) -> Option<Arc<Plan>> {
        let base = self.base_of(grain);
        let mut all = self.system.effects.clone();
        all.extend_from_slice(placed);
        Plan::new(base.clone(), &all).ok().map(Arc::new)
    }

    /// The simulation of a model.
    pub fn job(&self, model: &Model, grain: Grain) -> Option<Job> {
        let step = self.step(grain);
        let mut theta = model.theta.clone();
        let mut placed = vec![];
        let mut knobs: Vec<f64> = self.system.effects.iter().flat_map(own_knobs).collect();
        for added in &model.added {
            let own = added.cause.clipped(&added.knobs, step);
            match added.cause.wire {
                Wire::Parameter(p) => theta[p] += own[0],
                _ => {
                    placed.push(added.cause.placed(&own)?);
                    knobs.extend(own);
                }
            }
        }
        let plan = self.plan(grain, &placed)?;
        Some(Job {
            plan,
            lane: Lane { theta, starts: model.starts.clone(), knobs, ..Lane::default() },
        })
    }

    /// Runs many simulations, side by side and on all threads.
    pub fn run(&self, jobs: &[Job], span: Span) -> Vec<Simulated> {
        let drive = if span == Span::Fit { &self.fit_drive } else { &self.drive };
        // lanes of the same plan stand together
        let mut order: Vec<usize> = (0..jobs.len()).collect();
        let key = |i: usize| Arc::as_ptr(&jobs[i].plan) as usize;
        let mut first: HashMap<usize, usize> = HashMap::new();
        for i in 0..jobs.len() {
            first.entry(key(i)).or_insert(i);
        }
        order.sort_by_key(|&i| (first[&key(i)], i));
        let mut pieces: Vec<Vec<usize>> = vec![];
        let mut lanes: usize = 0;
        let mut previous = usize::MAX;
        for i in order {
            // a new plan begins a new pack of eight
            if previous != usize::MAX && key(previous) != key(i) {
                lanes = lanes.div_ceil(8) * 8;
            }
            if pieces.is_empty() || lanes >= TOGETHER {
                pieces.push(vec![]);
                lanes = 0;
            }
            if let Some(piece) = pieces.last_mut() {
                piece.push(i);
            }
            lanes += 1;
            previous = i;
        }
        let done: Vec<Vec<(usize, Simulated)>> =
            pieces.into_par_iter().map(|piece| self.run_piece(jobs, piece, drive)).collect();
        let mut results = vec![None; jobs.len()];
        for (i, result) in done.into_iter().flatten() {
            results[i] = result;
        }
        results
    }

    fn run_piece(&self, jobs: &[Job], piece: Vec<usize>, drive: &Drive) -> Vec<(usize, Simulated)> {
        let mut groups: Vec<(Arc<Plan>, Vec<Lane>, Vec<usize>)> = vec![];
        for i in piece {
            let job = &jobs[i];
            match groups.last_mut() {
                Some(group) if Arc::ptr_eq(&group.0, &job.plan) => {
                    group.1.push(job.lane.clone());
                    group.2.push(i);
                }
                _ => groups.push((job.plan.clone(), vec![job.lane.clone()], vec![i])),
            }
        }
        let lent: Vec<(&Plan, &[Lane])> = groups.iter().map(|g| (g.0.as_ref(), &g.1[..])).collect();
        let tracks = self.system.run_groups(drive, &lent);
        let mut results = vec![];
        for (group, tracks) in groups.iter().zip(tracks) {
            for (&i, track) in group.2.iter().zip(tracks) {
                let coarse = group.0.base.substeps != self.base.substeps;
                let result = track.is_finite().then(|| {
                    let mut y = track.y;
                    if let (true, Some(correction)) = (coarse, &self.correction) {
                        for (y, by) in y.iter_mut().zip(correction) {
                            for (y, by) in y.iter_mut().zip(by) {
                                *y += by;
                            }
                        }
                    }
                    Arc::new(y)
                });
                results.push((i, result));
            }
        }
        results
    }

    /// Outputs of one model over the whole record.
    pub fn simulate(&self, model: &Model, grain: Grain) -> Simulated {
        let job = self.job(model, grain)?;
        self.run(&[job], Span::Whole).swap_remove(0)
    }

    /// Picks the fewest steps whose error about this model is far below its residual, and
    /// corrects coarse simulations by it from now on.
    pub fn coarsen(&mut self, model: &Model) {
        self.correction = None;
        let Some(fine) = self.simulate(model, Grain::Fine) else { return };
        let residual = self.distance(&fine, &self.y);
        let spread: f64 = self
            .y
            .iter()
            .zip(&self.scale)
            .enumerate()
            .map(|(o, (y, s))| (deviation(&self.counted(o, y, Part::All)) / s).powi(2))
            .sum::<f64>()
            .sqrt();
        let allowed = (0.25 * residual).min(0.01 * spread);
        let n = self.base.substeps;
        let mut tried = vec![1, 2, 3, 4, 5, 6, 8, 10, 15, 20, 30, 50, 100, 200, 500, 1000];
        tried.retain(|&count| count <= n / 2);
        let mut rough = None;
        for count in tried {
            let Ok(mut base) = Base::new(
                self.system.model.as_ref(),
                &self.system.sampling,
                self.base.sampling_time,
            ) else {
                return;
            };
            base.substeps = count;
            self.take_steps(Arc::new(base), None);
            let Some(coarse) = self.simulate(model, Grain::Coarse) else { continue };
            let off = self.distance(&coarse, &fine);
            if off < ROUGH * spread && rough.is_none() {
                rough = Some(self.coarse.clone());
            }
            if off < allowed {
                self.take_steps(self.coarse.clone(), rough);
                self.correct(model, &fine);
                return;
            }
        }
        self.take_steps(self.base.clone(), rough);
    }

    /// Sets what coarse and rough steps are.
    fn take_steps(&mut self, coarse: Arc<Base>, rough: Option<Arc<Base>>) {
        self.rough = rough.unwrap_or(coarse.clone());
        self.coarse = coarse;
        if let Ok(mut plans) = self.plans.lock() {
            plans.retain(|key, _| key.0 == Grain::Fine);
        }
    }

    /// Corrects coarse simulations by their error about this model.
    pub fn recorrect(&mut self, model: &Model) {
        if self.coarse.substeps == self.base.substeps {
            return;
        }
        self.correction = None;
        if let Some(fine) = self.simulate(model, Grain::Fine) {
            self.correct(model, &fine);
        }
    }

    fn correct(&mut self, model: &Model, fine: &[Vec<f64>]) {
        self.correction = None;
        let Some(coarse) = self.simulate(model, Grain::Coarse) else { return };
        let off = |(f, c): (&Vec<f64>, &Vec<f64>)| {
            let difference = f.iter().zip(c).map(|(f, c)| f - c);
            difference.map(|d| if d.is_finite() { d } else { 0.0 }).collect()
        };
        self.correction = Some(fine.iter().zip(coarse.iter()).map(off).collect());
    }

    /// Root mean square over all outputs of what counts, in units of the scales.
    fn distance(&self, a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
        let mut sum = 0.0;
        let mut count = 0.0;
        for o in 0..self.y.len() {
            for k in self.samples(Part::All).filter(|&k| self.weight[o][k] > 0.0) {
                sum += ((a[o][k] - b[o][k]) / self.scale[o]).powi(2);
                count += 1.0;
            }
        }
        (sum / f64::max(count, 1.0)).sqrt()
    }

    /// Sets the outputs' scales to what this simulation leaves of each.
    pub fn rescale(&mut self, yhat: &[Vec<f64>]) {
        if self.y.len() < 2 {
            return;
        }
        for o in 0..self.y.len() {
            let off: Vec<f64> = self.y[o].iter().zip(&yhat[o]).map(|(a, b)| a - b).collect();
            let r = self.counted(o, &off, Part::All);
            let left = rms(&r);
            if left > 0.0 && left.is_finite() {
                self.scale[o] = left;
            }
        }
    }

    /// Samples that count in a part.
    pub fn samples(&self, part: Part) -> impl Iterator<Item = usize> + '_ {
        let (a, b): (&[Range<usize>], &[Range<usize>]) = match part {
            Part::Fit => (&self.fit, &[]),
            Part::Choose => (&self.choose, &[]),
            Part::All => (&self.fit, &self.choose),
        };
        a.iter().chain(b).cloned().flatten()
    }

    /// Weighted residuals y - yhat over a part, outputs one after the other.
    pub fn residual(&self, yhat: &[Vec<f64>], part: Part) -> Vec<f64> {
        let mut r = vec![];
        for o in 0..self.y.len() {
            let over = 1.0 / self.scale[o];
            let (y, yhat, weight) = (&self.y[o], &yhat[o], &self.weight[o]);
            r.extend(
                self.samples(part).map(
                    |k| {
                        if weight[k] > 0.0 { (y[k] - yhat[k]) * over } else { 0.0 }
                    },
                ),
            );
        }
        r
    }

    /// One output's values over a part, where they count.
    pub fn counted(&self, o: usize, values: &[f64], part: Part) -> Vec<f64> {
        self.samples(part).filter(|&k| self.weight[o][k] > 0.0).map(|k| values[k]).collect()
    }

    /// Products of two stacked series, added over outputs: one value per sample.
    pub fn per_sample(&self, a: &[f64], b: &[f64]) -> Vec<f64> {
        let n = a.len() / self.y.len().max(1);
        let mut q: Vec<f64> = a[..n].iter().zip(&b[..n]).map(|(a, b)| a * b).collect();
        for o in 1..self.y.len() {
            for (k, q) in q.iter_mut().enumerate() {
                *q += a[o * n + k] * b[o * n + k];
            }
        }
        q
    }

    /// Score that b is better than a on a part.
    pub fn better(&self, a: &[Vec<f64>], b: &[Vec<f64>], part: Part) -> f64 {
        let ra = self.residual(a, part);
        let rb = self.residual(b, part);
        let f: Vec<f64> = ra.iter().zip(&rb).map(|(a, b)| a - b).collect();
        let ff = self.per_sample(&f, &f);
        if ff.iter().sum::<f64>() < 1e-24 * ra.iter().map(|r| r * r).sum::<f64>() {
            return 0.0;
        }
        mixture(&ff, &self.per_sample(&f, &ra))
    }

    /// Mean square of the residual on a part, in units of the scales.
    pub fn mean_square(&self, yhat: &[Vec<f64>], part: Part) -> f64 {
        rms(&self.residual(yhat, part)).powi(2)
    }
}

/// Present knob values of an effect that the system already has.
fn own_knobs(placed: &Placed) -> Vec<f64> {
    use crate::effect::Mechanism;
    let card = placed.effect.card();
    if card.mechanism == Mechanism::Data { vec![] } else { card.values() }
}
