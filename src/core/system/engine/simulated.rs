//! A transition by the simulation itself, with dual numbers in the place of plain ones.
//!
//! One register of dual numbers carries 32 directions, so that a whole Jacobian costs one simulation.
//! What lags in the paths of outputs and plays remember are states too, after those of the effects: what is
//! measured tells about them. What is on its way in a delay line is taken as known.

use std::sync::Arc;

use super::super::lane::{Drive, Lane};
use super::super::outputs::OutputPaths;
use super::super::plan::Plan;
use super::super::remembered::Remembered;
use super::Run;
use super::jacobian::Jacobian;
use super::passed::Passed;
use crate::model::{Ask, Block, DIRECTIONS, Dual64, LaneNumber, Law};
use crate::real::{F64x8, Real};

/// Directions in one pack.
const IN_PACK: usize = DIRECTIONS * F64x8::LANES;

/// A system along a record, one sample at a time, with derivatives.
pub(super) struct Simulated<'a> {
    run: Run<'a, Dual64>,
    drive: &'a Drive,
    begin: usize,
    end: usize,
    packs: usize,
    /// Zero with the slopes of the state that it stands for, pack by pack.
    x: Vec<Dual64>,
    s: Vec<Dual64>,
    m: Vec<Dual64>,
    /// How many numbers lags of outputs and plays remember, and where a filter has them.
    kept: usize,
    kept_now: Vec<f64>,
    /// What the paths of outputs remembered before these were read, where they are read again from other states.
    before: Option<OutputPaths<Dual64>>,
    parameters: bool,
}

/// What a transition remembers beside states, before it observes a sample.
pub(super) struct Memory {
    of: Remembered<Dual64>,
    /// Whether the sample is the first of its segment.
    first: bool,
}

impl<'a> Simulated<'a> {
    /// A law and a record; `parameters` says whether derivatives along them are wanted.
    pub fn new(
        law: &'a dyn Law,
        (plan, drive): (&'a Plan, &'a Drive),
        (lane, passed): (&Lane, Option<Arc<Passed>>),
        parameters: bool,
    ) -> Option<Self> {
        let n = plan.sizes;
        let read = if law.fed_back() { n.y } else { 0 };
        let kept = Run::<Dual64>::new(law, &[(plan, std::slice::from_ref(lane))])?.groups[0]
            .kept()
            .count();
        let (states, entering) = (n.x + plan.states + kept, n.w + n.u + read);
        let directions = states + entering + if parameters { n.theta } else { 0 };
        let packs = directions.div_ceil(IN_PACK).max(1);
        // a lane for every place: every one carries other directions of the same run
        let lanes = vec![lane.clone(); packs * F64x8::LANES];
        let mut run = Run::<Dual64>::new(law, &[(plan, &lanes)])?;
        (run.inside, run.into_inputs, run.passed) = (true, true, passed);
        let blank = |count: usize| vec![Dual64::constant(0.0); packs * count];
        let mut noise = [blank(n.w), blank(n.u), blank(read)];
        let mut transition = Self {
            drive,
            begin: 0,
            end: 0,
            packs,
            x: blank(n.x),
            s: blank(plan.states),
            m: blank(kept),
            kept,
            kept_now: vec![0.0; kept],
            before: None,
            parameters,
            run: {
                run.groups.iter_mut().for_each(|group| group.inside = true);
                run
            },
        };
        let mut first = 0;
        sloped(&mut transition.x, n.x, &mut first);
        sloped(&mut transition.s, plan.states, &mut first);
        sloped(&mut transition.m, kept, &mut first);
        sloped(&mut noise[0], n.w, &mut first);
        sloped(&mut noise[1], n.u, &mut first);
        sloped(&mut noise[2], read, &mut first);
        transition.run.noise = Some(noise);
        transition.run.drift(0.0);
        if parameters {
            sloped(&mut transition.run.theta_now, n.theta, &mut first);
            transition.run.sloped = true;
            transition.derive();
        }
        Some(transition)
    }

