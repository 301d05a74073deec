//! The short way from a table to a record, for users of the library.

use super::error::DataError;
use super::matching::Want;
use super::record::Record;
use super::step::Step;
use super::table::Table;
use super::unit::header;

impl Table {
    /// The record of the named columns. A unit behind a name, `force [N]`, is what the
    /// record shall have.
    ///
    /// Columns that are not named are left out without a remark. The step is that of the
    /// column `time`, or of [`Table::sampled_at`] where there is none.
    ///
    /// ```
    /// use lacuna::data::Table;
    ///
    /// let text = "time,force [N],angle [deg]\n0,1.5,0\n0.1,1.5,180\n";
    /// let record = Table::read(text.as_bytes(), "press.csv")?.pick(&["force"], &["angle [rad]"])?;
    /// assert_eq!(record.sampling_time, 0.1);
    /// assert!((record.outputs[0].values[1] - std::f64::consts::PI).abs() < 1e-15);
    /// # Ok::<(), lacuna::data::DataError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`Table::record_for`].
    pub fn pick(&self, inputs: &[&str], outputs: &[&str]) -> Result<Record, DataError> {
        let split = |text: &&str| header(text).unwrap_or_else(|| (text.to_string(), String::new()));
        let want = Want {
            inputs: inputs.iter().map(split).collect(),
            outputs: outputs.iter().map(split).collect(),
            step: Step::Free { default: self.step },
            outputs_required: true,
            minimum: 1,
        };
        self.record_for(&want).map(|(record, _)| record)
    }

    /// The record of the columns `u`, `u1`, `u2`.. as inputs and `y`, `y1`, `y2`.. as
    /// outputs, in the order of their numbers.
    ///
    /// ```
    /// use lacuna::data::Table;
    ///
    /// let table = Table::read("u2,u1,y\n1,2,3\n4,5,6\n".as_bytes(), "press.csv")?;
    /// let record = table.sampled_at(0.1).u_and_y()?;
    /// assert_eq!(record.inputs[0].values, [2.0, 5.0]);
    /// # Ok::<(), lacuna::data::DataError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`Table::record_for`]; a table without any such output lacks the column `y`.
    pub fn u_and_y(&self) -> Result<Record, DataError> {
        let (inputs, mut outputs) = (self.lettered('u'), self.lettered('y'));
        if outputs.is_empty() {
            outputs.push("y");
        }
        self.pick(&inputs, &outputs)
    }

    /// The table with a step, in s, that holds where there is no column `time`.
    pub fn sampled_at(mut self, sampling_time: f64) -> Self {
        self.step = Some(sampling_time);
        self
    }
}
