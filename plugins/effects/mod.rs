//! Effects: what a model may lack.

pub mod backlash;
pub mod bias;
pub mod coulomb_friction;
pub mod data_fault;
pub mod dead_zone;
pub mod delay;
pub mod drag;
pub mod drift;
pub mod extra_mode;
pub mod free_form;
pub mod gain;
pub mod harmonic;
pub mod hinge;
pub mod hysteresis;
pub mod lag;
pub mod load_friction;
pub mod network;
pub mod parameter;
pub mod polynomial;
pub mod saturation;
pub mod step;
pub mod stop;
pub mod stribeck_friction;

/// Whether a number is 0, as an origin that goes without saying is.
#[allow(clippy::trivially_copy_pass_by_ref)] // serde hands references
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}
