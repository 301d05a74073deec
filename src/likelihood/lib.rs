//! The likelihood of a model, with noise at its sensors and inside its plant.
//!
//! ```text
//! System, Record -- predictor --> Predictor -- follow --> innovations and a frozen linearisation
//! linearisation -- replay --> log likelihood, its gradient, smoothed states
//! replay -- select --> intensities of the noise -- missing --> the missing force as a signal
//! replay -- tangent --> what laws at each place would explain -- places --> ranked places
//! ```
//!
//! log L = -1/2 sum( log det(2 pi S) + e' S^-1 e ), e being what the predictor did not foresee
//! (Ljung, "System Identification", 2nd ed., 1999, sections 3.2 and 7.4; Kristensen, Madsen and
//! Jorgensen, Automatica 40, 2004). A free run with coloured noise at the outputs is the special case
//! without noise inside the plant ([`NoiseModel`]); both compete on the same data by the same criterion.

// examples say `lacuna::`
extern crate self as lacuna;

use lacuna_core::{data, effect, evaluate, fault, optimise, real, register, statistics, system};

mod ahead;
mod all_parameters;
mod autoregressive;
mod averaged;
mod backward;
mod cycle;
mod earlier;
mod elimination;
mod error;
mod evidence;
mod exchange;
mod explain;
mod explanation;
mod follow;
mod forgetting;
mod found;
mod given;
mod given_weighed;
mod held_out;
mod hypothesis;
mod instruments;
mod intensities;
mod joint;
mod kalman;
mod lacking;
mod late;
mod laws;
mod layout;
mod linearisations;
mod local_level;
mod memory;
mod missing;
mod model;
mod moments;
mod noise;
mod output_noise;
mod own_gain;
mod parametrised;
mod path;
mod places;
mod poles;
mod predictor;
mod prior;
mod racing;
mod ranked;
mod remembering;
mod replay;
mod rows;
mod savage_dickey;
mod scope;
mod screen;
mod screened;
mod select;
mod sensor_path;
mod sets;
mod share;
mod slopes;
mod smoother;
mod std_error;
mod steady;
mod taken_back;
mod tangent;
mod transition;
mod weigh;

pub use error::LikelihoodError;
pub use missing::MissingForce;
pub use noise::Noise;
pub use places::places;
pub use predictor::Predictor;
pub use ranked::RankedPlaces;

// machinery that sibling crates and the program share; it may change at any time
#[doc(hidden)]
pub use self::{
    explanation::{Explanation, NamedCause},
    given::Given,
    held_out::refutes,
    missing::Explained,
    model::{Fitted, NoiseModel},
    noise::{Component, Slow},
    output_noise::OutputNoise,
    predictor::Innovations,
    ranked::{FittedLaws, RankedPlace},
    savage_dickey::{has_moved, probability},
    scope::Scope,
};

#[cfg(test)]
mod tests;
