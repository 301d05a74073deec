//! The face of a model that people write: generic in its number.

use std::fmt::Debug;

use super::at::At;
use super::law::{Ask, Block, Call, Fault, Law, Matrices, Pull, PullCall};
use super::march::{MarchCall, march};
use super::{Signals, TimeKind};
use crate::per_lanes;
use crate::real::{InRegisters, Real, Trace};

/// A physical system, written once in any kind of number.
///
/// Put `#[inline(always)]` on the two laws and on their helpers: only then are they
/// compiled with the processor's vector instructions.
///
/// # Example
///
/// ```
/// use lacuna::prelude::*;
///
/// #[derive(Debug, Clone, Serialize, Deserialize)]
/// #[serde(deny_unknown_fields)]
/// struct Pendulum {
///     length: f64,
///     damping: f64,
/// }
///
/// impl Physics for Pendulum {
///     fn signals(&self) -> Signals {
///         Signals::continuous()
///             .input("acceleration", "rad/s^2")
///             .state("theta", "rad", 0.0)
///             .state("omega", "rad/s", 0.0)
///             .output("angle", "rad")
///             .parameter_from("length", self.length, "m", 0.0)
///             .parameter_from("damping", self.damping, "1/s", 0.0)
///     }
///     #[inline(always)]
///     fn derivative<R: Real>(&self, at: &At<R>, dx: &mut [R]) {
///         let &[length, damping] = at.parameters();
///         let &[theta, omega] = at.states();
///         let &[acceleration] = at.inputs();
///         dx[0] = omega;
///         dx[1] = acceleration - R::constant(9.81) / length * theta.sin() - damping * omega;
///     }
///     #[inline(always)]
///     fn output<R: Real>(&self, at: &At<R>, y: &mut [R]) {
///         y[0] = at.x[0];
///     }
/// }
///
/// lacuna::register!(StateSpaceModel for Pendulum, "my_pendulum", "a swinging arm");
/// ```
pub trait Physics: Debug + Send + Sync {
    /// Numbers of states with which the laws are straight formulas: for each of them (4 at
    /// most) a kernel is compiled that takes a whole sample at once, so that learning beside
    /// this model takes a fifth of the time. Empty, no such kernel is compiled, which saves half
    /// a minute of it; laws that loop over lists whose length only the values know are better
    /// off without.
    const STRAIGHT: &'static [usize] = &[];

    /// Names, units, bounds, initial values. Called once per run, not per sample.
    fn signals(&self) -> Signals;

    /// Everything that cannot be right about the values (a negative mass, lists of
    /// different length); the laws are only called when this is empty.
    fn faults(&self) -> Vec<Fault> {
        vec![]
    }

    /// Numbers that follow from the parameters alone, computed once per run instead of in
    /// every stage; the laws find them in [`At::derived`]. Say how many with
    /// [`Signals::deriving`].
    #[inline(always)]
    fn derive<R: Real>(&self, theta: &[R], derived: &mut [R]) {
        let _ = (theta, derived);
    }

    /// dx/dt (or the next state, where `signals` says discrete), one value per state.
    fn derivative<R: Real>(&self, at: &At<R>, dx: &mut [R]);

    /// The outputs, one value each.
    fn output<R: Real>(&self, at: &At<R>, y: &mut [R]);

    /// The declared coordinates, one value each; needed only where some are declared.
    #[inline(always)]
    fn coordinates<R: Real>(&self, at: &At<R>, z: &mut [R]) {
        z.copy_from_slice(&at.x[..z.len()]);
    }

    /// The derivative's own adjoint: fills in what [`Pull`] asks for and says `true`. Without
    /// it the library uses dual numbers; with it learning beside this model takes less time.
    /// Add `#[inline(always)]`.
    #[inline(always)]
    fn pull<R: Real>(&self, at: &At<R>, pull: Pull<'_, R>) -> bool {
        let _ = (at, pull);
        false
    }

    /// The matrices, where the law is linear in states and inputs at given parameters.
    fn matrices(&self, theta: &[f64]) -> Option<Matrices> {
        let _ = theta;
        None
    }

    /// Where a parameter's value stands in the model's own table: keys and list positions
    /// joined by dots (`masses.0`); by default the field of the same name.
    fn key(&self, parameter: &str) -> String {
        parameter.to_string()
    }

    /// The gain K of an innovation form, where there is one.
    fn innovation_gain(&self) -> Option<nalgebra::DMatrix<f64>> {
        None
    }
}

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

impl TimeKind {
    /// Whether the law gives derivatives.
    pub fn is_continuous(self) -> bool {
        self == Self::Continuous
    }
}
