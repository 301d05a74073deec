//! The simulation: groups of lanes, each with its own effects, through one law.

mod asked;
mod jacobian;
mod passed;
mod program;
mod rates;
mod read_back;
mod recorded;
mod replayed;
mod simulated;
mod tracks;
mod transition;

use std::sync::Arc;

pub(crate) use recorded::record;

use crate::model::{Ask, Block, Law};
use crate::per_isa;

use super::arithmetic::{add, euler, move_along, rk4};
use super::exact::Exact;
use super::group::Group;
use super::lane::{Drive, Lane, Track, pack};
use super::plan::Plan;
use super::sampling::Method;
use super::wiring::EffectNumber;
use passed::Passed;

pub use jacobian::Jacobian;
pub use transition::Transition;

/// Magnitude beyond which a state counts as diverged.
const BEYOND: f64 = 1e150;

/// Simulates groups of lanes over all segments of a drive; all plans share one base.
///
/// With `seen`, every lane also records the table of sources at every sample.
pub fn simulate<R: EffectNumber>(
    law: &dyn Law,
    drive: &Drive,
    groups: &[(&Plan, &[Lane])],
    seen: bool,
) -> Vec<Vec<Track>> {
    let Some(mut run) = Run::<R>::new(law, groups) else { return vec![] };
    run.seen = seen;
    let n = drive.len();
    let base = groups[0].0;
    let blank = |count: usize| vec![vec![f64::NAN; n]; count];
    let track = |_: &Lane| Track {
        y: blank(base.sizes.y),
        diverged_at: None,
        seen: blank(if seen { base.sources.entries.len() } else { 0 }),
        last: vec![],
    };
    let mut tracks: Vec<Vec<Track>> =
        groups.iter().map(|(_, lanes)| lanes.iter().map(track).collect()).collect();
    for (number, segment) in drive.segments.iter().enumerate() {
        run.start(groups, number);
        run.clock = drive.clocks.get(number).copied().unwrap_or(0.0);
        for k in segment.clone() {
            run.sample(drive, k, segment.end, &mut tracks);
            if run.is_lost(&tracks) {
                break;
            }
        }
        run.hand_out(&mut tracks);
    }
    run.last(&mut tracks);
    tracks
}

per_isa! {
    /// One stage with whole registers moved at a time: what is stored in pieces is read back late.
    fn stage['a, R: EffectNumber](run: &mut Run<'a, R>, i: usize, slot: usize, time: f64) {
        run.rates(i, slot, time);
    }
}

/// Working storage of one block: what all packs share.
struct Run<'a, R> {
    base: &'a Plan,
    law: &'a dyn Law,
    packs: usize,
    groups: Vec<Group<'a, R>>,
    theta: Vec<R>,
    /// Parameters at this instant, where some drift.
    theta_now: Vec<R>,
    derived: Vec<R>,
    /// What the law derives from the parameters before they drift.
    still: Vec<R>,
    x: Vec<R>,
    xt: Vec<R>,
    /// Room for states or their rates.
    room: Vec<R>,
    k: [Vec<R>; 4],
    u: [Vec<R>; 3],
    /// Inputs behind their paths, where those of the one lane were worked out before.
    passed: Option<Arc<Passed>>,
    /// Inputs with what effects add, and what enters the own channels.
    u_in: Vec<R>,
    w: Vec<R>,
    no_w: Vec<R>,
    /// What else enters the own channels, the inputs and what sensors read: the disturbance of a filter.
    noise: Option<[Vec<R>; 3]>,
    /// How far inputs move until the next sample, where the law finds that in its channels.
    ramp: Vec<R>,
    ramped: bool,
    y: Vec<R>,
    /// The outputs as sensors give them, where the law reads them back.
    read: Vec<R>,
    /// Outputs of the last samples, the first of them, and whether sources are written down too.
    outputs: Vec<R>,
    outputs_from: usize,
    seen: bool,
    /// Whether some lane diverged.
    lost: bool,
    sums: Vec<R>,
    exact: Option<Exact<R>>,
    /// Whether any effect acts inside the stages.
    inside: bool,
    /// Whether any of them enters an input.
    into_inputs: bool,
    fine: bool,
    /// Whether parameters drift, and the time up to which they have.
    drifting: bool,
    drifted: Option<f64>,
    /// Whether parameters carry slopes that the exact step has to be told of.
    sloped: bool,
    first: bool,
    /// Time of sample 0.
    clock: f64,
    time: f64,
}

