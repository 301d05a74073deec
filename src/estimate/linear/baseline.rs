//! A linear model to be diagnosed where there is no model.

use super::{LinearError, LinearEstimate, linear_with};
use crate::data::Record;
use crate::watch::Watch;

/// A linear model of the part of the records that a diagnosis fits to, and that part's share: the
/// rest, by which causes are chosen and (without a test record) scored, stays unseen.
///
/// # Errors
///
/// As [`linear`](super::linear).
pub fn linear_baseline(
    records: &[Record],
    has_test: bool,
    watch: &dyn Watch,
) -> Result<(LinearEstimate, f64), LinearError> {
    let share = if has_test { 0.7 } else { 0.6 };
    // a record that is too short for that is refused for it by the estimate
    let end = |record: &Record| (share * record.len() as f64).round() as usize;
    let parts: Vec<Record> = records.iter().map(|r| r.slice(0..end(r))).collect();
    Ok((linear_with(&parts, None, watch)?, share))
}
