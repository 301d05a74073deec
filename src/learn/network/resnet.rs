//! The residual network itself.

use serde::{Deserialize, Serialize};

use super::{Layout, NetworkError};
use crate::data::Random;
use crate::real::Real;

/// What a network's weights are before anything is learned.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Start {
    /// Hidden layers random, output layer and linear part zero: the network's output is
    /// exactly 0, and its gradient is not. The start of a learned part beside a baseline.
    Zero,
    /// All layers random, the linear part too.
    Random,
}

/// A feedforward network with tanh units beside a linear map, Hoekstra et al.,
/// eq. `encoder_ann_struct`:
///
/// y = W_o h_m + b_o + W_l x, with h_i = tanh(W_i h_{i-1} + b_i) and h_0 = x.
///
/// # Example
///
/// ```
/// use lacuna::network::{Layout, ResNet, Start};
///
/// // two inputs, two layers of eight units, one output; it starts as the function 0
/// let mut net = ResNet::new(Layout::new(2, &[8, 8], 1)?, Start::Zero, 7);
/// assert_eq!(net.forward(&[0.3, -1.0])?, [0.0]);
/// // the linear part alone
/// let linear = net.layout().linear();
/// net.weights_mut()[linear].copy_from_slice(&[2.0, 1.0]);
/// assert!((net.forward(&[0.3, -1.0])?[0] + 0.4).abs() < 1e-15);
/// # Ok::<(), lacuna::network::NetworkError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Stored")]
pub struct ResNet {
    layout: Layout,
    weights: Vec<f64>,
}

/// What a file holds, before its lengths are checked.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Stored {
    layout: Layout,
    weights: Vec<f64>,
}

impl TryFrom<Stored> for ResNet {
    type Error = NetworkError;

    fn try_from(stored: Stored) -> Result<Self, NetworkError> {
        let Stored { layout, weights } = stored;
        let layout = Layout::new(layout.inputs(), layout.hidden(), layout.outputs())?;
        Self::with_weights(layout, weights)
    }
}

impl ResNet {
    /// A network with fresh weights. Weights and biases of a layer are uniform within
    /// 1/sqrt(number of its inputs) on both sides of 0, drawn from `seed` alone.
    pub fn new(layout: Layout, start: Start, seed: u64) -> Self {
        let mut random = Random::new(seed);
        let mut weights = vec![0.0; layout.len()];
        let maps = layout.layers().into_iter().chain(match start {
            Start::Zero => None,
            Start::Random => Some(layout.output_map()),
        });
        for map in maps.chain((start == Start::Random).then(|| layout.linear_map())) {
            let count = map.outputs * (map.inputs + usize::from(map.bias.is_some()));
            let bound = 1.0 / (map.inputs.max(1) as f64).sqrt();
            for weight in &mut weights[map.weights..][..count] {
                *weight = bound * (2.0 * random.uniform() - 1.0);
            }
        }
        Self { layout, weights }
    }

    /// A network with given weights, in the order of [`Layout`].
    ///
    /// # Errors
    ///
    /// If their number is another one, or one of them is not finite.
    pub fn with_weights(layout: Layout, weights: Vec<f64>) -> Result<Self, NetworkError> {
        if weights.len() != layout.len() {
            return Err(NetworkError::Weights { expected: layout.len(), found: weights.len() });
        }
        match weights.iter().position(|w| !w.is_finite()) {
            Some(index) => Err(NetworkError::NotFinite { index }),
            None => Ok(Self { layout, weights }),
        }
    }

    /// Sizes and order of the weights.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// All weights, in the order of [`Layout`].
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// All weights, to be changed.
    pub fn weights_mut(&mut self) -> &mut [f64] {
        &mut self.weights
    }

    /// The outputs for one input vector.
    ///
    /// # Errors
    ///
    /// [`NetworkError::Samples`] if `x` has another length than the network's inputs.
    pub fn forward(&self, x: &[f64]) -> Result<Vec<f64>, NetworkError> {
        let inputs = self.layout.inputs();
        if x.len() != inputs {
            let (rows, found) = (inputs, x.len());
            return Err(NetworkError::Samples {
                what: "x",
                rows,
                samples: 1,
                expected: rows,
                found,
            });
        }
        let mut y = vec![0.0; self.layout.outputs()];
        self.apply(x, &mut y);
        Ok(y)
    }

    /// The same where the lengths are known to be right.
    pub(crate) fn apply(&self, x: &[f64], y: &mut [f64]) {
        let w = &self.weights;
        let row = |begin: usize, with: &[f64]| {
            w[begin..].iter().zip(with).map(|(w, x)| w * x).sum::<f64>()
        };
        let mut h = x.to_vec();
        for layer in self.layout.layers() {
            let bias = layer.bias.unwrap_or(0);
            let unit =
                |o: usize| Real::tanh(w[bias + o] + row(layer.weights + o * layer.inputs, &h));
            h = (0..layer.outputs).map(unit).collect();
        }
        let (output, linear) = (self.layout.output_map(), self.layout.linear_map());
        let bias = self.layout.output_bias().start;
        let h = if self.layout.hidden().is_empty() { &[] } else { &h[..] };
        for (o, y) in y.iter_mut().enumerate() {
            *y = w[bias + o]
                + row(output.weights + o * output.inputs, h)
                + row(linear.weights + o * linear.inputs, x);
        }
    }
}
