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
mod innovations;
mod left_over;
mod looped;
mod modes;
mod mover;
mod orthogonal;
mod predict;
mod prune;
mod recipe;
mod restart;
mod run;
mod scale;
mod sections;
mod settings;
mod shooting;
mod sparse;
mod squares;
mod steps;
mod tangent;
mod task;
mod trainer;
mod validate;
mod whole;

pub use checkpoint::Checkpoint;
pub use error::TrainError;
pub use fit::Fit;
pub use recipe::Recipe;
pub use shooting::MultipleShooting;
pub use sparse::Sparse;
pub use trainer::Trainer;

// machinery that sibling crates and the program share; it may change at any time
#[doc(hidden)]
pub use self::{
    ablate::warnings,
    ablate::{Ablation, ablate},
    added::Contribution,
    augmented::{Augmented, Run},
    checkpoint::Fingerprint,
    disguise::{Change, Disguise},
    entered::{Added, Coordinate},
    fit::Epoch,
    fit::{Ended, Follow},
    groups::{Group, GroupKind},
    recipe::AugmentedStart,
    settings::{Finish, Growing, Mask, Weights},
    shooting::{Arithmetic, Shooting},
    validate::Score,
    validate::Validation,
};
