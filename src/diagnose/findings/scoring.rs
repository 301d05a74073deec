//! What causes are scored by: the test data, by simulations and, where causes were judged by innovations, by
//! predictions.

use crate::error::DiagnoseError;
use crate::findings::context::Context;
use crate::fit::extended::extended;
use crate::fit::problem::Model;
use crate::validate::innovation_errors::InnovationErrors;
use crate::validate::noise_floor::Floor;
use crate::validate::test_error::{Scored, TestData};
use crate::watch::Watch;

/// What causes are scored by.
pub(crate) struct Scores<'a> {
    pub test: &'a TestData,
    pub before: &'a Scored,
    pub after: &'a Scored,
    pub floors: &'a [Option<Floor>],
    /// Errors of predictions, where causes were judged by them.
    pub predicted: Option<&'a InnovationErrors>,
    /// Rows of the first samples of joined records.
    pub firsts: &'a [usize],
    /// Whether the joined records are records, of which each may show a cause or not.
    pub several: bool,
    /// Says whether somebody asks to stop: what is refitted then ends where it has come to.
    pub watch: &'a dyn Watch,
}

impl Context<'_, '_> {
    /// Probability on the test data of what the predictions of a model lose against the extended one, if
    /// that were chance; 1 where they cannot be had.
    pub(crate) fn by_predictions(
        &self,
        errors: &InnovationErrors,
        without: &Model,
    ) -> Result<f64, DiagnoseError> {
        Ok(errors.p_value(&extended(self.problem, without)?).unwrap_or(1.0))
    }
}
