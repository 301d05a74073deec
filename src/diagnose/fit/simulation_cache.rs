//! The last simulations: a search asks for what a model gives again and again.

use std::collections::VecDeque;
use std::sync::Mutex;

use crate::fit::supposed::{Grain, Model, Simulated};

/// Simulations that are kept: all trials of a stage, and what they stand on.
const KEPT: usize = 24;

/// Models with their outputs over the whole record, the latest last.
#[derive(Debug, Default)]
pub(crate) struct Remembered(Mutex<VecDeque<(Grain, Model, Simulated)>>);

impl Remembered {
    /// The outputs of a model, where they are known.
    pub fn recall(&self, model: &Model, grain: Grain) -> Option<Simulated> {
        let kept = self.0.lock().ok()?;
        kept.iter().rev().find(|(g, m, _)| *g == grain && m.is(model)).map(|(.., y)| y.clone())
    }

    /// Keeps the outputs of a model.
    pub fn keep(&self, model: &Model, grain: Grain, y: &Simulated) {
        if let Ok(mut kept) = self.0.lock() {
            if kept.len() == KEPT {
                kept.pop_front();
            }
            kept.push_back((grain, model.clone(), y.clone()));
        }
    }

    /// Forgets what fewer steps than the model's own gave: they, or their correction, changed.
    pub fn forget_coarse(&self) {
        if let Ok(mut kept) = self.0.lock() {
            kept.retain(|(grain, ..)| *grain == Grain::Fine);
        }
    }
}
