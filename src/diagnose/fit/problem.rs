//! A baseline and a record, ready to be asked "and if this were in it?".

use std::collections::HashMap;
use std::ops::Range;
use std::sync::{Arc, Mutex};

use rayon::prelude::*;

use crate::candidates::candidate::Wire;
use crate::fit::simulation_cache::Remembered;
pub(crate) use crate::fit::supposed::{Added, Grain, Model, Simulated};
use crate::fit::work::Work;
use crate::memory::Memory;
use crate::system::{Base, Drive, Lane, Placed, Plan, System, SystemError};

/// Lanes that are one block of numbers.
const PACK: usize = 8;
/// Blocks that are simulated side by side in one piece of work, at most, and bytes of parameters that they
/// may have: every sample goes through all of them, so that they should stay in a cache of the processor.
const PACKS_AT_ONCE: usize = 8;
const CACHE: usize = 256 << 10;

/// Share of the memory that simulations side by side may take, and bytes beyond which more of them are no
/// faster, where every thread has a block.
const AT_ONCE: u64 = 12;
const ENOUGH: usize = 128 << 20;

/// One simulation that is wanted.
#[derive(Debug, Clone)]
pub(crate) struct Job {
    pub plan: Arc<Plan>,
    pub lane: Lane,
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

impl Part {
    /// What has to be simulated for that.
    pub fn span(self) -> Span {
        match self {
            Self::Choose | Self::All => Span::Whole,
            Self::Fit => Span::Fit,
        }
    }
}

/// Samples at the start of a segment that do not count.
const SKIP: usize = 20;

/// A baseline and a record.
pub(crate) struct Problem<'a> {
    pub system: &'a System,
    pub base: Arc<Base>,
    pub(crate) coarse: Arc<Base>,
    pub(crate) rough: Arc<Base>,
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
    pub(crate) fit: Vec<Range<usize>>,
    pub(crate) choose: Vec<Range<usize>>,
    /// What coarse steps must be corrected by; set it with `set_correction`.
    pub(crate) correction: Option<Vec<Vec<f64>>>,
    pub(crate) plans: Mutex<HashMap<(Grain, Vec<String>), Arc<Plan>>>,
    /// Simulations that may be asked for again.
    pub(crate) remembered: Remembered,
    /// What it may take, and how much work is done.
    pub(crate) memory: Memory,
    pub(crate) work: Work,
    /// Simulations that were asked for.
    #[cfg(test)]
    pub(crate) simulations: std::sync::atomic::AtomicUsize,
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
            clocks: drive.clocks.clone(),
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
            remembered: Remembered::default(),
            memory: Memory::default(),
            work: Work::default(),
            #[cfg(test)]
            simulations: std::sync::atomic::AtomicUsize::new(0),
            system,
            base,
            drive,
        })
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.drive.len()
    }

    /// What drives the part that is fitted.
    pub fn fit_drive(&self) -> &Drive {
        &self.fit_drive
    }

    /// Samples that are simulated for the part that is fitted.
    pub fn simulated(&self) -> Vec<usize> {
        self.fit_drive.segments.iter().cloned().flatten().collect()
    }

    /// Simulations whose outputs memory holds side by side.
    pub fn at_once(&self, span: Span) -> usize {
        let samples = if span == Span::Fit { self.fit_drive.len() } else { self.len() };
        let each = (8 * samples * self.y.len()).max(1);
        let enough = (ENOUGH / each).max(PACK * rayon::current_num_threads());
        (self.memory.part(AT_ONCE) / each).min(enough).max(PACK)
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
            let of = (&p.of, &p.also_of);
            format!("{}>{}<{of:?}{absent}{also:?}", p.effect.typetag_name(), p.into)
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
        let theta = model.parameters();
        let mut placed = vec![];
        let mut effect_values: Vec<f64> = self.system.effects.iter().flat_map(own_values).collect();
        for added in &model.added {
            if !matches!(added.cause.wire, Wire::Parameter(_)) {
                let own = added.cause.clipped(&added.parameters, step, &theta);
                placed.push(added.cause.placed(&own)?);
                effect_values.extend(own);
            }
        }
        let plan = self.plan(grain, &placed)?;
        Some(Job {
            plan,
            lane: Lane { theta, starts: model.starts.clone(), effect_values, ..Lane::default() },
        })
    }

    /// Runs many simulations, side by side and on all threads.
    pub fn run(&self, jobs: &[Job], span: Span) -> Vec<Simulated> {
        #[cfg(test)]
        self.simulations.fetch_add(jobs.len(), std::sync::atomic::Ordering::Relaxed);
        let drive = if span == Span::Fit { &self.fit_drive } else { &self.drive };
        // lanes of the same plan stand together
        let mut order: Vec<usize> = (0..jobs.len()).collect();
        let key = |i: usize| Arc::as_ptr(&jobs[i].plan) as usize;
        let mut first: HashMap<usize, usize> = HashMap::new();
        for i in 0..jobs.len() {
            first.entry(key(i)).or_insert(i);
        }
        order.sort_by_key(|&i| (first[&key(i)], i));
        // a new plan begins a new pack of eight; packs are dealt out to all threads alike, and no
        // lane knows which others run beside it
        let mut packs: Vec<Vec<usize>> = vec![];
        for i in order {
            match packs.last_mut() {
                Some(pack) if pack.len() < PACK && key(pack[0]) == key(i) => pack.push(i),
                _ => packs.push(vec![i]),
            }
        }
        let threads = rayon::current_num_threads();
        let parameters = 8 * PACK * self.base.signals.parameters.len();
        let most = (CACHE / parameters.max(1)).clamp(1, PACKS_AT_ONCE);
        let rounds = packs.len().div_ceil(threads * most).max(1);
        let share = packs.len().div_ceil(threads * rounds).max(1);
        let pieces: Vec<Vec<usize>> = packs.chunks(share).map(<[_]>::concat).collect();
        let done: Vec<Vec<(usize, Simulated)>> =
            pieces.into_par_iter().map(|piece| self.run_piece(jobs, piece, drive)).collect();
        let mut results = vec![None; jobs.len()];
        for (i, result) in done.into_iter().flatten() {
            results[i] = result;
        }
        results
    }

    /// The same, where some simulations cannot even be built.
    pub fn run_built(&self, jobs: &[Option<Job>], span: Span) -> Vec<Simulated> {
        let built: Vec<Job> = jobs.iter().flatten().cloned().collect();
        let mut answers = self.run(&built, span).into_iter();
        jobs.iter().map(|job| job.as_ref().and_then(|_| answers.next().flatten())).collect()
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
        self.simulate_all(&[model], grain).swap_remove(0)
    }

    /// The outputs of a model over the whole record, where they are known.
    pub fn known_run(&self, model: &Model, grain: Grain) -> Simulated {
        self.remembered.recall(model, self.plainest(grain)).flatten()
    }

    /// The grain by another name, where its steps are the integrator's own.
    fn plainest(&self, grain: Grain) -> Grain {
        let is_own = self.base_of(grain).substeps == self.base.substeps;
        if is_own { Grain::Fine } else { grain }
    }

    /// Outputs of several models over the whole record.
    pub fn simulate_all(&self, models: &[&Model], grain: Grain) -> Vec<Simulated> {
        let grain = self.plainest(grain);
        let mut answers: Vec<Option<Simulated>> =
            models.iter().map(|model| self.remembered.recall(model, grain)).collect();
        let open: Vec<usize> = (0..models.len()).filter(|&i| answers[i].is_none()).collect();
        let jobs: Vec<Option<Job>> = open.iter().map(|&i| self.job(models[i], grain)).collect();
        for (&i, y) in open.iter().zip(self.run_built(&jobs, Span::Whole)) {
            self.remembered.keep(models[i], grain, &y);
            answers[i] = Some(y);
        }
        answers.into_iter().map(Option::flatten).collect()
    }
}

/// Present parameter values of an effect that the system already has.
fn own_values(placed: &Placed) -> Vec<f64> {
    use crate::effect::Mechanism;
    let card = placed.effect.card();
    if card.mechanism == Mechanism::Data { vec![] } else { card.values() }
}
