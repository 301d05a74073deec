//! A network fitted to the baseline before anything else (Hoekstra et al., Sec. 3.2).

use serde::{Deserialize, Serialize};

use super::least_squares::solve;
use super::{EncoderInitialiser, Found, as_it_is, set_linear, started};
use crate::encoder::baseline::Examples;
use crate::encoder::batch::{Batch, Targets};
use crate::encoder::{Baseline, Encoder, EncoderError, Outputs, Started};
use crate::network::{Frame, Precision, ResNet};
use crate::optimise::{Adam, Lbfgs, Named, Objective, Optimiser, Stop};

/// Lowers V_enc, the mean squared distance between the encoder's states and the baseline's,
/// each over its standard deviation: a few steps of Adam, then L-BFGS.
///
/// From random weights, 50 steps and memory 50, as in the paper's table; 250 steps of L-BFGS
/// where that has 200.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Prefit {
    /// Outputs in the windows.
    pub outputs: Outputs,
    /// Where the network starts from.
    pub start: PrefitStart,
    /// An optimiser in the place of both below, by its own settings.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub optimiser: Option<Named>,
    /// Steps of Adam; 0 for none.
    pub adam_steps: usize,
    /// Their size.
    pub adam_rate: f64,
    /// Steps of L-BFGS; 0 for none.
    pub lbfgs_steps: usize,
    /// Pairs of steps and changes of the gradient that it remembers.
    pub memory: usize,
    /// Whether the network is evaluated in double precision: half as fast, and of no use
    /// before the error is below a millionth of the states.
    pub double_precision: bool,
}

impl Default for Prefit {
    fn default() -> Self {
        Self {
            outputs: Outputs::default(),
            start: PrefitStart::default(),
            optimiser: None,
            adam_steps: 50,
            adam_rate: 1e-2,
            lbfgs_steps: 250,
            memory: 50,
            double_precision: false,
        }
    }
}

/// Where a pre-fit starts from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PrefitStart {
    /// Weights at random, as the paper has it.
    #[default]
    Random,
    /// The linear part from least squares, the hidden layers at random and without say.
    LeastSquares,
}

/// V_enc as a function of the weights of a network.
struct Distance<E: Precision> {
    batch: Batch<E>,
    targets: Targets<E>,
    weights: usize,
}

impl<E: Precision> Distance<E> {
    fn new(network: &ResNet, frame: Frame, examples: &Examples, scales: &[f64]) -> Self {
        let (n, layout) = (examples.samples, network.layout());
        // augmented states have no counterpart and count for nothing
        let (mut wanted, mut scales) = (examples.states.clone(), scales.to_vec());
        wanted.resize(layout.outputs() * n, 0.0);
        scales.resize(layout.outputs(), f64::INFINITY);
        Self {
            batch: Batch::new(layout, frame, &examples.windows, n),
            targets: Targets::new(&wanted, n, &scales),
            weights: layout.len(),
        }
    }
}

impl<E: Precision> Objective for Distance<E> {
    fn len(&self) -> usize {
        self.weights
    }

    fn value_and_gradient(&self, weights: &[f64], gradient: &mut [f64]) -> f64 {
        self.batch.distance(weights, &self.targets, gradient)
    }
}

/// The same for an encoder that is no network, by its own estimates and slopes.
struct ByEncoder<'a> {
    encoder: &'a dyn Encoder,
    examples: &'a Examples,
    scales: Vec<f64>,
}

impl Objective for ByEncoder<'_> {
    fn len(&self) -> usize {
        self.encoder.weights().len()
    }

    fn value_and_gradient(&self, weights: &[f64], gradient: &mut [f64]) -> f64 {
        let (n, states) = (self.examples.samples, self.scales.len());
        let mut encoder = self.encoder.copied();
        let estimated =
            encoder.set_weights(weights).and_then(|()| encoder.estimate(&self.examples.windows, n));
        let Ok(estimated) = estimated else { return f64::NAN };
        // augmented states have no counterpart and no slope
        let mut slopes = vec![0.0; estimated.len()];
        let mut sum = 0.0;
        for s in 0..states {
            let over = 1.0 / (self.scales[s] * self.scales[s] * n as f64);
            for k in s * n..(s + 1) * n {
                let off = estimated[k] - self.examples.states[k];
                sum += 0.5 * off * off * over;
                slopes[k] = off * over;
            }
        }
        let along = encoder.gradient(&self.examples.windows, &slopes, n);
        let Ok(along) = along else { return f64::NAN };
        gradient.copy_from_slice(&along);
        sum
    }
}

impl Prefit {
    /// Runs the two methods one after the other.
    fn lower(
        &self,
        objective: &dyn Objective,
        weights: &mut [f64],
        found: &mut Found,
    ) -> Result<(), EncoderError> {
        if let Some(optimiser) = &self.optimiser {
            found.optimised.push(optimiser.minimise(objective, weights, &mut ())?);
            return Ok(());
        }
        if self.adam_steps > 0 {
            let stop = Stop::after(self.adam_steps);
            let adam = Adam { rate: self.adam_rate, stop, ..Adam::default() };
            found.optimised.push(adam.minimise(objective, weights, &mut ())?);
        }
        if self.lbfgs_steps > 0 {
            let memory = self.memory;
            let stop = Stop { steps: self.lbfgs_steps, ..Lbfgs::default().stop };
            let lbfgs = Lbfgs { memory, stop, ..Lbfgs::default() };
            found.optimised.push(lbfgs.minimise(objective, weights, &mut ())?);
        }
        Ok(())
    }
}

#[typetag::serde(name = "prefit")]
impl EncoderInitialiser for Prefit {
    fn initialise(
        &self,
        encoder: &mut dyn Encoder,
        baseline: &Baseline<'_>,
        seed: u64,
    ) -> Result<Started, EncoderError> {
        if let Some(started) = as_it_is("prefit", encoder, baseline, seed)? {
            return Ok(started);
        }
        let window = encoder.window();
        let examples = baseline.examples(window, self.outputs)?;
        let mut found = Found::default();
        if self.start == PrefitStart::LeastSquares {
            let solved = solve(&examples);
            (found.rank, found.condition) = (Some(solved.rank), Some(solved.condition));
            set_linear("prefit", encoder, &solved.map)?;
        }
        let scaling = encoder.scaling().cloned().ok_or(EncoderError::NotReady)?;
        let states = baseline.shape().baseline_states;
        let scales: Vec<f64> = scaling.states[..states].iter().map(|s| s.scale).collect();
        let mut weights = encoder.weights().to_vec();
        match encoder.network() {
            Some(network) => {
                let frame = scaling.frame(window);
                if self.double_precision {
                    let objective = Distance::<f64>::new(network, frame, &examples, &scales);
                    self.lower(&objective, &mut weights, &mut found)?;
                } else {
                    let objective = Distance::<f32>::new(network, frame, &examples, &scales);
                    self.lower(&objective, &mut weights, &mut found)?;
                }
            }
            None => {
                let objective = ByEncoder { encoder: &*encoder, examples: &examples, scales };
                self.lower(&objective, &mut weights, &mut found)?;
            }
        }
        encoder.set_weights(&weights)?;
        started("prefit", encoder, baseline, found, Some((self.outputs, &examples)))
    }
}