    /// What the law derives from parameters, with their slopes.
    fn derive(&mut self) {
        let run = &mut self.run;
        let block = Block {
            sizes: run.base.sizes,
            packs: self.packs,
            theta: &run.theta_now,
            derived: &[],
            x: &run.x,
            u: &run.u[0],
            w: &run.no_w,
            read: &[],
            time: Dual64::constant(0.0),
        };
        if run.base.sizes.derived > 0 {
            run.law.answer(Ask::Derived, Dual64::call(&block, &mut run.derived));
        }
    }

    /// States of the model and of its effects, and what lags of outputs and plays remember.
    pub fn states(&self) -> usize {
        self.run.base.sizes.x + self.run.base.states + self.kept
    }

    /// Own channels and inputs.
    pub fn forces(&self) -> usize {
        self.run.base.sizes.w + self.run.base.sizes.u
    }

    /// All that enters: own channels, inputs, and what sensors read where that is fed back.
    fn entering(&self) -> usize {
        self.forces() + self.run.read.len() / self.packs
    }

    pub fn start(&mut self, segment: usize) {
        self.run.clock = self.drive.clocks.get(segment).copied().unwrap_or(0.0);
        let samples = &self.drive.segments[segment];
        (self.begin, self.end) = (samples.start, samples.end);
        self.run.groups.iter_mut().for_each(super::Group::restart);
        self.run.first = true;
    }

    /// Whether anything is remembered beside states.
    pub fn remembers(&self) -> bool {
        self.run.groups[0].outputs.has_delays()
    }

    /// What it remembers beside states.
    pub fn memory(&self) -> Memory {
        Memory { of: self.run.groups[0].memory(), first: self.run.first }
    }

    /// Goes back to what it remembered.
    pub fn recall(&mut self, memory: &Memory) {
        self.run.groups[0].recall(&memory.of);
        self.run.first = memory.first;
    }

    pub fn place(&mut self, x: &[f64]) {
        let (nx, ns) = (self.run.base.sizes.x, self.run.base.states);
        put(&mut self.run.x, &self.x, &x[..nx]);
        put(&mut self.run.groups[0].s, &self.s, &x[nx..][..ns]);
        self.kept_now.copy_from_slice(&x[nx + ns..]);
        self.place_kept();
    }

    /// Puts what is remembered where the filter has it.
    fn place_kept(&mut self) {
        for (i, all) in self.run.groups[0].kept().enumerate() {
            for (to, with) in all.iter_mut().zip(self.m.iter().skip(i).step_by(self.kept)) {
                let value = F64x8::constant(self.kept_now[i]);
                *to = Dual64 { value, slope: with.slope };
            }
        }
    }

    pub fn observe(&mut self, k: usize, y: &mut [f64], c: &mut [f64], theta: &mut [f64]) {
        let drive = self.drive;
        // what enters is told apart from what is read without it
        for to in self.run.noise.iter_mut().flatten().flatten() {
            to.value = F64x8::constant(0.0);
        }
        let is_read_again = self.kept > 0 || self.remembers() || !self.run.read.is_empty();
        if self.run.first && k > self.begin {
            // what was remembered before is part of the states
            self.run.first = false;
            self.run.groups[0].resume();
        }
        self.before = is_read_again.then(|| self.run.groups[0].outputs.clone());
        self.run.begin(drive, k, self.end, 0);
        let (n, ny) = (self.states(), self.run.base.sizes.y);
        for o in 0..ny {
            y[o] = self.run.y[o].lane(0);
            slopes(&self.run.y, (ny, o), 0, &mut c[o * n..][..n]);
        }
        if self.parameters {
            let (nt, first) = (self.run.base.sizes.theta, n + self.entering());
            for o in 0..ny {
                slopes(&self.run.y, (ny, o), first, &mut theta[o * nt..][..nt]);
            }
        }
    }

