//! Tests of the likelihood, on plants of their own.

mod filter;
mod intensities;
mod jacobian;
mod measured;
mod missing;
mod places;
mod plants;
mod smoother;
mod tangent;
