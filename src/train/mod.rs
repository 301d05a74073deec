//! Fits model and encoder together on short sections.

mod augmented;
mod course;
mod error;
mod guess;
mod run;
mod sections;
mod shooting;

pub use augmented::{Augmented, Run};
pub use error::TrainError;
pub use shooting::{Arithmetic, MultipleShooting, Shooting};
