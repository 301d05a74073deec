//! A wrong sampling time or a shifted column against a wrong model: which explains with less.

use super::data_faults::Fault;
use super::diagnosis::Diagnosis;
use super::error::DiagnoseError;
use super::findings::hand_over::Searched;
use super::fit::hypothesis::Track;
use super::prepare::input_dependence::DEPENDS;
use crate::data::Record;
use crate::watch::Watch;

/// A cause in the machine explains as much as a wrong clock if it removes so much less at most.
const AS_MUCH: f64 = 0.02;
/// Parameters named as wrong beside a wrong clock from which on they may be all that is wrong.
const SEVERAL: usize = 2;

impl Diagnosis<'_> {
    /// A record whose clock seems to be wrong: if one cause in the machine explains as much, the
    /// machine is to blame and the clock is another name of that. Parameters that have to move
    /// whatever the clock says are to blame as well. Says whether the clock is to blame.
    pub(super) fn clocked(
        &self,
        records: &[Record],
        test: Option<&Record>,
        fault: &Fault,
        watch: &dyn Watch,
    ) -> Result<(Searched, bool), DiagnoseError> {
        let as_much = |of: &Searched| {
            of.causes.len() == 1 && of.gain.error_removed >= fault.removed - AS_MUCH
        };
        let machine = self.search(records, test, self.max_causes, watch)?;
        if as_much(&machine) {
            return Ok((machine.or_else(fault.alternative()), false));
        }
        let one = self.search(records, test, 1, watch)?;
        if as_much(&one) {
            return Ok((machine.or_else(fault.alternative()), false));
        }
        let mended: Vec<Record> = records.iter().map(|r| fault.mend(r)).collect();
        let mended_test = test.map(|record| fault.mend(record));
        let searched = self.search(&mended, mended_test.as_ref(), self.max_causes, watch)?;
        if one.track == Track::ParametersFree && !searched.causes.is_empty() {
            let nothing_left = machine.dependence < DEPENDS;
            let parameters =
                |of: &Searched| of.causes.iter().filter(|cause| cause.is_parameter()).count();
            let laws = |of: &Searched| of.causes.len() - parameters(of);
            // parameters that are wrong anyway may make up for a clock, however many it takes
            let anyway = parameters(&searched) >= SEVERAL && laws(&machine) <= laws(&searched);
            if nothing_left && (anyway || machine.causes.len() <= searched.causes.len() + 1) {
                return Ok((machine.or_else(fault.alternative()), false));
            }
        }
        Ok((searched, true))
    }
}
