//! Which of several records show a cause.

use std::ops::Range;

use serde::Serialize;

use crate::findings::context::Context;
use crate::fit::problem::{Grain, Model, Part};
use crate::statistics::weight;

/// Weight of a model in a mixture above which it is nearer to the truth than the other.
const NEARER: f64 = 0.5;

/// What one record says of a cause.
///
/// With y_b the extended model, y_a the same without the cause and refitted, f = y_b - y_a and
/// r_a = y - y_a, the weight of y_b in the mixture a + g (b - a) that is nearest to the record
/// is g = f'r_a / f'f: 1 where the cause is there as named, 0 where it is not (Bates, Granger,
/// Operational Research Quarterly 20, 1969; Davidson, MacKinnon, Econometrica 49, 1981). A
/// cause that only some records have was fitted to all of them, so that g is above 1 there.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct InRecord {
    /// The record: its file, or its number.
    pub record: String,
    /// g; `None` where the record was not moved by the cause at all.
    pub weight: Option<f64>,
    /// Its standard error, from blocks as long as the errors remember.
    pub std_error: Option<f64>,
    /// Whether the cause shows: g is above 1/2 and two standard errors above 0; it does not:
    /// g is two standard errors below 1/2; `None`: the record cannot tell.
    pub shows: Option<bool>,
}

impl Context<'_, '_> {
    /// What each of several records says of what the extended model, with outputs `with`, has beyond a
    /// model without one of its causes.
    pub fn per_record(&self, without: &Model, with: &[Vec<f64>]) -> Option<Vec<InRecord>> {
        let bare = self.problem.simulate(without, Grain::Fine)?;
        Some(self.in_records(&bare, with))
    }

    /// What each record says of what one simulation lacks against another.
    fn in_records(&self, bare: &[Vec<f64>], with: &[Vec<f64>]) -> Vec<InRecord> {
        let one = |(name, span): (&String, &Range<usize>)| {
            let (mut ff, mut fr) = (vec![], vec![]);
            for k in self.problem.samples(Part::All).filter(|k| span.contains(k)) {
                let (mut f2, mut f_r) = (0.0, 0.0);
                for o in (0..self.problem.y.len()).filter(|&o| self.problem.weight[o][k] > 0.0) {
                    let over = self.problem.scale[o].powi(-2);
                    let f = with[o][k] - bare[o][k];
                    f2 += over * f * f;
                    f_r += over * f * (self.problem.y[o][k] - bare[o][k]);
                }
                ff.push(f2);
                fr.push(f_r);
            }
            InRecord::of(name, weight(&ff, &fr))
        };
        self.joined.names.iter().zip(&self.joined.spans).map(one).collect()
    }
}

impl InRecord {
    pub(crate) fn of(name: &str, weight: Option<(f64, f64)>) -> Self {
        let shows = weight.and_then(|(g, error)| match g {
            _ if g + 2.0 * error < NEARER => Some(false),
            _ if g > NEARER && g > 2.0 * error => Some(true),
            _ => None,
        });
        Self {
            record: name.into(),
            weight: weight.map(|(g, _)| g),
            std_error: weight.map(|(_, error)| error),
            shows,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::noise;

    /// The weight that a record gives to f where it holds `share` of it, in red noise.
    fn weighed(share: f64, size: f64, seed: u64) -> InRecord {
        let f = noise::ar1(2000, 0.8, size, seed).unwrap();
        let e = noise::ar1(2000, 0.9, 1.0, 1000 + seed).unwrap();
        let ff: Vec<f64> = f.iter().map(|f| f * f).collect();
        let fr: Vec<f64> = f.iter().zip(&e).map(|(f, e)| f * (share * f + e)).collect();
        InRecord::of("a", weight(&ff, &fr))
    }

    #[test]
    fn records_with_and_without_and_too_short_of_words() {
        let (mut wrong, mut quiet) = (0, 0);
        for seed in 1..=100 {
            wrong += usize::from(weighed(1.0, 0.5, seed).shows != Some(true));
            wrong += usize::from(weighed(0.0, 0.5, seed).shows != Some(false));
            quiet += usize::from(weighed(0.0, 0.02, seed).shows != Some(false));
        }
        println!("{wrong} of 200 wrong, {quiet} of 100 silent");
        assert!(wrong <= 4 && quiet > 60, "{wrong}, {quiet}");
    }
}
