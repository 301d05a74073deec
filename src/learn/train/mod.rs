//! Fits model and encoder together on short sections.
//!
//! An [`Augmented`] model is an interconnection and the encoder that starts it. A
//! [`Trainer`] lowers the truncated loss of Hoekstra et al., eq. `loss_function`, over all
//! sections of one or several records, in batches, by Adam, and keeps the model that is best
//! on records it does not learn from. [`MultipleShooting`] is loss and gradient alone.

mod ablate;
mod added;
mod augmented;
mod batch;
mod checkpoint;
mod counted;
mod course;
mod disguise;
mod entered;
mod error;
mod fit;
mod groups;
mod guess;
mod hidden;
mod looped;
mod modes;
mod orthogonal;
mod recipe;
mod run;
mod scale;
mod sections;
mod settings;
mod shooting;
mod sparse;
mod steps;
mod tangent;
mod trainer;
mod validate;
mod whole;

pub use ablate::{Ablation, ablate, warnings};
pub use added::Contribution;
pub use augmented::{Augmented, Run};
pub use checkpoint::Checkpoint;
pub use disguise::{Change, Disguise};
pub use entered::{Added, Coordinate};
pub use error::TrainError;
pub use fit::{Ended, Epoch, Fit, Follow};
pub use groups::{Group, GroupKind};
pub use recipe::{AugmentedStart, Recipe};
pub use settings::{Finish, Growing, Mask, Weights};
pub use shooting::{Arithmetic, MultipleShooting, Shooting};
pub use sparse::Sparse;
pub use trainer::Trainer;
pub use validate::{Score, Validation};

pub use checkpoint::Fingerprint;
