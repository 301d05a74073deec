//! Tests of the likelihood, on plants of their own.
#![allow(clippy::single_range_in_vec_init)] // a record of one segment

mod ahead;
mod all_parameters;
mod cycle;
mod direct;
mod earlier;
mod filter;
mod held_out;
mod intensities;
mod jacobian;
mod measured;
mod missing;
mod needed_noise;
mod places;
mod plants;
mod remembering;
mod smoother;
mod stationary;
mod steady;
mod suspected;
mod tangent;
