//! Lowers a number by moving a vector.
//!
//! An [`Objective`] is a number to lower, with its slope; a [`LeastSquares`] a sum of
//! squares to lower, with its residuals. An [`Optimiser`] moves the vector, tells an
//! [`Observer`] after every step, and says why it stopped ([`Outcome`]): reaching a limit
//! is an outcome, not an error. [`shelf`] holds problems with known answers that every
//! optimiser has to solve.
//!
//! ```
//! use lacuna::optimise::{Lbfgs, Optimiser, Stopped, shelf};
//!
//! let rosenbrock = shelf::rosenbrock(2);
//! let mut theta = rosenbrock.start.clone();
//! let outcome = Lbfgs::default().minimise(&rosenbrock, &mut theta, &mut ())?;
//! assert_eq!(outcome.stopped, Stopped::Converged);
//! assert!((theta[0] - 1.0).abs() < 1e-6 && (theta[1] - 1.0).abs() < 1e-6);
//! # Ok::<(), lacuna::optimise::OptimiseError>(())
//! ```

mod adam;
mod bounds;
mod error;
mod lbfgs;
#[doc(hidden)]
pub mod levenberg;
mod marquardt;
mod named;
mod normal;
mod objective;
mod observe;
mod schedule;
#[doc(hidden)]
pub mod shelf;
mod stop;
mod unknown;

pub use adam::Adam;
pub use error::OptimiseError;
pub use lbfgs::Lbfgs;
pub use marquardt::LevenbergMarquardt;
pub use objective::{LeastSquares, Objective};
pub use observe::{Observer, Outcome, Progress, Stopped};
pub use schedule::Schedule;
pub use stop::Stop;

// machinery that sibling crates and the program share; it may change at any time
#[doc(hidden)]
pub use self::{
    adam::{AdamState, AdamStep},
    bounds::Bounds,
    bounds::Transformed,
    levenberg::{Levenberg, Settings, Unknown},
    named::Named,
    stop::Watch,
};

/// A method that lowers an [`Objective`]; configuration files name it.
///
/// # Example
///
/// ```
/// use lacuna::optimise::Optimiser;
///
/// let text = "[adam]\nrate = 0.01\nstop = { steps = 500 }";
/// let optimiser: Box<dyn Optimiser> = toml::from_str(text)?;
/// assert_eq!(optimiser.typetag_name(), "adam");
/// # Ok::<(), toml::de::Error>(())
/// ```
#[typetag::serde]
pub trait Optimiser: std::fmt::Debug + Send + Sync {
    /// Moves `theta` to lower `objective`, at most as long as the own rules allow.
    ///
    /// `theta` has [`Objective::len`] entries; afterwards it holds the best point met, also
    /// after an error. `observer` is told after every step and may end the run.
    ///
    /// # Errors
    ///
    /// A setting out of range, a vector of another length than the objective's, an
    /// objective that is not a finite number at the start, or one that stays so however
    /// small the steps become.
    fn minimise(
        &self,
        objective: &dyn Objective,
        theta: &mut [f64],
        observer: &mut dyn Observer,
    ) -> Result<Outcome, OptimiseError>;

    /// Checks all settings, so that a mistake is told before any work.
    ///
    /// # Errors
    ///
    /// The first one out of range.
    fn validate(&self) -> Result<(), OptimiseError> {
        Ok(())
    }

    /// Whether [`Optimiser::batch_step`] is there: training then moves after every batch.
    /// Otherwise it hands over the whole objective, epoch by epoch.
    fn steps_by_batch(&self) -> bool {
        false
    }

    /// One step against the gradient of one batch, with what is remembered between steps in
    /// `state` (a count and two vectors, which checkpoints keep); gives the rate that was used.
    /// `theta`, `gradient` and the vectors of `state` have the same length.
    ///
    /// # Errors
    ///
    /// A slope that is not finite; nothing is moved then.
    fn batch_step(
        &self,
        state: &mut AdamState,
        theta: &mut [f64],
        gradient: &[f64],
    ) -> Result<f64, OptimiseError> {
        let _ = (state, theta, gradient);
        Err(OptimiseError::NoBatches { optimiser: self.typetag_name() })
    }

    /// The rate of the next step of [`Optimiser::batch_step`]; 0 where there is none.
    fn batch_rate(&self, state: &AdamState) -> f64 {
        let _ = state;
        0.0
    }
}
