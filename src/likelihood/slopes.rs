//! Slopes of a hypothesis: what each of its free numbers changes at its site, sample by sample.
//!
//! One column per number, along the hypothesis' own path: dw/d(number) of a law, 1 of a parameter. The tangents
//! of the innovations follow from them (`tangent.rs`); laws that remember give them at once (`memory.rs`). Source: Ljung, "System Identification", 2nd ed., section 10.3.

use rayon::prelude::*;

use super::follow::Followed;
use super::hypothesis::{Hypothesis, Part};
use super::memory::remembers;
use super::predictor::{Predictor, column};
use super::sensor_path::Reading;
use super::tangent::{Column, Site};

impl Predictor {
    /// One column per free number of a hypothesis.
    pub(crate) fn slopes(&self, of: &Hypothesis, run: &Followed) -> Vec<Column> {
        let path = &run.path;
        let entries = self.model.plan.sources.entries.len();
        let readings = self.readings(&of.parts, path);
        let mut columns = vec![];
        for (at, (part, reading)) in of.parts.iter().zip(readings).enumerate() {
            match part {
                Part::Parameter(p) => {
                    columns.push((Site::Parameter(*p), vec![1.0; path.len]).into());
                }
                Part::Law { law, .. } if remembers(&law.card) => {
                    let slope = |&i: &usize| Column::Innovations(self.slope_of_memory(of, at, i));
                    columns.par_extend(law.free.par_iter().map(slope));
                }
                Part::Law { site, source, law } => {
                    if let Some(Reading { z, reaches }) = reading {
                        let mut slopes = law.slopes(&z, &[]);
                        let each =
                            slopes.iter_mut().flat_map(|slope| slope.iter_mut().zip(&reaches));
                        each.for_each(|(slope, reaches)| *slope *= reaches);
                        columns.extend(slopes.into_iter().map(|slope| (*site, slope).into()));
                        continue;
                    }
                    let z = source.map_or(vec![1.0; path.len], |e| column(&path.seen, entries, e));
                    let load = law.load.map(|e| column(&path.seen, entries, e)).unwrap_or_default();
                    let slopes = law.slopes(&z, &load).into_iter();
                    columns.extend(slopes.map(|slope| (*site, slope).into()));
                }
            }
        }
        columns
    }
}
