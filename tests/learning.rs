//! The learned part: encoders, networks, training, and the paper.
//!
//! Apart from the library, because its tests register models of their own.

mod encoder;
mod hidden_mode;
mod innovations;
mod learned_part;
mod learned_part_read;
mod least_squares;
mod orthogonal;
mod paper_msd;
mod restarts;
mod stateless;
mod trainer;
mod training;
mod well_posed;
mod which_states;
mod whole_sample;
#[path = "paper_msd/without_adjoint.rs"]
mod without_adjoint;
