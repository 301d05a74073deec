//! Estimates the state from past outputs and inputs, and starts from a good guess.
//!
//! An [`Encoder`] is a function with weights from a [`Window`] of measured samples to the
//! state at sample k, baseline states first, augmented ones after them (Hoekstra et al.,
//! eq. `encoder_ann_struct`). An [`EncoderInitialiser`] gives it weights with the help of
//! the [`Baseline`] and says in a [`Started`] how good they are:
//!
//! | name | needs | source |
//! |---|---|---|
//! | [`Random`] | nothing | the usual start |
//! | [`Reconstruct`] | a linear baseline | eq. `final_noiseless` |
//! | [`Innovation`] | a linear baseline with gain K | eq. `noisy:final` |
//! | [`Linearised`] | a record, or slopes at a point | statistical linearisation, or Sec. 3.1.3 and its footnote |
//! | [`LeastSquares`] | a record | Sec. 3.2, the linear problem |
//! | [`Prefit`] | a record | Sec. 3.2, V_enc |
//!
//! All numbers that go in and come out are in the signals' own units; encoders scale them
//! inside ([`Scaling`]).
//!
//! # Example
//!
//! ```
//! use lacuna::data::Record;
//! use lacuna::encoder::{Baseline, Encoder, EncoderInitialiser, Linearised, ResNetEncoder, Window};
//! use lacuna::plugins::systems::Duffing;
//! use lacuna::system::{Sampling, System};
//!
//! let model = Duffing { mass: 1.0, damping: 2.0, stiffness: 50.0, hardening: 9.0, fixed: vec![] };
//! let system = System::new(model, Sampling::default());
//! let u: Vec<f64> = (0..400).map(|k| (0.3 * k as f64).sin() + (1.1 * k as f64).cos()).collect();
//! let record = Record::new(0.02).input("u [N]", u)?;
//! let baseline = Baseline::new(&system, &record)?;
//! let mut encoder = ResNetEncoder::new(Window::past(6), &[8]);
//! let started = Linearised::default().initialise(&mut encoder, &baseline, 7)?;
//! println!("{started}");
//! assert!(started.states.iter().all(|state| state.nrmse < 0.02));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod baseline;
mod batch;
mod error;
mod initialise;
mod learned;
mod linear;
mod observer;
mod reconstruct;
mod resnet;
mod sampled;
mod scaling;
mod slopes;
mod started;
mod stateless;
mod statistical;
mod window;

pub use error::EncoderError;
pub use initialise::{
    EncoderInitialiser, Innovation, LeastSquares, Linearised, Prefit, Random, Reconstruct,
};
pub use linear::LinearEncoder;
pub use resnet::ResNetEncoder;
pub use scaling::Scaling;
pub use window::Window;

// machinery that sibling crates and the program share; it may change at any time
#[doc(hidden)]
pub use self::{
    baseline::{Baseline, Course, Outputs},
    initialise::{About, PrefitStart},
    learned::Learned,
    reconstruct::{LinearMap, Reconstruction},
    sampled::SampledLinear,
    scaling::Spread,
    started::{Started, StateError},
    stateless::StatelessEncoder,
};

use crate::network::ResNet;
use serde::{Deserialize, Serialize};

/// How many signals and states an encoder deals with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shape {
    /// Outputs.
    pub outputs: usize,
    /// Inputs.
    pub inputs: usize,
    /// States of the baseline.
    pub baseline_states: usize,
    /// States added to it.
    pub augmented_states: usize,
}

impl Shape {
    /// All states.
    pub fn states(&self) -> usize {
        self.baseline_states + self.augmented_states
    }
}

/// A function with weights from past outputs and inputs to the state, Hoekstra et al.,
/// eq. `encoder_ann_struct`; configuration files name it (`[resnet]`, `[linear]`).
///
/// Windows and states are laid out row by row, one column per sample: row i of sample n of
/// `samples` is `values[i * samples + n]`; [`Window::gather`] makes such windows.
#[typetag::serde]
pub trait Encoder: std::fmt::Debug + Send + Sync {
    /// The samples it sees.
    fn window(&self) -> Window;

    /// What it deals with; `None` before [`Encoder::prepare`].
    fn shape(&self) -> Option<Shape>;

    /// Makes room for signals and states and draws all weights from a seed.
    ///
    /// # Errors
    ///
    /// A window without samples, or a scaling of another shape.
    fn prepare(&mut self, shape: Shape, scaling: Scaling, seed: u64) -> Result<(), EncoderError>;

    /// How it scales signals inside; `None` before [`Encoder::prepare`].
    fn scaling(&self) -> Option<&Scaling>;

    /// All weights; empty before [`Encoder::prepare`].
    fn weights(&self) -> &[f64];

    /// Takes over other weights.
    ///
    /// # Errors
    ///
    /// If there are none yet, or their number is another one.
    fn set_weights(&mut self, weights: &[f64]) -> Result<(), EncoderError>;

    /// Estimated states, in their units.
    ///
    /// # Errors
    ///
    /// If there are no weights yet, or `windows` has another length.
    fn estimate(&self, windows: &[f64], samples: usize) -> Result<Vec<f64>, EncoderError>;

    /// From the slopes of a number along the estimated states (laid out like them) to those
    /// along the weights.
    ///
    /// # Errors
    ///
    /// If there are no weights yet, or a slice has another length.
    fn gradient(
        &self,
        windows: &[f64],
        slopes: &[f64],
        samples: usize,
    ) -> Result<Vec<f64>, EncoderError>;

    /// Makes the encoder the linear map given, for the first states that it has rows for;
    /// what it says about further states stays. Learning goes on from there.
    ///
    /// # Errors
    ///
    /// If there is no linear part or the map has another width.
    fn set_linear(&mut self, map: &LinearMap) -> Result<(), EncoderError> {
        let _ = map;
        self.without_linear_part()
    }

    /// The same for the states from number `first` on; what it says about others stays.
    ///
    /// # Errors
    ///
    /// As [`Encoder::set_linear`].
    fn set_linear_from(&mut self, first: usize, map: &LinearMap) -> Result<(), EncoderError> {
        if first == 0 { self.set_linear(map) } else { self.without_linear_part() }
    }

    /// The refusal of an encoder that has no linear part.
    #[doc(hidden)]
    fn without_linear_part(&self) -> Result<(), EncoderError> {
        let encoder = self.typetag_name().to_string();
        Err(EncoderError::NoLinearPart { initialiser: "set_linear", encoder })
    }

    /// The network, where the encoder is a network between its scales: what the fast
    /// training step builds on.
    fn network(&self) -> Option<&ResNet> {
        None
    }

    /// A copy.
    fn copied(&self) -> Box<dyn Encoder>;
}

impl Clone for Box<dyn Encoder> {
    fn clone(&self) -> Self {
        self.copied()
    }
}
