//! A baseline's law prepared for blocks of samples.

use std::ops::Range;

use crate::model::{Ask, Block, DIRECTIONS, LaneNumber, Law, March, Pull, Sizes, Way};
use crate::network::Row;
use crate::real::Real;

use super::Baseline;
use super::adjoint::Adjoint;
use super::block::Pace;
use super::number::{Number, lanes, per_row, repeated};
use super::timed::looks_at_time;

/// Bytes of parameters that a law is asked with at once: a third of what is nearest.
const NEAR: usize = 12 * 1024;

/// A baseline prepared for one precision and one value of its parameters.
pub(crate) struct Driver<'a, E: Number> {
    pub(super) law: &'a dyn Law,
    pub sizes: Sizes,
    pub pace: Pace,
    pub(super) free: Vec<usize>,
    pub(super) theta: Vec<f64>,
    /// Whether derivatives along the inputs are wanted.
    pub(super) wants_u: bool,
    /// Whether the law looks at the time, and whether inputs move between samples.
    pub(super) timed: bool,
    pub(super) ramps: bool,
    /// Whether the law has an adjoint of its own that will do.
    pub(super) adjoint: bool,
    /// Whether the law has a kernel that takes a whole sample at once.
    pub(super) whole: bool,
    /// What the law does, recorded: for its derivative, and for its outputs.
    recorded: Option<[Adjoint; 2]>,
    /// Whether its answers are computed from that too.
    pub(super) replays: bool,
    /// What the law derives from its parameters, once.
    derived: Vec<f64>,
    pub(super) plain: Constants<E::Lanes>,
    pub(super) groups: Vec<Group<E>>,
}

/// What stays the same from sample to sample, once for each pack.
pub(super) struct Constants<R> {
    pub theta: Vec<R>,
    pub derived: Vec<R>,
    pub w: Vec<R>,
}

/// Directions that dual numbers carry at once: states, wanted inputs and free parameters, in
/// this order, cut into groups.
pub(super) struct Group<E: Number> {
    pub range: Range<usize>,
    pub constants: Constants<E::Slopes>,
}

/// What a law looks at: z = [x; u] row by row, and how far the inputs move until the next
/// sample (empty where they are held), and the time.
#[derive(Clone, Copy)]
pub(crate) struct Sight<'a, E: Number> {
    pub z: &'a [Row<E>],
    pub du: &'a [Row<E>],
    pub time: &'a Row<E>,
}

impl<'a, E: Number> Driver<'a, E> {
    /// A baseline at the values of its parameters.
    pub fn new(baseline: &'a Baseline, wants_u: bool) -> Self {
        let law: &dyn Law = baseline.system.model.as_ref();
        let empty = Constants { theta: vec![], derived: vec![], w: vec![] };
        let mut driver = Self {
            law,
            sizes: baseline.sizes(),
            pace: baseline.pace(),
            free: baseline.free.clone(),
            theta: vec![],
            wants_u,
            timed: looks_at_time(law),
            ramps: baseline.ramps(),
            adjoint: false,
            whole: false,
            recorded: None,
            replays: false,
            derived: vec![],
            plain: empty,
            groups: vec![],
        };
        driver.set(&baseline.theta());
        driver.adjoint = driver.free.is_empty() && driver.has_adjoint();
        driver.whole = driver.marches();
        // where dual numbers would have to run the law more than once, or it runs others
        if !driver.adjoint && (driver.groups.len() > 1 || law.composed()) {
            driver.recorded = Adjoint::of_both(law, driver.sizes, &driver.theta);
            driver.replays = law.composed() && driver.pace == Pace::Discrete;
        }
        driver
    }

    /// What the law does when it is asked, where that is recorded.
    pub(super) fn recorded(&self, ask: Ask) -> Option<&Adjoint> {
        let [derivative, output] = self.recorded.as_ref()?;
        Some(if ask == Ask::Output { output } else { derivative })
    }

    /// First direction along inputs, first along parameters, and one beyond the last.
    pub(super) fn directions(&self) -> [usize; 3] {
        let inputs = self.sizes.x;
        let theta = inputs + if self.wants_u { self.sizes.u } else { 0 };
        [inputs, theta, theta + self.free.len()]
    }

