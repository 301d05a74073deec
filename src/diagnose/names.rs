//! The causes of a diagnosis by their names alone.
//!
//! What is repeated many times to learn how often a name comes back (a bootstrap of the decision, not of
//! the numbers: Efron and Tibshirani, An Introduction to the Bootstrap, 1993, ch. 6) asks for no report.
//! All that decides on a name is done as ever: faults of the data, the search, noise inside the plant.
//! What is measured of names afterwards is left out: the gain on samples that were kept for the test,
//! p-values, shares, noise floors, the missing force, curves, other records.

use super::diagnosis::{Diagnosis, searchable};
use super::error::DiagnoseError;
use super::findings::cause::Cause;
use super::findings::context::Source;
use super::mended::Mended;
use super::prepare::integration_error::unresolved;
use super::prepare::joined_records::firsts;
use super::prepare::windows::thinned;
use super::run::Chosen;
use super::segmentation::horizon;
use crate::data::Record;
use crate::watch::Watch;

impl Diagnosis<'_> {
    /// Names of the causes in the machine, each with those that cannot be told from it, as
    /// [`Self::run`] finds them without a test record. With `held`, parameters that are held are let go
    /// as look-alikes, as there.
    ///
    /// # Errors
    ///
    /// Those of [`Self::run`].
    pub fn names(
        &self,
        records: &[Record],
        held: bool,
        watch: &dyn Watch,
    ) -> Result<Vec<Cause>, DiagnoseError> {
        match self.plainly(records)? {
            None => {
                let finding = self.run(records, None, watch)?;
                Ok(finding.in_the_machine().cloned().collect())
            }
            Some(mended) if mended.blind => Ok(vec![]),
            Some(mended) => self.named(&mended.records, held, watch),
        }
    }

    /// One record without faults, where nothing but one search decides on names: its clock is right, a
    /// free run follows it from end to end.
    fn plainly(&self, records: &[Record]) -> Result<Option<Mended>, DiagnoseError> {
        self.check_names()?;
        for record in records {
            self.check_baseline(record)?;
        }
        let is_plain = records.len() == 1
            && thinned(self.system, records, None, self.memory).is_none()
            && unresolved(self.system, records)?.is_none()
            && horizon(self.system, records)?.is_none();
        if !is_plain {
            return Ok(None);
        }
        let mended = self.mended(records, None)?;
        Ok((mended.clock.is_none() || mended.blind).then_some(mended))
    }

    fn named(
        &self,
        records: &[Record],
        held: bool,
        watch: &dyn Watch,
    ) -> Result<Vec<Cause>, DiagnoseError> {
        let Chosen { whole, chosen, .. } = self.answered(records, None, self.max_causes, watch)?;
        let context = whole.context();
        let mut causes = context.names(&chosen);
        if held {
            let (used, test) = (searchable(records, None), self.scoring(records, None));
            let (start, firsts) = (&whole.start, firsts(records));
            let from = Source { start, test: &test, used: &used, firsts: &firsts, watch };
            context.held_instead(&chosen, &from, &mut causes);
        }
        Ok(causes)
    }
}
