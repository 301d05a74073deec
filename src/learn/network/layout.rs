//! Where each weight of a network stands in its flat vector.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::NetworkError;

/// Weights of a network at most: 800 MB of them, and as much for each of their moments.
const MOST: usize = 100_000_000;

/// Sizes of the layers of a [`ResNet`](super::ResNet), and the order of its weights.
///
/// The flat vector holds, for each hidden layer, W (one row per unit, row after row) and b;
/// then the output layer's W_o (absent without hidden layers) and b_o; then the linear part
/// W_l, one row per output.
///
/// ```
/// use lacuna::network::Layout;
///
/// let layout = Layout::new(5, &[16, 16], 4)?;
/// assert_eq!(layout.len(), (16 * 5 + 16) + (16 * 16 + 16) + (4 * 16 + 4) + 4 * 5);
/// # Ok::<(), lacuna::network::NetworkError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Layout {
    inputs: usize,
    hidden: Vec<usize>,
    outputs: usize,
}

/// One affine map of a network: `out` rows of `inputs` weights, then `out` biases.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Affine {
    /// Length of the vector it acts on.
    pub inputs: usize,
    /// Length of its result.
    pub outputs: usize,
    /// Where W begins.
    pub weights: usize,
    /// Where b begins, for all but the linear part.
    pub bias: Option<usize>,
}

impl Layout {
    /// A network of `inputs` numbers, hidden layers of the given widths, and `outputs`
    /// numbers. Without hidden layers it is a linear map with a bias.
    ///
    /// # Errors
    ///
    /// [`NetworkError::EmptyLayer`] if any size is 0, [`NetworkError::TooLarge`] if there would be
    /// more weights than are held.
    pub fn new(inputs: usize, hidden: &[usize], outputs: usize) -> Result<Self, NetworkError> {
        let sizes = [inputs].into_iter().chain(hidden.iter().copied()).chain([outputs]);
        if let Some((layer, _)) = sizes.enumerate().find(|(_, size)| *size == 0) {
            return Err(NetworkError::EmptyLayer { layer });
        }
        let layout = Self { inputs, hidden: hidden.to_vec(), outputs };
        match layout.count() {
            Some(count) if count <= MOST => Ok(layout),
            count => Err(NetworkError::TooLarge { count, most: MOST }),
        }
    }

    /// Number of weights, if it is a number that this machine has.
    fn count(&self) -> Option<usize> {
        let mut inputs = self.inputs;
        let mut count = self.inputs.checked_mul(self.outputs)?;
        for &outputs in self.hidden.iter().chain([&self.outputs]) {
            let own = inputs.checked_add(1)?.checked_mul(outputs)?;
            (count, inputs) = (count.checked_add(own)?, outputs);
        }
        Some(count)
    }

    /// How many numbers go in.
    pub fn inputs(&self) -> usize {
        self.inputs
    }

    /// Widths of the hidden layers.
    pub fn hidden(&self) -> &[usize] {
        &self.hidden
    }

    /// How many numbers come out.
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    /// Number of weights.
    #[allow(clippy::len_without_is_empty)] // never empty
    pub fn len(&self) -> usize {
        let linear = self.linear_map();
        linear.weights + linear.outputs * linear.inputs
    }

    /// Hidden units in all layers together.
    pub(crate) fn units(&self) -> usize {
        self.hidden.iter().sum()
    }

    /// The hidden layers in order.
    pub(crate) fn layers(&self) -> Vec<Affine> {
        let (mut at, mut inputs) = (0, self.inputs);
        let layer = |&outputs: &usize| {
            let bias = at + outputs * inputs;
            let affine = Affine { inputs, outputs, weights: at, bias: Some(bias) };
            (at, inputs) = (bias + outputs, outputs);
            affine
        };
        self.hidden.iter().map(layer).collect()
    }

    /// The output layer: from the last hidden layer, or from nothing but its bias.
    pub(crate) fn output_map(&self) -> Affine {
        let last = self.layers().last().copied();
        let weights = last.map_or(0, |l| l.bias.unwrap_or(0) + l.outputs);
        let inputs = last.map_or(0, |l| l.outputs);
        let bias = weights + self.outputs * inputs;
        Affine { inputs, outputs: self.outputs, weights, bias: Some(bias) }
    }

    /// The linear part W_l.
    pub(crate) fn linear_map(&self) -> Affine {
        let output = self.output_map();
        let weights = output.bias.unwrap_or(0) + self.outputs;
        Affine { inputs: self.inputs, outputs: self.outputs, weights, bias: None }
    }

    /// Where the linear part W_l stands: one row of `inputs` weights per output.
    pub fn linear(&self) -> Range<usize> {
        self.linear_map().weights..self.len()
    }

    /// Where the output layer's weights W_o stand (empty without hidden layers).
    pub fn output(&self) -> Range<usize> {
        let output = self.output_map();
        output.weights..output.weights + output.outputs * output.inputs
    }

    /// Where the output bias b_o stands.
    pub fn output_bias(&self) -> Range<usize> {
        let bias = self.output().end;
        bias..bias + self.outputs
    }

    /// Where the weights of hidden layer `layer` stand, one row per unit, and its biases.
    pub fn hidden_layer(&self, layer: usize) -> Option<(Range<usize>, Range<usize>)> {
        let affine = *self.layers().get(layer)?;
        let bias = affine.weights + affine.outputs * affine.inputs;
        Some((affine.weights..bias, bias..bias + affine.outputs))
    }
}
