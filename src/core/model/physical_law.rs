//! Every [`Physics`] is a [`Law`]: compiled once for each kind of number, a loop over packs
//! inside.

use super::Signals;
use super::at::At;
use super::block::{Ask, Block, Call, Pull, PullCall};
use super::law::{Fault, Law, Matrices};
use super::march::call::MarchCall;
use super::march::march;
use super::physics::Physics;
use crate::per_lanes;
use crate::real::{InRegisters, Real, Trace};

impl<P: Physics> Law for P {
    fn signals(&self) -> Signals {
        Physics::signals(self)
    }

    fn faults(&self) -> Vec<Fault> {
        Physics::faults(self)
    }

    fn answer(&self, ask: Ask, call: Call<'_>) {
        match call {
            Call::F64(block, out) => run(self, ask, block, out),
            Call::F32(block, out) => run(self, ask, block, out),
            Call::Dual64(block, out) => run(self, ask, block, out),
            Call::Dual32(block, out) => run(self, ask, block, out),
            Call::Trace(block, out) => trace(self, ask, block, out),
        }
    }

    fn pull(&self, call: PullCall<'_>) -> bool {
        let mut done = true;
        match call {
            PullCall::F64(block, pull) => pulls(self, block, pull, &mut done),
            PullCall::F32(block, pull) => pulls(self, block, pull, &mut done),
        }
        done
    }

    fn march(&self, call: MarchCall<'_>) -> bool {
        march(self, call)
    }

    fn matrices(&self, theta: &[f64]) -> Option<Matrices> {
        Physics::matrices(self, theta)
    }

    fn key(&self, parameter: &str) -> String {
        Physics::key(self, parameter)
    }

    fn innovation_gain(&self) -> Option<nalgebra::DMatrix<f64>> {
        Physics::innovation_gain(self)
    }
}

/// One question to all packs: a function of its own for each, so that none carries the
/// others' bookkeeping along.
fn run<P: Physics, R: InRegisters>(physics: &P, ask: Ask, block: &Block<'_, R>, out: &mut [R]) {
    match ask {
        Ask::Derivative => derivatives(physics, block, out),
        Ask::Output => outputs(physics, block, out),
        Ask::Coordinates => coordinates(physics, block, out),
        Ask::Derived => derived(physics, block, out),
    }
}

/// One question to be written down: seldom asked, so not compiled for every instruction set.
fn trace<P: Physics>(physics: &P, ask: Ask, block: &Block<'_, Trace>, out: &mut [Trace]) {
    let n = block.sizes;
    for (pack, out) in out.chunks_exact_mut(n.answer(ask).max(1)).take(block.packs).enumerate() {
        match ask {
            Ask::Derivative => physics.derivative(&block.at(pack), out),
            Ask::Output => physics.output(&block.at(pack), out),
            Ask::Coordinates => physics.coordinates(&block.at(pack), out),
            Ask::Derived => physics.derive(&block.theta[pack * n.theta..][..n.theta], out),
        }
    }
}

impl<'a, R: Real> Block<'a, R> {
    /// What one pack looks at.
    #[inline(always)]
    fn at(&self, pack: usize) -> At<'a, R> {
        let n = self.sizes;
        At {
            theta: &self.theta[pack * n.theta..][..n.theta],
            derived: &self.derived[pack * n.derived..][..n.derived],
            x: &self.x[pack * n.x..][..n.x],
            u: &self.u[pack * n.u..][..n.u],
            w: &self.w[pack * n.w..][..n.w],
            time: self.time,
        }
    }
}

per_lanes! {
    fn derivatives[P: Physics,; R](physics: &P, block: &Block<'_, R>, out: &mut [R]) {
        let n = block.sizes.x;
        for pack in 0..block.packs {
            physics.derivative(&block.at(pack), &mut out[pack * n..][..n]);
        }
    }
}

per_lanes! {
    fn outputs[P: Physics,; R](physics: &P, block: &Block<'_, R>, out: &mut [R]) {
        let n = block.sizes.y;
        for pack in 0..block.packs {
            physics.output(&block.at(pack), &mut out[pack * n..][..n]);
        }
    }
}

per_lanes! {
    fn coordinates[P: Physics,; R](physics: &P, block: &Block<'_, R>, out: &mut [R]) {
        let n = block.sizes.z;
        for pack in 0..block.packs {
            physics.coordinates(&block.at(pack), &mut out[pack * n..][..n]);
        }
    }
}

per_lanes! {
    fn derived[P: Physics,; R](physics: &P, block: &Block<'_, R>, out: &mut [R]) {
        let (from, n) = (block.sizes.theta, block.sizes.derived);
        for pack in 0..block.packs {
            physics.derive(&block.theta[pack * from..][..from], &mut out[pack * n..][..n]);
        }
    }
}

per_lanes! {
    fn pulls[P: Physics,; R](physics: &P, block: &Block<'_, R>, all: Pull<'_, R>, done: &mut bool) {
        let n = block.sizes;
        for pack in 0..block.packs {
            let pull = Pull {
                lambda: &all.lambda[pack * n.x..][..n.x],
                x: &mut all.x[pack * n.x..][..n.x],
                u: if all.wants_u { &mut all.u[pack * n.u..][..n.u] } else { &mut [] },
                wants_u: all.wants_u,
            };
            *done &= physics.pull(&block.at(pack), pull);
        }
    }
}
