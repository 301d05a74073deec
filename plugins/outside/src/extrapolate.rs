//! An encoder without weights: a position and its speed, from the last two outputs.

use lacuna::encoder::{Encoder, EncoderError, Scaling, Shape, Window};
use serde::{Deserialize, Serialize};

/// For models of one output whose states are that output and its rate of change.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Extrapolate {
    /// s.
    pub sampling_time: f64,
    #[serde(skip)]
    prepared: Option<(Shape, Scaling)>,
}

impl Extrapolate {
    /// An encoder for records of this sampling time, in s.
    pub fn new(sampling_time: f64) -> Self {
        Self { sampling_time, prepared: None }
    }
}

#[typetag::serde(name = "extrapolate")]
impl Encoder for Extrapolate {
    fn window(&self) -> Window {
        Window { n_a: 2, n_b: 0, current_sample: false }
    }

    fn shape(&self) -> Option<Shape> {
        self.prepared.as_ref().map(|(shape, _)| *shape)
    }

    fn prepare(&mut self, shape: Shape, scaling: Scaling, _: u64) -> Result<(), EncoderError> {
        if (shape.outputs, shape.states()) != (1, 2) {
            let what = "states of a model with one output";
            return Err(EncoderError::Count { what, expected: 2, found: shape.states() });
        }
        self.prepared = Some((shape, scaling));
        Ok(())
    }

    fn scaling(&self) -> Option<&Scaling> {
        self.prepared.as_ref().map(|(_, scaling)| scaling)
    }

    fn weights(&self) -> &[f64] {
        &[]
    }

    fn set_weights(&mut self, weights: &[f64]) -> Result<(), EncoderError> {
        match weights.len() {
            0 => Ok(()),
            found => Err(EncoderError::Count { what: "weights", expected: 0, found }),
        }
    }

    fn estimate(&self, windows: &[f64], samples: usize) -> Result<Vec<f64>, EncoderError> {
        if windows.len() != 2 * samples {
            let (expected, found) = (2 * samples, windows.len());
            return Err(EncoderError::Count { what: "values of windows", expected, found });
        }
        let (newest, older) = windows.split_at(samples);
        let pairs = || newest.iter().zip(older);
        let positions = pairs().map(|(new, old)| 2.0 * new - old);
        let speeds = pairs().map(|(new, old)| (new - old) / self.sampling_time);
        Ok(positions.chain(speeds).collect())
    }

    fn gradient(&self, _: &[f64], _: &[f64], _: usize) -> Result<Vec<f64>, EncoderError> {
        Ok(vec![])
    }

    fn copied(&self) -> Box<dyn Encoder> {
        Box::new(self.clone())
    }
}
