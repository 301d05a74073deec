//! What an encoder that is a network has learned.

use serde::{Deserialize, Serialize};

use super::batch::Batch;
use super::{EncoderError, LinearMap, Scaling, Shape, Window};
use crate::network::{Layout, ResNet, Start};

/// A network between its scales, with the shape it was made for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Learned {
    /// Signals and states.
    pub shape: Shape,
    /// Scales of all of them.
    pub scaling: Scaling,
    /// From scaled window to scaled states.
    pub network: ResNet,
}

impl Learned {
    /// Fresh weights.
    pub(crate) fn new(
        window: Window,
        hidden: &[usize],
        shape: Shape,
        scaling: Scaling,
        seed: u64,
    ) -> Result<Self, EncoderError> {
        let rows = window.rows(shape.outputs, shape.inputs);
        if rows == 0 {
            return Err(EncoderError::EmptyWindow { n_a: window.n_a, n_b: window.n_b });
        }
        let layout = Layout::new(rows, hidden, shape.states())?;
        let learned = Self { shape, scaling, network: ResNet::new(layout, Start::Random, seed) };
        learned.check(window, hidden)?;
        Ok(learned)
    }

    /// Whether everything fits together, as it may not in a file.
    pub(crate) fn check(&self, window: Window, hidden: &[usize]) -> Result<(), EncoderError> {
        let (layout, shape) = (self.network.layout(), self.shape);
        let counts = [
            (
                "rows of the encoder's window",
                window.rows(shape.outputs, shape.inputs),
                layout.inputs(),
            ),
            ("states of the encoder", shape.states(), layout.outputs()),
            ("hidden layers of the encoder", hidden.len(), layout.hidden().len()),
        ];
        let units = hidden.iter().zip(layout.hidden()).map(|(a, b)| ("units of a layer", *a, *b));
        for (what, expected, found) in counts.into_iter().chain(units) {
            if expected != found {
                return Err(EncoderError::Count { what, expected, found });
            }
        }
        if !self.scaling.fits(shape) {
            let expected = shape.outputs + shape.inputs + shape.states();
            let scaling = &self.scaling;
            let found = scaling.outputs.len() + scaling.inputs.len() + scaling.states.len();
            return Err(EncoderError::Count {
                what: "positive scales of the encoder",
                expected,
                found,
            });
        }
        Ok(())
    }

    pub(crate) fn set_weights(&mut self, weights: &[f64]) -> Result<(), EncoderError> {
        let network = ResNet::with_weights(self.network.layout().clone(), weights.to_vec())?;
        self.network = network;
        Ok(())
    }

    pub(crate) fn estimate(
        &self,
        window: Window,
        windows: &[f64],
        samples: usize,
    ) -> Result<Vec<f64>, EncoderError> {
        let batch = self.batch(window, windows, samples)?;
        Ok(batch.outputs(self.network.weights()))
    }

    pub(crate) fn gradient(
        &self,
        window: Window,
        windows: &[f64],
        slopes: &[f64],
        samples: usize,
    ) -> Result<Vec<f64>, EncoderError> {
        let (expected, found) = (self.shape.states() * samples, slopes.len());
        if expected != found {
            return Err(EncoderError::Count { what: "slopes along states", expected, found });
        }
        let batch = self.batch(window, windows, samples)?;
        let mut gradient = vec![0.0; self.network.weights().len()];
        batch.along_weights(self.network.weights(), slopes, &mut gradient);
        Ok(gradient)
    }

    fn batch(
        &self,
        window: Window,
        windows: &[f64],
        samples: usize,
    ) -> Result<Batch<f64>, EncoderError> {
        let rows = self.network.layout().inputs();
        if windows.len() != rows * samples {
            let (expected, found) = (rows * samples, windows.len());
            return Err(EncoderError::Count { what: "values of the windows", expected, found });
        }
        Ok(Batch::new(self.network.layout(), self.scaling.frame(window), windows, samples))
    }

    /// The linear part becomes the map, for its rows, which are the states from `first` on; the
    /// output layer's weights of these states 0, so that hidden layers have no say at first.
    pub(crate) fn set_linear(
        &mut self,
        window: Window,
        first: usize,
        map: &LinearMap,
    ) -> Result<(), EncoderError> {
        let (inputs, states) = (self.network.layout().inputs(), map.bias.len());
        let room = self.shape.states().saturating_sub(first);
        let counts = [
            ("columns of the linear map", inputs, map.weights.ncols()),
            ("rows of the linear map", states, map.weights.nrows()),
            ("rows of the linear map", states.min(room), states),
        ];
        for (what, expected, found) in counts {
            if expected != found {
                return Err(EncoderError::Count { what, expected, found });
            }
        }
        let layout = self.network.layout().clone();
        let units = layout.hidden().last().copied().unwrap_or(0);
        let rows = self.scaling.rows(window);
        let weights = self.network.weights_mut();
        let (linear, output) = (layout.linear().start, layout.output().start);
        let bias = layout.output_bias().start;
        for i in 0..states {
            let (row, to) = (first + i, self.scaling.states[first + i]);
            let mut constant = map.bias[i] - to.offset;
            for (j, from) in rows.iter().enumerate() {
                let weight = map.weights[(i, j)];
                constant += weight * from.offset;
                weights[linear + row * inputs + j] = weight * from.scale / to.scale;
            }
            weights[bias + row] = constant / to.scale;
            weights[output + row * units..][..units].fill(0.0);
        }
        Ok(())
    }
}

/// The parts of [`Encoder`](super::Encoder) that all encoders with something [`Learned`]
/// have in common.
macro_rules! by_what_is_learned {
    () => {
        fn shape(&self) -> Option<$crate::encoder::Shape> {
            self.learned.as_ref().map(|learned| learned.shape)
        }

        fn scaling(&self) -> Option<&$crate::encoder::Scaling> {
            self.learned.as_ref().map(|learned| &learned.scaling)
        }

        fn weights(&self) -> &[f64] {
            self.learned.as_ref().map_or(&[], |learned| learned.network.weights())
        }

        fn set_weights(&mut self, weights: &[f64]) -> Result<(), EncoderError> {
            self.learned.as_mut().ok_or(EncoderError::NotReady)?.set_weights(weights)
        }

        fn estimate(&self, windows: &[f64], samples: usize) -> Result<Vec<f64>, EncoderError> {
            let learned = self.learned.as_ref().ok_or(EncoderError::NotReady)?;
            learned.estimate(self.window(), windows, samples)
        }

        fn gradient(
            &self,
            windows: &[f64],
            slopes: &[f64],
            samples: usize,
        ) -> Result<Vec<f64>, EncoderError> {
            let learned = self.learned.as_ref().ok_or(EncoderError::NotReady)?;
            learned.gradient(self.window(), windows, slopes, samples)
        }

        fn set_linear(&mut self, map: &$crate::encoder::LinearMap) -> Result<(), EncoderError> {
            let window = self.window();
            self.learned.as_mut().ok_or(EncoderError::NotReady)?.set_linear(window, 0, map)
        }

        fn set_linear_from(
            &mut self,
            first: usize,
            map: &$crate::encoder::LinearMap,
        ) -> Result<(), EncoderError> {
            let window = self.window();
            self.learned.as_mut().ok_or(EncoderError::NotReady)?.set_linear(window, first, map)
        }

        fn network(&self) -> Option<&$crate::network::ResNet> {
            self.learned.as_ref().map(|learned| &learned.network)
        }

        fn copied(&self) -> Box<dyn Encoder> {
            Box::new(self.clone())
        }
    };
}

pub(super) use by_what_is_learned;
