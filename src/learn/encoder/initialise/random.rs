//! Chance.

use serde::{Deserialize, Serialize};

use super::{EncoderInitialiser, Found, started};
use crate::encoder::{Baseline, Encoder, EncoderError, Started};

/// Weights at random, as they are without any knowledge of the baseline but the spreads of
/// its signals: the start that Hoekstra et al. compare with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Random {}

#[typetag::serde(name = "random")]
impl EncoderInitialiser for Random {
    fn initialise(
        &self,
        encoder: &mut dyn Encoder,
        baseline: &Baseline<'_>,
        seed: u64,
    ) -> Result<Started, EncoderError> {
        baseline.prepare(encoder, seed)?;
        started("random", encoder, baseline, Found::default(), None)
    }
}
