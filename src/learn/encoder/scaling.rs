//! Offsets and sizes of signals, so that networks work with numbers around 1.

use serde::{Deserialize, Serialize};

use super::{Shape, Window};
use crate::network::Frame;

/// A signal's middle and size, in its unit: (value - offset) / scale is around 1.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spread {
    /// Mean.
    pub offset: f64,
    /// Standard deviation, or 1 where that is 0.
    pub scale: f64,
}

impl Default for Spread {
    fn default() -> Self {
        Self { offset: 0.0, scale: 1.0 }
    }
}

impl Spread {
    /// Mean and standard deviation of the finite values.
    pub fn of(values: &[f64]) -> Self {
        let finite = || values.iter().filter(|v| v.is_finite());
        let count = finite().count().max(1) as f64;
        let offset = finite().sum::<f64>() / count;
        let scale = (finite().map(|v| (v - offset).powi(2)).sum::<f64>() / count).sqrt();
        // what is left of a constant by rounding is no size
        let usable = scale.is_finite() && scale > 1e-12 * offset.abs();
        Self { offset, scale: if usable { scale } else { 1.0 } }
    }
}

/// Spreads of all signals that an encoder deals with.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scaling {
    /// Outputs.
    pub outputs: Vec<Spread>,
    /// Inputs.
    pub inputs: Vec<Spread>,
    /// States: those of the baseline, then the augmented ones.
    pub states: Vec<Spread>,
}

impl Scaling {
    /// Offsets 0 and scales 1.
    pub fn plain(shape: Shape) -> Self {
        let plain = |n: usize| vec![Spread::default(); n];
        Self {
            outputs: plain(shape.outputs),
            inputs: plain(shape.inputs),
            states: plain(shape.states()),
        }
    }

    /// The spread of every row of a window.
    pub(crate) fn rows(&self, window: Window) -> Vec<Spread> {
        let places = window.places(self.outputs.len(), self.inputs.len());
        let of = |output: bool, i: usize| if output { self.outputs[i] } else { self.inputs[i] };
        places.into_iter().map(|place| of(place.output, place.signal)).collect()
    }

    /// The same as the frame around a network.
    pub(crate) fn frame(&self, window: Window) -> Frame {
        let pairs = |spreads: &[Spread]| spreads.iter().map(|s| (s.offset, s.scale)).collect();
        Frame { inputs: pairs(&self.rows(window)), outputs: pairs(&self.states) }
    }

    /// Whether all scales are positive numbers and the counts are those of a shape.
    pub(crate) fn fits(&self, shape: Shape) -> bool {
        let all = self.outputs.iter().chain(&self.inputs).chain(&self.states);
        let counts = [self.outputs.len(), self.inputs.len(), self.states.len()];
        counts == [shape.outputs, shape.inputs, shape.states()]
            && all.into_iter().all(|s| s.offset.is_finite() && s.scale.is_finite() && s.scale > 0.0)
    }
}
