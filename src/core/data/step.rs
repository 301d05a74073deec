//! The sampling time: the record's, the model's, or a quarrel between the two.

use super::clock::{self, JITTER};
use super::error::DataError;
use super::remark::Remark;
use super::table::{Column, Table};
use super::unit::{Relation, relate};

/// What a model knows of the sampling time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// A continuous-time model takes the record's step; `default`, in s, is for a record
    /// without a time column.
    Free {
        /// The `sampling_time` of the model file, if there is one.
        default: Option<f64>,
    },
    /// A discrete model has its own, in s. A record whose step is more than 1 % off is
    /// refused; of one that is less off, the record gets the model's.
    Fixed(f64),
}

impl Table {
    /// The sampling time of the record, s, of what the model and the time column say.
    pub(super) fn step_for(
        &self,
        wanted: Step,
        found: Option<f64>,
        remarks: &mut Vec<Remark>,
    ) -> Result<f64, DataError> {
        let stated = match wanted {
            Step::Free { default } => default,
            Step::Fixed(step) => Some(step),
        };
        if let Some(step) = stated
            && !(step > 0.0 && step.is_finite())
        {
            return Err(DataError::setting("sampling_time", step, "a positive number of seconds"));
        }
        match (wanted, found, stated) {
            (Step::Fixed(step), Some(found), _) => {
                let off = (found - step).abs() / step;
                if off > JITTER {
                    let line = self.lines.get(1).copied().unwrap_or(self.header_line);
                    let column = self.find_for("time").map(|column| self.place(column, line));
                    let at = column.unwrap_or_default();
                    return Err(DataError::StepDiffers { at, found, wanted: step });
                }
                // below this nobody stated the difference: it is the digits of the times
                if off > 1e-6 {
                    remarks.push(Remark::Step { found, stated: step, taken: step });
                }
                Ok(step)
            }
            (Step::Free { .. }, Some(found), Some(stated)) => {
                if (found - stated).abs() > JITTER * stated {
                    remarks.push(Remark::Step { found, stated, taken: found });
                }
                Ok(found)
            }
            (_, Some(step), None) | (_, None, Some(step)) => Ok(step),
            (_, None, None) if self.find_for("time").is_some() => {
                Err(DataError::TooFew { at: self.whole(), found: self.rows(), needed: 2 })
            }
            (_, None, None) => {
                let like_time = |column: &&Column| {
                    let name = column.name.to_lowercase();
                    let time_unit = !column.unit.is_empty()
                        && !matches!(relate(&column.unit, "s"), Relation::Clash { .. });
                    time_unit || name == "t" || name.starts_with("time")
                };
                let perhaps = self.columns.iter().find(like_time).map(|column| {
                    let clock = clock::of(self, column, &mut Vec::new());
                    (column.name.clone(), clock.ok().flatten().and_then(|clock| clock.step))
                });
                let mut at = self.whole();
                at.key = Some("sampling_time".into());
                Err(DataError::NoSamplingTime { at, perhaps })
            }
        }
    }
}