    /// Takes over other values of all parameters.
    pub fn set(&mut self, theta: &[f64]) {
        self.theta = theta.to_vec();
        self.plain = self.constants::<E::Lanes>(|_, _| {});
        let derived = self.plain.derived.iter().take(self.sizes.derived);
        self.derived = derived.map(|value| value.lane(0)).collect();
        let [_, first, count] = self.directions();
        let groups = (0..count).step_by(DIRECTIONS).map(|start| {
            let range = start..(start + DIRECTIONS).min(count);
            let seed = |parameter: usize, value: &mut E::Slopes| {
                let place = self.free.iter().position(|&free| free == parameter);
                if let Some(d) = place.map(|place| first + place).filter(|d| range.contains(d)) {
                    E::parts_mut(std::slice::from_mut(value))[0].slope[d - start] =
                        E::Lanes::constant(1.0);
                }
            };
            let constants = self.constants(seed);
            Group { range, constants }
        });
        self.groups = groups.collect();
    }

    /// Parameters, moved by `seed`, and what the law derives from them.
    fn constants<R: LaneNumber>(&self, seed: impl Fn(usize, &mut R)) -> Constants<R> {
        let (n, packs) = (self.sizes, per_row::<E>());
        let mut theta: Vec<R> = repeated(&self.theta, packs);
        for (i, value) in theta.iter_mut().enumerate() {
            seed(i % n.theta, value);
        }
        let zeros = |count: usize| vec![R::constant(0.0); packs * count];
        let (mut derived, w, x, u) = (zeros(n.derived), zeros(n.w), zeros(n.x), zeros(n.u));
        if n.derived > 0 {
            let time = R::constant(0.0);
            let (theta, w, x, u) = (&theta[..], &w[..], &x[..], &u[..]);
            let block = Block { sizes: n, packs, theta, derived: &[], x, u, w, read: &[], time };
            self.law.answer(Ask::Derived, R::call(&block, &mut derived));
        }
        Constants { theta, derived, w }
    }

