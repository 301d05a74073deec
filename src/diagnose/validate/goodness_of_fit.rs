//! Model validation: whether data reject a model at all.
//!
//! Two tests share the level (weighted Bonferroni: Genovese, Roeder and Wasserman, Biometrika 93,
//! 2006): the residual test of [`adequacy`], whose p-value is uniform if the model is right, with
//! weight 0.98, and the first cause that a search names, with weight 0.02. What a search names
//! has probabilities far below any level, so its weight costs it nothing.

use crate::data::Record;
use crate::diagnosis::Diagnosis;
use crate::error::DiagnoseError;
use crate::findings::cause::Cause;
use crate::findings::finding::Verdict;
use crate::findings::note::Note;
use crate::prepare::integration_error::unresolved;
use crate::prepare::windows::thinned;
use crate::statistics::normal_tail;
use crate::validate::adequacy;
use crate::watch::Watch;

/// Share of the level that the search has.
const OF_SEARCH: f64 = 0.02;

/// Whether records reject a system.
#[derive(Debug, Clone, PartialEq)]
pub struct GoodnessOfFit {
    /// Probability of data as far from the system's simulation if the system were right; `None`
    /// where somebody stopped the check: it has no verdict then.
    pub p_value: Option<f64>,
    /// What would explain most, if anything was found.
    pub first_cause: Option<Cause>,
    /// Faults of the data.
    pub data_faults: Vec<Cause>,
    /// Whether somebody stopped the search.
    pub interrupted: bool,
    /// What memory did not hold.
    pub notes: Vec<Note>,
}

impl GoodnessOfFit {
    /// Whether a fault changes what was measured, so that no verdict on the model can be had of
    /// these data: a sign, a scale, a reading that stands still or is cut off.
    pub fn rejects_data(&self) -> bool {
        self.data_faults.iter().any(changes_what_is_measured)
    }
}

/// Whether a cause is a fault of the data.
fn is_of_data(cause: &Cause) -> bool {
    cause.wording.fault.is_some() || is_scale(cause)
}

/// A factor on a column of its own path.
fn is_scale(cause: &Cause) -> bool {
    cause.effect == "gain" && cause.of.as_deref() == Some(&cause.into)
}

fn changes_what_is_measured(cause: &Cause) -> bool {
    matches!(cause.effect.as_str(), "swapped_sign" | "clipping" | "stuck" | "unrelated")
        || is_scale(cause)
}

impl Diagnosis<'_> {
    /// Asks whether records reject the system at all.
    ///
    /// # Errors
    ///
    /// As [`run`](Self::run).
    pub fn check(
        &self,
        records: &[Record],
        watch: &dyn Watch,
    ) -> Result<GoodnessOfFit, DiagnoseError> {
        self.check_names()?;
        let thin = thinned(self.system, records, None, self.memory);
        let Some(thin) = thin else { return self.check_on(records, watch) };
        let mut outcome = self.check_on(&thin.records, watch)?;
        let causes = outcome.first_cause.iter_mut().chain(&mut outcome.data_faults);
        causes.for_each(|cause| thin.place(cause));
        outcome.notes.insert(0, thin.note);
        Ok(outcome)
    }

    /// The same on records that memory holds.
    fn check_on(
        &self,
        records: &[Record],
        watch: &dyn Watch,
    ) -> Result<GoodnessOfFit, DiagnoseError> {
        let mut finding = self.run_on(records, None, watch)?;
        let left_out =
            |note: &Note| matches!(note, Note::LawsLeftOut { .. } | Note::LawsRanked { .. });
        finding.notes.retain(left_out);
        let notes = finding.notes;
        let interrupted = finding.interrupted || watch.stopped();
        let (data_faults, of_the_model): (Vec<Cause>, Vec<Cause>) =
            finding.causes.iter().cloned().partition(is_of_data);
        let first_cause = of_the_model.first().or(data_faults.first()).cloned();
        if interrupted {
            let p_value = None;
            return Ok(GoodnessOfFit { p_value, first_cause, data_faults, interrupted, notes });
        }
        let named = of_the_model.first().and_then(|cause| cause.p_value).unwrap_or(1.0);
        let residual = if unresolved(self.system, records)?.is_some() {
            Some(1.0)
        } else {
            let (mended, _) = self.data_faults(records)?;
            adequacy::p_value(self.system, &mended)?
        };
        // records too short for the test are judged by the search's own
        let residual = residual.unwrap_or_else(|| match finding.verdict {
            Verdict::NothingFound | Verdict::DataFault => 1.0,
            _ => normal_tail(finding.dependence),
        });
        let p_value = (residual / (1.0 - OF_SEARCH)).min(named / OF_SEARCH).min(1.0);
        let p_value = Some(p_value);
        Ok(GoodnessOfFit { p_value, first_cause, data_faults, interrupted, notes })
    }
}
