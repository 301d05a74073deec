//! Models of each order, and which order to take.

use super::fit::{Fitted, Free};
use super::form::{Model, stable};
use super::refine::refine;
use super::signals::Signals;
use super::subspace::{MOST, Sight};
use crate::statistics::{dot, rms};
use crate::watch::Watch;

/// Share of the mean square that a proposed state has to be worth.
const WORTH: f64 = 0.01;
/// Share that a state has to be worth that no singular value proposes.
const CLEARLY: f64 = 0.05;
/// What each number more has to gain, in units of what it gains from noise.
const PRICE: f64 = 4.0;
/// Root mean square over the outputs' spread below which what is left is rounding.
const EXACT: f64 = 1e-9;
/// Likeness of neighbouring residuals that is allowed for. More is hardly noise but what a
/// linear model gets wrong.
const ALIKE: f64 = 0.9;

/// A model of one order.
pub struct Found {
    pub order: usize,
    pub fitted: (Model, Fitted),
    /// Root mean square of the residuals of the start.
    pub before: f64,
    /// Poles of the start that were mirrored.
    pub mirrored: usize,
    pub steps: usize,
}

impl Found {
    fn square(&self) -> f64 {
        rms(&self.fitted.1.residuals).powi(2)
    }
}

/// The records, ready to be searched for models.
pub struct Search<'a> {
    pub signals: &'a Signals,
    /// Samples by which starts are told apart.
    pub part: Signals,
    pub sights: &'a [Sight],
    pub watch: &'a dyn Watch,
}

impl Search<'_> {
    /// The best model of one order: the best of all starts, refined.
    pub fn find(&self, order: usize) -> Option<Found> {
        self.watch.report(
            0.1 + 0.6 * order as f64 / (order + 4) as f64,
            &format!("fitting order {order}"),
        );
        let free = Free::all(self.signals.nu, self.signals.ny);
        let mut best: Option<(f64, usize, Model)> = None;
        for (a, c) in self.sights.iter().flat_map(|sight| sight.shapes(order)) {
            let Some((a, mirrored)) = stable(&a) else { continue };
            let start = Model::new(a, c, self.signals.nu);
            let Some((model, fitted)) = self.part.completed(&start, &free) else { continue };
            let size = rms(&fitted.residuals);
            if best.as_ref().is_none_or(|(least, ..)| size < *least) {
                best = Some((size, mirrored, model));
            }
        }
        let (_, mirrored, start) = best?;
        let start = self.signals.completed(&start, &free)?;
        let before = rms(&start.1.residuals);
        let (model, fitted, steps) = refine(self.signals, start, &free, self.watch);
        Some(Found { order, fitted: (model, fitted), before, mirrored, steps })
    }

    /// The model of the order that the records support, `most` at most: singular values propose,
    /// simulation error decides.
    pub fn settle(&self, most: usize) -> Option<Found> {
        let mut proposed: Vec<usize> =
            self.sights.iter().map(|s| s.order().clamp(1, MOST.min(most))).collect();
        proposed.sort_unstable();
        proposed.dedup();
        let mut proposed = proposed.into_iter();
        let mut best = self.find(proposed.next()?)?;
        for order in proposed {
            match self.find(order) {
                Some(higher) if self.worth(&best, &higher, WORTH) => best = higher,
                _ => break,
            }
        }
        let started = best.order;
        while best.order > 1 && !self.watch.stopped() {
            match self.find(best.order - 1) {
                Some(lower) if !self.worth(&lower, &best, WORTH) => best = lower,
                _ => break,
            }
        }
        while best.order >= started && best.order < most && !self.watch.stopped() {
            match self.find(best.order + 1) {
                Some(higher) if self.worth(&best, &higher, CLEARLY) => best = higher,
                _ => break,
            }
        }
        Some(best)
    }

    /// Whether a model of higher order is worth its numbers: it has to lower the mean square by
    /// `share`, and by [`PRICE`] times what noise of this colour gives to each of them. Rounding
    /// is not worth a state.
    fn worth(&self, low: &Found, high: &Found, share: f64) -> bool {
        let r = &high.fitted.1.residuals;
        // outputs stand side by side: the next sample of the same one is `ny` further
        let ahead = r.get(self.signals.ny..).unwrap_or(&[]);
        let alike = (dot(&r[..ahead.len()], ahead) / dot(r, r)).clamp(0.0, ALIKE);
        let numbers = (high.order - low.order) * (self.signals.nu + self.signals.ny);
        let noise = numbers as f64 * (1.0 + alike) / (1.0 - alike) / r.len().max(1) as f64;
        low.square() > EXACT * EXACT && low.square() > high.square() * (1.0 + share + PRICE * noise)
    }
}
