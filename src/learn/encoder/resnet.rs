//! A residual network as encoder.

use serde::{Deserialize, Serialize};

use super::learned::by_what_is_learned;
use super::{Encoder, EncoderError, Learned, Scaling, Shape, Window};

/// A network of tanh units beside linear rows W^b (baseline states) and W^a (augmented
/// states), Hoekstra et al., eq. `encoder_ann_struct`.
///
/// ```
/// use lacuna::encoder::Encoder;
///
/// let text = "[resnet]\nn_a = 9\nn_b = 9\nhidden = [16, 16]\ncurrent_sample = true";
/// let encoder: Box<dyn Encoder> = toml::from_str(text)?;
/// assert_eq!(encoder.window().rows(1, 1), 20);
/// # Ok::<(), toml::de::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Stored")]
pub struct ResNetEncoder {
    n_a: usize,
    n_b: usize,
    current_sample: bool,
    hidden: Vec<usize>,
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
    #[serde(default = "two_by_sixteen")]
    hidden: Vec<usize>,
    #[serde(default)]
    learned: Option<Learned>,
}

fn two_by_sixteen() -> Vec<usize> {
    vec![16, 16]
}

impl TryFrom<Stored> for ResNetEncoder {
    type Error = EncoderError;

    fn try_from(stored: Stored) -> Result<Self, EncoderError> {
        let Stored { n_a, n_b, current_sample, hidden, learned } = stored;
        if let Some(learned) = &learned {
            learned.check(Window { n_a, n_b, current_sample }, &hidden)?;
        }
        Ok(Self { n_a, n_b, current_sample, hidden, learned })
    }
}

impl ResNetEncoder {
    /// An encoder without weights; `hidden` are the widths of its layers.
    pub fn new(window: Window, hidden: &[usize]) -> Self {
        let Window { n_a, n_b, current_sample } = window;
        Self { n_a, n_b, current_sample, hidden: hidden.to_vec(), learned: None }
    }

    /// What it has learned.
    pub fn learned(&self) -> Option<&Learned> {
        self.learned.as_ref()
    }
}

#[typetag::serde(name = "resnet")]
impl Encoder for ResNetEncoder {
    fn window(&self) -> Window {
        Window { n_a: self.n_a, n_b: self.n_b, current_sample: self.current_sample }
    }

    fn prepare(&mut self, shape: Shape, scaling: Scaling, seed: u64) -> Result<(), EncoderError> {
        self.learned = Some(Learned::new(self.window(), &self.hidden, shape, scaling, seed)?);
        Ok(())
    }

    by_what_is_learned!();
}
