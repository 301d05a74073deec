//! What cases of one kind came to.

use serde::Serialize;

use super::{Conditions, Hit, Kind, Marks};
use crate::Quartiles;

/// What cases of one kind under the same conditions came to. Shares are of those cases to
/// which the question applies; `None` where it applies to none.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tally {
    /// What was asked.
    pub kind: Kind,
    /// Size of the hidden effects.
    pub g: f64,
    /// How the records were taken.
    #[serde(flatten)]
    pub conditions: Conditions,
    /// Cases.
    pub cases: usize,
    /// A hidden effect stands in the first cause's set.
    pub first: Option<f64>,
    /// All hidden effects stand in the sets of causes.
    pub named: Option<f64>,
    /// All hidden effects head a cause.
    pub exact: Option<f64>,
    /// Not all named, but parameters alone took nearly all of the error.
    pub imitated: Option<f64>,
    /// Something was named that was not hidden.
    pub spurious: f64,
    /// The first set holds at most three names, of those with a cause.
    pub small_sets: Option<f64>,
    /// Median share removed on a third record without noise.
    pub removed_median: Option<f64>,
    /// At least 90 % removed.
    pub mostly_removed: Option<f64>,
    /// Nothing was claimed although something was hidden: `unexplained`.
    pub unexplained: f64,
    /// True coefficients inside their 95 % intervals.
    pub coverage: Option<f64>,
    /// True gains inside their 95 % intervals.
    pub gain_coverage: Option<f64>,
}

fn share(yes: impl IntoIterator<Item = bool>) -> Option<f64> {
    let (mut all, mut true_ones) = (0.0, 0.0);
    for yes in yes {
        all += 1.0;
        true_ones += f64::from(u8::from(yes));
    }
    (all > 0.0).then(|| true_ones / all)
}

fn median(values: Vec<f64>) -> Option<f64> {
    Quartiles::of(values).map(|of| of.median)
}

impl Tally {
    pub(super) fn of(marks: &[&Marks]) -> Option<Self> {
        let case = &marks.first()?.case;
        let guilty = || marks.iter().filter(|m| !m.hidden.is_empty());
        let removed = || marks.iter().filter_map(|m| m.removed);
        Some(Self {
            kind: case.kind,
            g: case.g,
            conditions: case.conditions.clone(),
            cases: marks.len(),
            first: share(guilty().map(|m| m.first)),
            named: share(guilty().map(|m| m.all())),
            exact: share(guilty().map(|m| m.hits.iter().all(|h| *h == Hit::Exact))),
            imitated: share(guilty().map(|m| m.imitated())),
            spurious: share(marks.iter().map(|m| m.spurious() > 0)).unwrap_or(0.0),
            small_sets: share(
                marks.iter().map(|m| m.set_size()).filter(|&n| n > 0).map(|n| n <= 3),
            ),
            removed_median: median(removed().collect()),
            mostly_removed: share(removed().map(|r| r >= 0.9)),
            unexplained: share(marks.iter().map(|m| m.verdict == "unexplained")).unwrap_or(0.0),
            coverage: share(marks.iter().flat_map(|m| m.covered.iter().copied())),
            gain_coverage: share(marks.iter().filter_map(|m| m.gain_covered)),
        })
    }
}
