//! A linear map as encoder.

use serde::{Deserialize, Serialize};

use super::learned::by_what_is_learned;
use super::{Encoder, EncoderError, Learned, Scaling, Shape, Window};

/// The linear part of eq. `encoder_ann_struct` alone: rows W^b and W^a, and a bias.
///
/// ```
/// use lacuna::encoder::Encoder;
///
/// let encoder: Box<dyn Encoder> = toml::from_str("[linear]\nn_a = 4\nn_b = 6")?;
/// assert_eq!(encoder.window().rows(1, 1), 10);
/// # Ok::<(), toml::de::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Stored")]
pub struct LinearEncoder {
    n_a: usize,
    n_b: usize,
    current_sample: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    learned: Option<Learned>,
}

/// What a file holds, before it is checked.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Stored {
    n_a: usize,
    n_b: usize,
    #[serde(default)]
    current_sample: bool,
    #[serde(default)]
    learned: Option<Learned>,
}

impl TryFrom<Stored> for LinearEncoder {
    type Error = EncoderError;

    fn try_from(stored: Stored) -> Result<Self, EncoderError> {
        let Stored { n_a, n_b, current_sample, learned } = stored;
        if let Some(learned) = &learned {
            learned.check(Window { n_a, n_b, current_sample }, &[])?;
        }
        Ok(Self { n_a, n_b, current_sample, learned })
    }
}

impl LinearEncoder {
    /// An encoder without weights.
    pub fn new(window: Window) -> Self {
        let Window { n_a, n_b, current_sample } = window;
        Self { n_a, n_b, current_sample, learned: None }
    }

    /// What it has learned.
    pub fn learned(&self) -> Option<&Learned> {
        self.learned.as_ref()
    }
}

#[typetag::serde(name = "linear")]
impl Encoder for LinearEncoder {
    fn window(&self) -> Window {
        Window { n_a: self.n_a, n_b: self.n_b, current_sample: self.current_sample }
    }

    fn prepare(&mut self, shape: Shape, scaling: Scaling, seed: u64) -> Result<(), EncoderError> {
        self.learned = Some(Learned::new(self.window(), &[], shape, scaling, seed)?);
        Ok(())
    }

    by_what_is_learned!();
}
