//! Records of which no model says what their columns are.

use super::error::DataError;
use super::matching::Want;
use super::reading::Reading;
use super::record::Record;
use super::remark::Remark;
use super::step::Step;
use super::table::Table;
use crate::fault::Place;

/// What is known of such a record.
///
/// ```
/// use lacuna::data::{Bare, Table};
///
/// let table = Table::read("u,y\n1,2\n3,4\n".as_bytes(), "press.csv")?;
/// let bare = Bare { step: Some(0.1), ..Bare::default() };
/// let (record, _) = table.bare_record(&bare)?;
/// assert_eq!(record.inputs[0].values, [1.0, 3.0]);
/// # Ok::<(), lacuna::data::DataError>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Bare {
    /// Columns that drive; empty: those called u, u1, u2..
    pub inputs: Vec<String>,
    /// Columns that are measured; empty: those called y, y1, y2..
    pub outputs: Vec<String>,
    /// Whether a clock that is not regular is made so.
    pub repair: bool,
    /// Time between two samples in s, where no clock says it.
    pub step: Option<f64>,
    /// Order of a model to come, which takes twice as many samples at least.
    pub order: Option<usize>,
}

impl Table {
    /// Names of the columns that are called by a letter, `u`, `u1`, `u2`.., in the order of their
    /// numbers.
    pub fn lettered(&self, letter: char) -> Vec<&str> {
        let number = |name: &str| match name.strip_prefix(letter)? {
            "" => Some(0),
            digits if digits.bytes().all(|b| b.is_ascii_digit()) => digits.parse::<u32>().ok(),
            _ => None,
        };
        let mut found: Vec<(u32, &str)> =
            self.names().into_iter().filter_map(|name| Some((number(name)?, name))).collect();
        found.sort_unstable();
        found.into_iter().map(|(_, name)| name).collect()
    }

    /// The record with the columns that were asked for, or those called by the letters u and y.
    ///
    /// # Errors
    ///
    /// As [`Table::record_by`], and: a column that is to be an input and an output, no column of a
    /// letter where none was named.
    pub fn bare_record(&self, bare: &Bare) -> Result<(Record, Vec<Remark>), DataError> {
        let inputs = self.group(&bare.inputs, 'u', "inputs")?;
        let outputs = self.group(&bare.outputs, 'y', "outputs")?;
        self.of_columns_called(&inputs, &outputs, bare)
    }

    /// The record to look at before any model: where no output is named and none is called by the
    /// letter y, all columns of numbers that do not drive are measured.
    ///
    /// # Errors
    ///
    /// As [`Table::bare_record`], but a record without inputs is taken.
    pub fn record_to_look_at(&self, bare: &Bare) -> Result<(Record, Vec<Remark>), DataError> {
        let named = |given: &[String], letter| match given {
            [] => self.lettered(letter).into_iter().map(String::from).collect(),
            _ => given.to_vec(),
        };
        let drives = named(&bare.inputs, 'u');
        let mut measured = named(&bare.outputs, 'y');
        if measured.is_empty() {
            let free = |name: &&str| {
                let is_clock = name.eq_ignore_ascii_case("time");
                let fine = !name.is_empty() && !is_clock && self.values(name).is_ok();
                fine && !drives.iter().any(|drive| drive == name)
            };
            measured = self.names().into_iter().filter(free).map(String::from).collect();
        }
        self.of_columns_called(&drives, &measured, bare)
    }

    fn of_columns_called(
        &self,
        inputs: &[String],
        outputs: &[String],
        bare: &Bare,
    ) -> Result<(Record, Vec<Remark>), DataError> {
        if let Some(name) = outputs.iter().find(|name| inputs.contains(name)) {
            return Err(DataError::Roles {
                at: Box::new(Place { key: Some(name.clone()), ..Place::default() }),
                problem: format!("`{name}` cannot be an input and an output"),
                remedy: "name each column once, with --inputs or with --outputs".into(),
            });
        }
        let pairs = |names: &[String]| names.iter().map(|n| (n.clone(), String::new())).collect();
        let want = Want {
            inputs: pairs(inputs),
            outputs: pairs(outputs),
            step: Step::Free { default: bare.step },
            outputs_required: true,
            minimum: 2 * bare.order.unwrap_or(1),
        };
        self.record_by(&want, &Reading { repair: bare.repair, ..Reading::default() })
    }

    /// The columns given, or those of a letter: there have to be some.
    fn group(&self, given: &[String], letter: char, role: &str) -> Result<Vec<String>, DataError> {
        if !given.is_empty() {
            return Ok(given.to_vec());
        }
        let found = self.lettered(letter);
        if !found.is_empty() {
            return Ok(found.into_iter().map(String::from).collect());
        }
        let known: Vec<&str> =
            self.names().into_iter().filter(|name| !matches!(*name, "" | "time")).collect();
        Err(DataError::Roles {
            at: Box::new(Place { file: Some(self.source().into()), ..Place::default() }),
            problem: format!(
                "no column is called {letter} or {letter}1, so the {role} are not known; there are: {}",
                known.join(", ")
            ),
            remedy: format!("name them: --{role} {}", known.first().unwrap_or(&"COLUMN")),
        })
    }
}
