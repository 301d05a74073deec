//! The face of a model that people write: generic in its number.

use std::fmt::Debug;

use super::at::At;
use super::block::Pull;
use super::law::{Fault, Matrices};
use super::{Signals, TimeKind};
use crate::real::Real;

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

impl TimeKind {
    /// Whether the law gives derivatives.
    pub fn is_continuous(self) -> bool {
        self == Self::Continuous
    }
}