    /// How far the inputs move, for a law whose inputs do; nothing where they are held.
    pub fn ramp<'r>(&self, du: &'r [Row<E>]) -> &'r [Row<E>] {
        if self.ramps { &du[..self.sizes.u] } else { &[] }
    }

    /// Whether the law finds in its channels how far the inputs move.
    pub(super) fn ramps_in_channels(&self) -> bool {
        self.ramps && self.pace == Pace::Discrete
    }

    /// Asks the law; `time` gives each pack's. Channels are empty where nothing enters them.
    pub(super) fn ask<R: LaneNumber>(
        &self,
        ask: Ask,
        constants: &Constants<R>,
        [x, u, w]: [&[R]; 3],
        time: impl Fn(usize) -> R,
        out: &mut [R],
    ) {
        let (sizes, packs) = (self.sizes, per_row::<E>());
        let (theta, derived) = (&constants.theta[..], &constants.derived[..]);
        // what is the same in all packs is taken from the first ones
        let (w, each) = if w.is_empty() { (&constants.w[..], 0) } else { (w, sizes.w) };
        if !self.timed {
            // parameters are the same in all packs: a few copies stay near the processor
            let copy = size_of::<R>() * (sizes.theta + sizes.derived + sizes.w).max(1);
            let at_once = (NEAR / copy).clamp(1, packs);
            let time = time(0);
            for from in (0..packs).step_by(at_once) {
                let packs = at_once.min(packs - from);
                let block = Block {
                    sizes,
                    packs,
                    theta: &theta[..packs * sizes.theta],
                    derived: &derived[..packs * sizes.derived],
                    x: &x[from * sizes.x..][..packs * sizes.x],
                    u: &u[from * sizes.u..][..packs * sizes.u],
                    w: &w[from * each..][..packs * sizes.w],
                    read: &[],
                    time,
                };
                let n = sizes.answer(ask);
                self.law.answer(ask, R::call(&block, &mut out[from * n..][..packs * n]));
            }
            return;
        }
        let block = Block { sizes, packs, theta, derived, x, u, w, read: &[], time: time(0) };
        for (pack, out) in out.chunks_mut(sizes.answer(ask).max(1)).enumerate() {
            self.law.answer(ask, R::call(&one(&block, pack, time(pack)), out));
        }
    }

    /// Asks the law's own adjoint.
    pub(super) fn pull(
        &self,
        [x, u, lambda]: [&[E::Lanes]; 3],
        time: impl Fn(usize) -> E::Lanes,
        [to_x, to_u]: [&mut [E::Lanes]; 2],
    ) -> bool {
        let (sizes, packs, wants_u) = (self.sizes, per_row::<E>(), self.wants_u);
        let Constants { theta, derived, w } = &self.plain;
        let block = Block { sizes, packs, theta, derived, x, u, w, read: &[], time: time(0) };
        if !self.timed {
            let pull = Pull { lambda, x: to_x, u: to_u, wants_u };
            return self.law.pull(E::pull(&block, pull));
        }
        (0..packs).all(|pack| {
            let u = if wants_u { &mut to_u[pack * sizes.u..][..sizes.u] } else { &mut [] };
            let pull = Pull {
                lambda: part(lambda, pack, sizes.x),
                x: &mut to_x[pack * sizes.x..][..sizes.x],
                u,
                wants_u,
            };
            self.law.pull(E::pull(&one(&block, pack, time(pack)), pull))
        })
    }

    /// Room that a march needs.
    pub(super) fn march_room(&self) -> usize {
        2 * self.pace.substeps() * self.pace.tableau().len() * self.sizes.x
    }

    /// A whole sample in one call of the law; `false` where it has no kernel for that.
    pub(super) fn march(
        &self,
        sight: Sight<'_, E>,
        kept: &mut [E::Lanes],
        way: Way<'_, E::Lanes>,
    ) -> bool {
        let (x, u) = sight.z.split_at(self.sizes.x);
        self.law.march(E::march(March {
            sizes: self.sizes,
            packs: per_row::<E>(),
            substeps: self.pace.substeps(),
            step: self.pace.step(),
            stages: self.pace.tableau(),
            theta: &self.theta,
            derived: &self.derived,
            x: lanes(x),
            u: lanes(u),
            du: lanes(sight.du),
            time: lanes(std::slice::from_ref(sight.time)),
            kept,
            way,
        }))
    }

    /// Whether the law has such a kernel.
    fn marches(&self) -> bool {
        let (n, time) = (self.sizes, Row::zero());
        let z = vec![Row::zero(); n.x + n.u];
        let zeros = |count: usize| vec![E::Lanes::constant(0.0); count];
        let (mut kept, mut end) = (zeros(self.march_room()), zeros(per_row::<E>() * n.x));
        let sight = Sight { z: &z, du: &[], time: &time };
        self.pace != Pace::Discrete && self.march(sight, &mut kept, Way::Forward(&mut end))
    }

    /// Whether the law has an adjoint of its own.
    fn has_adjoint(&self) -> bool {
        let zeros = |count: usize| vec![E::Lanes::constant(0.0); per_row::<E>() * count];
        let (x, u, lambda) = (zeros(self.sizes.x), zeros(self.sizes.u), zeros(self.sizes.x));
        let (mut to_x, mut to_u) = (zeros(self.sizes.x), zeros(self.sizes.u));
        let time = |_| E::Lanes::constant(0.0);
        self.pull([&x, &u, &lambda], time, [&mut to_x, &mut to_u])
    }
}

/// One pack's share of a slice.
fn part<R>(all: &[R], pack: usize, size: usize) -> &[R] {
    &all[pack * size..][..size]
}

/// One pack of a block.
fn one<'b, R: Copy>(block: &Block<'b, R>, pack: usize, time: R) -> Block<'b, R> {
    let n = block.sizes;
    Block {
        packs: 1,
        theta: part(block.theta, pack, n.theta),
        derived: part(block.derived, pack, n.derived),
        x: part(block.x, pack, n.x),
        u: part(block.u, pack, n.u),
        w: part(block.w, pack, n.w),
        time,
        ..*block
    }
}
