//! A learned term against the coordinate that it depends on.

use super::figure::{Figure, Role};
use super::overlay::with_unit;
use super::page::Page;

/// A learned term as it was read back, drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct LearnedCurve {
    /// Name and unit of the coordinate.
    pub coordinate: (String, String),
    /// Name and unit of the channel that it enters.
    pub channel: (String, String),
    /// The term: coordinate and mean of what is added there.
    pub middle: Vec<(f64, f64)>,
    /// Two standard deviations about it: coordinate, low, high.
    pub band: Vec<(f64, f64, f64)>,
    /// What the baseline gives into the same channel where this coordinate alone moves.
    pub baseline: Vec<(f64, f64)>,
    /// What it is, in words.
    pub sentence: String,
}

/// The section.
pub(super) fn section(page: &mut Page, curve: &LearnedCurve) {
    let (of, into) = (&curve.coordinate, &curve.channel);
    page.heading(&format!("What was learned: {} into {}", of.0, into.0));
    page.element("p", "note", &curve.sentence);
    let mut figure = Figure::new(&with_unit(&of.0, &of.1), &with_unit(&into.0, &into.1))
        .titled("Learned term")
        .band(
            Role::Floor,
            "what the coordinate does not decide (two standard deviations)",
            curve.band.clone(),
        )
        .line(Role::After, "learned", curve.middle.clone());
    if !curve.baseline.is_empty() {
        figure = figure.line(Role::Before, "baseline", curve.baseline.clone());
    }
    page.figure(figure);
}
