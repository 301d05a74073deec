//! What a search is prepared with: records joined, the operating range of the baseline, outliers.

pub(crate) mod direct;
pub(crate) mod excitation;
pub(crate) mod input_dependence;
pub(crate) mod integration_error;
pub(crate) mod joined_records;
pub(crate) mod known_clipping;
pub(crate) mod operating_range;
pub(crate) mod outliers;
pub(crate) mod prepared;
pub(crate) mod pushes;
pub(crate) mod regressors;
pub(crate) mod windows;
