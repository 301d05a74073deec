//! An initialiser: the first state is the newest output, the others are 0.

use lacuna::encoder::{
    Baseline, Encoder, EncoderError, EncoderInitialiser, LinearMap, Outputs, Started,
};
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

/// x_1 = y_{k-1}.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HoldLast {}

#[typetag::serde(name = "hold_last")]
impl EncoderInitialiser for HoldLast {
    fn initialise(
        &self,
        encoder: &mut dyn Encoder,
        baseline: &Baseline<'_>,
        seed: u64,
    ) -> Result<Started, EncoderError> {
        baseline.prepare(encoder, seed)?;
        let shape = baseline.shape();
        let rows = encoder.window().rows(shape.outputs, shape.inputs);
        let mut weights = DMatrix::zeros(shape.baseline_states, rows);
        weights[(0, 0)] = 1.0; // outputs come first, the newest on top
        encoder.set_linear(&LinearMap { weights, bias: DVector::zeros(shape.baseline_states) })?;
        Ok(Started {
            initialiser: "hold_last",
            rank: None,
            condition: None,
            states: baseline.score(encoder, Outputs::Simulated)?,
            measured: vec![],
            optimised: vec![],
            notes: vec![],
        })
    }
}
