//! The object-safe face of a model: called once per block of lanes.

use std::fmt::Debug;

use super::Signals;
use super::block::{Ask, Call, PullCall};
use super::march::call::MarchCall;

/// The matrices of a law that is linear in states, inputs and channels (dx/dt, or the next
/// state, = A x + B u + G w + f; y = C x + D u + h), at one value of the parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Matrices {
    /// States to derivatives.
    pub a: nalgebra::DMatrix<f64>,
    /// Inputs to derivatives.
    pub b: nalgebra::DMatrix<f64>,
    /// Own channels to derivatives.
    pub g: nalgebra::DMatrix<f64>,
    /// Constant part of the derivatives.
    pub f: nalgebra::DVector<f64>,
    /// States to outputs.
    pub c: nalgebra::DMatrix<f64>,
    /// Inputs to outputs.
    pub d: nalgebra::DMatrix<f64>,
    /// Constant part of the outputs.
    pub h: nalgebra::DVector<f64>,
}

/// A value in a model's own table that cannot be right.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// Key path inside the model's table.
    pub key: String,
    /// What stands there.
    pub found: String,
    /// What should stand there.
    pub expected: String,
}

impl Fault {
    /// A fault of one key.
    pub fn new(
        key: impl Into<String>,
        found: impl std::fmt::Display,
        expected: impl Into<String>,
    ) -> Self {
        Self { key: key.into(), found: found.to_string(), expected: expected.into() }
    }

    /// Faults of the values among these that are not positive finite numbers.
    pub fn unless_positive(values: &[(&str, f64)]) -> Vec<Self> {
        let bad = values.iter().filter(|(_, v)| !(*v > 0.0 && v.is_finite()));
        bad.map(|&(key, value)| Self::new(key, value, "a positive number")).collect()
    }
}

/// What a model does in one instant, for whole blocks of lanes.
///
/// Written by hand only where [`Physics`](super::Physics) does not fit (a program that is
/// interpreted, say); everything that implements `Physics` has it.
pub trait Law: Debug + Send + Sync {
    /// Names, units, bounds, initial values.
    fn signals(&self) -> Signals;

    /// Everything that cannot be right about the model's values; `signals` and `answer`
    /// are only called when this is empty.
    fn faults(&self) -> Vec<Fault> {
        vec![]
    }

    /// Answers one question for one block.
    fn answer(&self, ask: Ask, call: Call<'_>);

    /// The derivative's own adjoint, for whole blocks; `false` where the law has none.
    fn pull(&self, call: PullCall<'_>) -> bool {
        let _ = call;
        false
    }

    /// A whole sample in one call; `false` where the law has no kernel for that, and nothing
    /// has been written.
    fn march(&self, call: MarchCall<'_>) -> bool {
        let _ = call;
        false
    }

    /// The matrices where the law is linear in states and inputs, so that it can be
    /// discretised exactly; `theta` holds the parameters.
    fn matrices(&self, theta: &[f64]) -> Option<Matrices> {
        let _ = theta;
        None
    }

    /// Packs of lanes that this law likes to be called with at once.
    fn packs(&self) -> usize {
        2
    }

    /// Whether an answer runs other laws, an integrator or a loop, and is no formula of its own: what it
    /// does is then recorded once and replayed, where it is asked again and again.
    fn composed(&self) -> bool {
        false
    }

    /// Whether this is a discrete-time law whose inputs move along a straight line to the next
    /// sample (first-order hold): it then declares one channel per input, in which it finds how
    /// far that moves, u_{k+1} - u_k.
    fn ramped(&self) -> bool {
        false
    }

    /// Whether this is a discrete-time law that reads its own outputs again, as their sensors give
    /// them (there is a controller in it): what effects do to an output is then part of what its
    /// next state follows from, and it finds the outputs in [`Block::read`](super::Block).
    fn fed_back(&self) -> bool {
        false
    }

    /// Where a parameter's value stands in the model's own table: keys and list positions
    /// joined by dots (`masses.0`).
    fn key(&self, parameter: &str) -> String {
        parameter.to_string()
    }

    /// The gain of the innovation form, x+ = A x + B u + K e, where there is one.
    fn innovation_gain(&self) -> Option<nalgebra::DMatrix<f64>> {
        None
    }
}