    pub fn direct(&self, d: &mut [f64]) {
        let (forces, ny) = (self.forces(), self.run.base.sizes.y);
        for o in 0..ny {
            slopes(&self.run.y, (ny, o), self.states(), &mut d[o * forces..][..forces]);
        }
    }

    pub fn see(&mut self, seen: &mut [f64]) {
        let run = &mut self.run;
        let now = [&run.theta_now, &run.derived, &run.x, &run.u[0]];
        let group = &mut run.groups[0];
        let at = group.instant(run.law, now, run.time);
        for (to, from) in seen.iter_mut().zip(group.table(&at)) {
            *to = from.lane(0);
        }
    }

    pub fn advance(&mut self, k: usize, w: &[f64], x: &mut [f64], to: &mut Jacobian) {
        let (drive, base) = (self.drive, self.run.base);
        let (n, nx, nw) = (self.states(), base.sizes.x, base.sizes.w);
        if let Some([into_w, into_u, _]) = &mut self.run.noise {
            for (all, w) in [(into_w, &w[..nw]), (into_u, &w[nw..])] {
                for pack in all.chunks_exact_mut(w.len().max(1)) {
                    pack.iter_mut().zip(w).for_each(|(to, &w)| to.value = F64x8::constant(w));
                }
            }
        }
        // what is fed back or remembered is read where the states are now
        if let Some(before) = self.before.take() {
            self.run.groups[0].outputs = before;
            self.place_kept();
            self.run.output(base.step());
        }
        self.run.finish();
        for j in 1..base.substeps {
            self.run.begin(drive, k, self.end, j);
            self.run.finish();
        }
        let (forces, entering) = (self.forces(), self.entering());
        let (read, nt) = (entering - forces, to.theta.len() / n.max(1));
        let kept: Vec<Vec<Dual64>> = self.run.groups[0].kept().map(|all| all.clone()).collect();
        for i in 0..n {
            let (all, at) = match i.checked_sub(nx) {
                None => (&self.run.x, (nx, i)),
                Some(i) => match i.checked_sub(base.states) {
                    None => (&self.run.groups[0].s, (base.states, i)),
                    Some(i) => (&kept[i], (1, 0)),
                },
            };
            x[i] = all[at.1].lane(0);
            slopes(all, at, 0, &mut to.a[i * n..][..n]);
            slopes(all, at, n, &mut to.g[i * forces..][..forces]);
            slopes(all, at, n + forces, &mut to.read[i * read..][..read]);
            slopes(all, at, n + entering, &mut to.theta[i * nt..][..nt]);
        }
    }
}

/// Gives `n` values per pack the slopes of the directions from `first` on.
fn sloped(values: &mut [Dual64], n: usize, first: &mut usize) {
    for i in 0..n {
        let d = *first + i;
        let (pack, lane, slope) = (d / IN_PACK, d % IN_PACK / DIRECTIONS, d % DIRECTIONS);
        values[pack * n + i].slope[slope].0[lane] = 1.0;
    }
    *first += n;
}

/// Writes values into all packs, each with its own slopes.
fn put(to: &mut [Dual64], slopes: &[Dual64], values: &[f64]) {
    let n = values.len().max(1);
    for (i, (to, with)) in to.iter_mut().zip(slopes).enumerate() {
        *to = Dual64 { value: F64x8::constant(values[i % n]), slope: with.slope };
    }
}

/// Reads the slopes of value `i` of `n` along the directions from `first` on.
fn slopes(values: &[Dual64], (n, i): (usize, usize), first: usize, to: &mut [f64]) {
    for (j, to) in to.iter_mut().enumerate() {
        let d = first + j;
        let (pack, lane, slope) = (d / IN_PACK, d % IN_PACK / DIRECTIONS, d % DIRECTIONS);
        *to = values[pack * n + i].slope[slope].0[lane];
    }
}
