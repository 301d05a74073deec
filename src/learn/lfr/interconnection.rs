//! The whole model: S, the blocks it joins, and the sizes of its signals.

use serde::{Deserialize, Serialize};

use super::{Block, LfrError, Matrix, Sink, Source};

/// An augmented model, Hoekstra et al., eq. `augmentation_structure`:
///
/// ```text
/// [x+; y; z] = S [x; u; e; w],   w = φ(z) block by block.
/// ```
///
/// All signals are in physical units; the scales that learning wants are inside the blocks.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Interconnection {
    /// Length of x̂: baseline states and augmented states.
    pub states: usize,
    /// Length of u.
    pub inputs: usize,
    /// Length of ŷ.
    pub outputs: usize,
    /// The blocks, in the order in which S numbers them.
    pub blocks: Vec<Block>,
    /// How everything is joined.
    pub s: Matrix,
}

/// Signals of one kind at most: memory is taken for each before anything is simulated.
const MOST: usize = 100_000;

impl Interconnection {
    /// Everything that is wrong with the interconnection, loops included.
    ///
    /// # Errors
    ///
    /// The first fault found.
    pub fn check(&self) -> Result<(), LfrError> {
        let sizes = [("states", self.states), ("inputs", self.inputs), ("outputs", self.outputs)];
        if let Some((what, found)) = sizes.into_iter().find(|(_, found)| *found > MOST) {
            return Err(LfrError::Size { what, most: MOST, found });
        }
        for (b, block) in self.blocks.iter().enumerate() {
            match block {
                Block::Network(learned) => learned.check()?,
                Block::Baseline(baseline) => {
                    let faults = baseline.system.model.faults();
                    if let Some(fault) = faults.first() {
                        let reason =
                            format!("{} is {}, not {}", fault.key, fault.found, fault.expected);
                        return Err(LfrError::Baseline { block: b, reason });
                    }
                    if !baseline.system.effects.is_empty() {
                        let reason = "effects act between the samples that S joins: \
                            `lfr::Sampled` makes a model of whole samples of both"
                            .into();
                        return Err(LfrError::Baseline { block: b, reason });
                    }
                    // how it is sampled and integrated
                    if let Err(error) = baseline.system.plan(baseline.sampling_time) {
                        return Err(LfrError::Baseline { block: b, reason: error.to_string() });
                    }
                    let count = baseline.sizes().theta;
                    if baseline.theta.as_ref().is_some_and(|theta| theta.len() != count) {
                        let found = baseline.theta.as_ref().map_or(0, Vec::len);
                        return Err(LfrError::Length { what: "theta", expected: count, found });
                    }
                    if let Some(&free) = baseline.free.iter().find(|&&free| free >= count) {
                        return Err(LfrError::Length {
                            what: "free",
                            expected: count,
                            found: free + 1,
                        });
                    }
                }
            }
        }
        for (to, from, entry) in self.s.entries() {
            if !entry.value.is_finite() {
                return Err(LfrError::NotFinite { to, from, value: entry.value });
            }
            let of_block = |b: usize, len: fn(&Block) -> usize| self.blocks.get(b).map_or(0, len);
            let (i, count) = match from {
                Source::State(i) => (i, self.states),
                Source::Input(i) => (i, self.inputs),
                Source::Error(i) => (i, self.outputs),
                Source::Block(b, i) => (i, of_block(b, Block::outputs)),
            };
            if i >= count {
                return Err(LfrError::NoSource { to, from, count });
            }
            let (i, count) = match to {
                Sink::State(i) => (i, self.states),
                Sink::Output(i) => (i, self.outputs),
                Sink::Block(b, i) => (i, of_block(b, Block::inputs)),
            };
            if i >= count {
                return Err(LfrError::NoSink { to, from, count });
            }
        }
        self.check_ramps()
    }

    /// Inputs that move between samples are known beforehand only if they are the model's own.
    fn check_ramps(&self) -> Result<(), LfrError> {
        for (b, block) in self.blocks.iter().enumerate() {
            let Block::Baseline(baseline) = block else { continue };
            let n = baseline.sizes();
            if !baseline.ramps() {
                continue;
            }
            for i in n.x..n.x + n.u {
                let row: Vec<_> = self.s.row(Sink::Block(b, i)).collect();
                let own = Source::Input(i - n.x);
                if !matches!(row[..], [(from, e)] if from == own && e.value == 1.0 && !e.learned) {
                    return Err(LfrError::Ramp { block: b, input: i });
                }
            }
        }
        Ok(())
    }

    /// Number of parameters that training changes; see [`Self::parameters`].
    pub fn count(&self) -> usize {
        self.parameters().len()
    }

    /// Everything that training changes: block by block the weights of a network or the free
    /// parameters of a baseline, then the learned entries of S.
    pub fn parameters(&self) -> Vec<f64> {
        let mut all = vec![];
        for block in &self.blocks {
            match block {
                Block::Network(learned) => all.extend_from_slice(learned.net.weights()),
                Block::Baseline(baseline) => {
                    let theta = baseline.theta();
                    all.extend(baseline.free.iter().map(|&i| theta[i]));
                }
            }
        }
        all.extend(self.s.learned().map(|(.., value)| value));
        all
    }

    /// Takes over other values.
    ///
    /// # Errors
    ///
    /// If their number is another one.
    pub fn set_parameters(&mut self, values: &[f64]) -> Result<(), LfrError> {
        let (expected, found) = (self.count(), values.len());
        if expected != found {
            return Err(LfrError::Length { what: "parameters", expected, found });
        }
        let mut at = 0;
        for block in &mut self.blocks {
            match block {
                Block::Network(learned) => {
                    let weights = learned.net.weights_mut();
                    weights.copy_from_slice(&values[at..][..weights.len()]);
                    at += weights.len();
                }
                Block::Baseline(baseline) if !baseline.free.is_empty() => {
                    let mut theta = baseline.theta();
                    for &i in &baseline.free {
                        theta[i] = values[at];
                        at += 1;
                    }
                    baseline.theta = Some(theta);
                }
                Block::Baseline(_) => {}
            }
        }
        self.s.set_learned(&values[at..]);
        Ok(())
    }
}
