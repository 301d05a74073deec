//! Whether data reject a model at all.

use super::cause::Cause;
use super::diagnosis::Diagnosis;
use super::error::DiagnoseError;
use crate::data::Record;
use crate::statistics::normal_tail;
use crate::watch::Watch;

/// Whether records reject a system.
#[derive(Debug, Clone, PartialEq)]
pub struct Checked {
    /// Probability of data as far from the system's simulation if the system were right.
    pub p_value: f64,
    /// What would explain most, if anything was found.
    pub first_cause: Option<Cause>,
    /// Whether somebody stopped the search.
    pub interrupted: bool,
}

impl Diagnosis<'_> {
    /// Asks whether records reject the system at all.
    ///
    /// # Errors
    ///
    /// As [`run`](Self::run).
    pub fn check(&self, records: &[Record], watch: &dyn Watch) -> Result<Checked, DiagnoseError> {
        let finding = self.run(records, None, watch)?;
        let of_the_model = finding.in_the_machine().next();
        // what no name was found for counts by its dependence on the inputs
        let p_value = of_the_model
            .and_then(|cause| cause.p_value)
            .unwrap_or_else(|| normal_tail(finding.dependence));
        let first_cause = of_the_model.or(finding.causes.first()).cloned();
        Ok(Checked { p_value, first_cause, interrupted: finding.interrupted })
    }
}
