//! Data preprocessing before a search: gross errors, dead sensors, dropouts, readings that stand
//! still, columns of the wrong sign (Ljung, System Identification, 1999, chapter 14).

use super::data_faults::{Fault, dead, flipped, gross_errors, retimed, strike, unrelated};
use super::diagnosis::Diagnosis;
use super::error::DiagnoseError;
use super::findings::cause::Cause;
use super::prepare::joined_records::firsts;
use super::prepare::known_clipping::cut_off;
use super::segmentation::horizon;
use crate::data::Record;
use crate::evaluate::{EvaluateError, Init, Simulation};

/// Records without the faults that were found in them.
#[derive(Clone)]
pub(super) struct Mended {
    pub records: Vec<Record>,
    pub test: Option<Record>,
    pub faults: Vec<Fault>,
    /// What is wrong with their clock, if nothing in the machine is.
    pub clock: Option<Fault>,
    /// Whether no output measures anything.
    pub blind: bool,
}

impl Diagnosis<'_> {
    /// Strikes out what instruments made up, and turns a column of the wrong sign.
    pub(super) fn mended(
        &self,
        records: &[Record],
        test: Option<&Record>,
    ) -> Result<Mended, EvaluateError> {
        let (clean, gross): (Vec<Record>, Vec<Vec<Fault>>) = records
            .iter()
            .zip(firsts(records))
            .map(|(record, first)| gross_errors(record, first))
            .unzip();
        let (mut clean, mut faults) = (clean, gross.concat());
        let mut test = test.map(|record| gross_errors(record, 0).0);
        let mut silent = dead(self.system, &clean)?;
        silent.extend(unrelated(self.system, &clean, &silent)?);
        let outputs = self.system.signals().outputs;
        let measured = |name: &String| clean.iter().any(|r| r.signal(name).is_some());
        let blind = !silent.is_empty()
            && outputs
                .iter()
                .map(|output| &output.name)
                .all(|name| !measured(name) || silent.iter().any(|fault| fault.into == *name));
        if blind {
            faults.splice(0..0, silent);
            return Ok(Mended { records: clean, test, faults, clock: None, blind });
        }
        for signal in clean.iter_mut().chain(&mut test).flat_map(|r| &mut r.outputs) {
            if silent.iter().any(|fault| fault.into == signal.name) {
                signal.values.fill(f64::NAN);
            }
        }
        faults.splice(0..0, silent);
        let mut all = vec![];
        for (record, first) in clean.iter().zip(firsts(records)) {
            let run = Simulation::of(self.system, record, Init::Forgotten)?;
            let (mended, found) = strike(record, &run.outputs, first);
            all.push(mended);
            faults.extend(found);
        }
        if let Some(record) = &test {
            let run = Simulation::of(self.system, record, Init::Forgotten)?;
            test = Some(strike(record, &run.outputs, 0).0);
        }
        // most records have the sign that they should have
        let (turned, mut clock) =
            rayon::join(|| flipped(self.system, &all), || retimed(self.system, &all));
        if let Some(fault) = turned? {
            all = all.iter().map(|record| fault.mend(record)).collect();
            test = test.map(|record| fault.mend(&record));
            faults.insert(0, fault);
            clock = retimed(self.system, &all);
        }
        Ok(Mended { records: all, test, faults, clock: clock?, blind })
    }

    /// Faults of the data that show before any search, and the records without them: readings
    /// that the instrument made up are missing values, a column of the wrong sign is turned. A
    /// wrong clock is for a search to tell from a wrong model, and not among them.
    ///
    /// # Errors
    ///
    /// If model and records do not go together, or the baseline cannot be simulated.
    pub fn data_faults(
        &self,
        records: &[Record],
    ) -> Result<(Vec<Record>, Vec<Cause>), DiagnoseError> {
        for record in records {
            self.check_baseline(record)?;
        }
        if horizon(self.system, records)?.is_some() {
            return Ok((records.to_vec(), vec![]));
        }
        let Mended { mut records, faults, .. } = self.mended(records, None)?;
        let mut causes: Vec<Cause> = faults.iter().map(Fault::cause).collect();
        causes.extend(cut_off(&mut records).iter().map(Fault::cause));
        Ok((records, causes))
    }
}
