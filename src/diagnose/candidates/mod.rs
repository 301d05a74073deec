//! What may be at work: every effect at every place, and curves without a name.

pub(crate) mod candidate;
pub(crate) mod coordinate;
pub(crate) mod free_curve;
pub(crate) mod free_surface;
pub(crate) mod grids;
pub(crate) mod law_regression;
pub(crate) mod leading_places;
pub(crate) mod library;
mod loads;
pub(crate) mod naming;
pub(crate) mod network_start;
pub(crate) mod placement;
mod places;
pub(crate) mod probes;
pub(crate) mod products;
pub(crate) mod screen;
pub(crate) mod smoothing;
pub(crate) mod stiffness;
mod stores;
pub(crate) mod sums;
mod term_columns;
