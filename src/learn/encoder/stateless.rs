//! The encoder of a model without states: a function of no weights onto nothing.
//!
//! Where outputs follow from the inputs of the same instant, y = h(u) + phi(u), there is no initial state
//! to estimate, and a section may begin at any sample.

use serde::{Deserialize, Serialize};

use super::{Encoder, EncoderError, Scaling, Shape, Window};

/// Estimates the states of a model that has none. Trainings of such models use it whatever encoder they
/// are given.
///
/// ```
/// use lacuna::encoder::{Encoder, StatelessEncoder};
///
/// let encoder = StatelessEncoder::default();
/// assert_eq!((encoder.window().reach(), encoder.weights().len()), (0, 0));
/// ```
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StatelessEncoder {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    prepared: Option<(Shape, Scaling)>,
}

impl StatelessEncoder {
    fn ready(&self) -> Result<(), EncoderError> {
        self.prepared.as_ref().map(|_| ()).ok_or(EncoderError::NotReady)
    }
}

#[typetag::serde(name = "none")]
impl Encoder for StatelessEncoder {
    fn window(&self) -> Window {
        Window::past(0)
    }

    fn shape(&self) -> Option<Shape> {
        self.prepared.as_ref().map(|(shape, _)| *shape)
    }

    fn prepare(&mut self, shape: Shape, scaling: Scaling, _: u64) -> Result<(), EncoderError> {
        if shape.states() > 0 {
            let (what, found) = ("states of a model for the encoder `none`", shape.states());
            return Err(EncoderError::Count { what, expected: 0, found });
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
        self.ready()?;
        match weights.len() {
            0 => Ok(()),
            found => Err(EncoderError::Count { what: "weights", expected: 0, found }),
        }
    }

    fn estimate(&self, _: &[f64], _: usize) -> Result<Vec<f64>, EncoderError> {
        self.ready().map(|()| vec![])
    }

    fn gradient(&self, _: &[f64], _: &[f64], _: usize) -> Result<Vec<f64>, EncoderError> {
        self.ready().map(|()| vec![])
    }

    fn copied(&self) -> Box<dyn Encoder> {
        Box::new(self.clone())
    }
}