impl<'a, R: EffectNumber> Run<'a, R> {
    fn new(law: &'a dyn Law, groups: &[(&'a Plan, &[Lane])]) -> Option<Self> {
        let (base, _) = *groups.first()?;
        let n = base.sizes;
        let (mut packs, mut theta, mut all) = (0, vec![], vec![]);
        let mut made = vec![];
        for &(plan, lanes) in groups {
            let group = Group::<R>::new(plan, lanes, packs);
            let mut own = pack::<R>(lanes, group.packs, n.theta, |lane, i| lane.theta[i]);
            group.set_values(&mut own);
            theta.extend(own);
            // the exact step needs a lane for every place, also for those that repeat
            let last = lanes.len().saturating_sub(1);
            all.extend((0..group.packs * R::LANES).filter_map(|l| lanes.get(l.min(last))));
            packs += group.packs;
            made.push(group);
        }
        let zeros = |count: usize| vec![R::constant(0.0); packs * count];
        Some(Self {
            exact: base.linear.then(|| Exact::new(base, law, &all, packs)).flatten(),
            inside: made.iter().any(|group| group.inside),
            into_inputs: made.iter().any(Group::enters_inputs),
            drifting: made.iter().any(Group::is_drifting),
            drifted: None,
            sloped: false,
            fine: made.iter().any(|group| group.outputs.fine),
            theta_now: theta.clone(),
            groups: made,
            base,
            law,
            packs,
            theta,
            derived: zeros(n.derived),
            still: zeros(n.derived),
            x: zeros(n.x),
            xt: zeros(n.x),
            room: zeros(n.x),
            k: [zeros(n.x), zeros(n.x), zeros(n.x), zeros(n.x)],
            u: [zeros(n.u), zeros(n.u), zeros(n.u)],
            passed: None,
            u_in: zeros(n.u),
            w: zeros(n.w),
            no_w: zeros(n.w),
            noise: None,
            ramp: zeros(n.w),
            ramped: law.ramped(),
            y: zeros(n.y),
            read: zeros(if law.fed_back() { n.y } else { 0 }),
            outputs: vec![],
            outputs_from: 0,
            seen: false,
            lost: false,
            sums: zeros(1),
            first: true,
            clock: 0.0,
            time: 0.0,
        })
    }

    /// Puts every lane at the start of a segment.
    fn start(&mut self, groups: &[(&Plan, &[Lane])], segment: usize) {
        let n = self.base.sizes.x;
        let initial = self.base.signals.initial();
        for (group, (_, lanes)) in self.groups.iter_mut().zip(groups) {
            let x = pack::<R>(lanes, group.packs, n, |lane, i| {
                lane.starts.get(segment).or(lane.starts.last()).map_or(initial[i], |x| x[i])
            });
            self.x[group.first * n..][..x.len()].copy_from_slice(&x);
            group.restart();
        }
        self.first = true;
    }

    /// Gives the outputs at sample `k` and moves to the next one.
    fn sample(&mut self, drive: &Drive, k: usize, end: usize, tracks: &mut [Vec<Track>]) {
        for j in 0..self.base.substeps {
            self.begin(drive, k, end, j);
            if j == 0 {
                self.store(k, tracks);
            }
            self.finish();
        }
        self.watch(k, tracks);
    }

    /// Everything that is known at the start of step `j` of a sample: time, inputs, outputs.
    fn begin(&mut self, drive: &Drive, k: usize, end: usize, j: usize) {
        let (base, h) = (self.base, self.base.step());
        self.time = self.clock + (k as f64 * base.sampling_time + j as f64 * h);
        if self.drifting || self.drifted.is_none() {
            self.drift(self.time);
        }
        self.drive(drive, k, end, j);
        match &self.passed {
            Some(passed) => passed.put((k, j), &mut self.u),
            None => self.groups.iter_mut().for_each(|group| group.inputs(&mut self.u, h)),
        }
        if j == 0 || self.fine {
            self.output(h);
        }
    }

    /// The step itself.
    fn finish(&mut self) {
        self.advance(self.base.step());
        self.first = false;
        self.groups.iter_mut().for_each(Group::started);
    }

    /// Parameters at a given time, and what the law derives from them.
    fn drift(&mut self, time: f64) {
        let known = self.drifted.replace(time);
        if known == Some(time) || known.is_some() && !self.drifting {
            return;
        }
        let drifting = self.groups.iter().filter(|group| group.is_drifting());
        drifting.clone().for_each(|group| group.drift(time, &self.theta, &mut self.theta_now));
        let n = self.base.sizes;
        if n.derived == 0 {
            return;
        }
        let block = Block {
            sizes: n,
            packs: self.packs,
            theta: &self.theta,
            derived: &[],
            x: &self.x,
            u: &self.u[0],
            w: &self.w,
            read: &[],
            time: R::time(time),
        };
        if known.is_none() {
            self.law.answer(Ask::Derived, R::call(&block, &mut self.still));
            self.derived.copy_from_slice(&self.still);
        }
        let block = Block { theta: &self.theta_now, ..block };
        for group in drifting {
            let packs = group.places();
            let out = &mut self.derived[packs.start * n.derived..packs.end * n.derived];
            self.law.answer(Ask::Derived, R::call(&block.part(packs), out));
        }
    }

    /// Asks the law at the present or the trial state.
    fn ask(&mut self, ask: Ask, slot: usize, time: f64) {
        let block = Block {
            sizes: self.base.sizes,
            packs: self.packs,
            theta: &self.theta_now,
            derived: &self.derived,
            x: &self.x,
            u: &self.u[slot],
            w: &self.no_w,
            read: &[],
            time: R::time(time),
        };
        self.law.answer(ask, R::call(&block, &mut self.y));
    }

    /// Outputs now, after everything that sits in their paths.
    fn output(&mut self, h: f64) {
        self.ask(Ask::Output, 0, self.time);
        self.add_to_rates();
        let ny = self.base.sizes.y;
        for group in &mut self.groups {
            let packs = group.places();
            let seen = [&self.theta_now, &self.derived, &self.x, &self.u[0]];
            let at = group.instant(self.law, seen, self.time);
            let y = &mut self.y[packs.start * ny..packs.end * ny];
            group.outputs(&at, y, h, self.first);
        }
        self.read_back();
    }

    /// Rates of all states at a trial state: stage `i`, with the inputs at `slot`.
    fn stage(&mut self, i: usize, slot: usize, time: f64) {
        if self.drifting || self.drifted.is_none() {
            self.drift(time);
        }
        stage(self, i, slot, time);
    }

    /// The same, once parameters have drifted.
    #[inline(always)]
    fn rates(&mut self, i: usize, slot: usize, time: f64) {
        let base = self.base;
        let n = base.sizes;
        let x = if i == 0 { &self.x } else { &self.xt };
        let mut u = &self.u[slot];
        if self.inside {
            if self.into_inputs {
                self.u_in.copy_from_slice(u);
            }
            self.w.copy_from_slice(&self.ramp);
            if let Some([into_w, into_u, _]) = &self.noise {
                add(&mut self.w, into_w);
                add(&mut self.u_in, into_u);
            }
            for group in self.groups.iter_mut().filter(|group| group.inside) {
                let packs = group.places();
                let seen = [&self.theta_now, &self.derived, x, u];
                let at = group.instant(self.law, seen, time);
                let w = &mut self.w[packs.start * n.w..packs.end * n.w];
                let u_in = &mut self.u_in[packs.start * n.u..packs.end * n.u];
                group.enter(&at, i, w, u_in);
            }
            if self.into_inputs {
                u = &self.u_in;
            }
        }
        let out = &mut self.k[i];
        let block = Block {
            sizes: n,
            packs: self.packs,
            theta: &self.theta_now,
            derived: &self.derived,
            x,
            u,
            w: &self.w,
            read: &self.read,
            time: R::time(time),
        };
        if let Some(exact) = &mut self.exact {
            exact.note(i, u, &self.u[slot], &self.w);
            let still = Block { theta: &self.theta, derived: &self.still, ..block };
            for group in self.groups.iter().filter(|g| self.sloped || g.is_drifting()) {
                let packs = group.places();
                let rows = packs.start * n.x..packs.end * n.x;
                let (now, then) = (&mut out[rows.clone()], &mut self.room[rows.clone()]);
                self.law.answer(Ask::Derivative, R::call(&block.part(packs.clone()), now));
                self.law.answer(Ask::Derivative, R::call(&still.part(packs), then));
                exact.note_drift(i, rows.start, now, then);
            }
            return;
        }
        self.law.answer(Ask::Derivative, R::call(&block, out));
        if !base.declared_channels && self.inside {
            add(out, &self.w);
        }
    }

    /// One integration step, or one sample of a discrete law.
    fn advance(&mut self, h: f64) {
        let (t, base) = (self.time, self.base);
        if let (Some(exact), false) = (&self.exact, self.inside || self.drifting) {
            exact.finish(&mut self.x, &mut self.room, &self.u, false);
            return;
        }
        self.stage(0, 0, t);
        if !base.signals.time.is_continuous() {
            std::mem::swap(&mut self.x, &mut self.k[0]);
        } else if base.method == Method::Euler && self.exact.is_none() {
            move_along(&mut self.x, &self.k[0], h);
        } else {
            self.trial(0, h, 0.5);
            self.stage(1, 1, t + 0.5 * h);
            self.trial(1, h, 0.5);
            self.stage(2, 1, t + 0.5 * h);
            self.trial(2, h, 1.0);
            self.stage(3, 2, t + h);
            if let Some(exact) = &self.exact {
                exact.finish(&mut self.x, &mut self.room, &self.u, true);
            } else {
                rk4(&mut self.x, &self.k, h);
            }
            for group in &mut self.groups {
                rk4(&mut group.s, &group.ks, h);
                group.commit();
            }
            return;
        }
        for group in &mut self.groups {
            move_along(&mut group.s, &group.ks[0], h);
            group.commit();
        }
    }

    /// The trial state after stage `i`.
    fn trial(&mut self, i: usize, h: f64, share: f64) {
        if let Some(exact) = &self.exact {
            exact.trial(i, &mut self.xt, &self.x, &self.u);
        } else {
            euler(&mut self.xt, &self.x, &self.k[i], h * share);
        }
        for group in self.groups.iter_mut().filter(|group| !group.s.is_empty()) {
            euler(&mut group.st, &group.s, &group.ks[i], h * share);
        }
    }
}
