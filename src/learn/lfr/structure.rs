//! The usual ways to put something learned beside, before or behind a baseline.

use serde::{Deserialize, Serialize};

use super::reach::{is_moved, is_seen, known};
use super::{Baseline, Block, Interconnection, Learned, LfrError, Matrix, Sink, Source};
use crate::network::{Layout, NetworkError, ResNet, Start};

/// Where the learned part stands (arXiv 2404.01901, 2602.17297). In every structure it is
/// added to what the baseline alone would do, so that a network that starts as the function
/// 0 starts as the baseline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Form {
    /// Beside it: x_b+ = f_base(x_b, u) + φ(x̂, u), Hoekstra et al., Sec. 4.3.
    #[default]
    Parallel,
    /// Before it: x_b+ = f_base(x_b + φ_x(x̂, u), u + φ_u(x̂, u)).
    SeriesIn,
    /// Behind it: x_b+ = f_base(x_b, u) + φ(x̂, u, f_base(x_b, u)).
    SeriesOut,
    /// In the path of the inputs alone: x_b+ = f_base(x_b, u + φ(x_a, u)).
    InputBlock,
    /// In the path of the outputs alone: y = h_base(x_b, u) + φ(x_a, h_base(x_b, u)).
    OutputBlock,
}

/// A structure to be built around a baseline.
///
/// # Example
///
/// ```
/// use lacuna::lfr::{Baseline, Scales, Structure};
/// use lacuna::plugins::systems::Duffing;
/// use lacuna::system::Sampling;
///
/// let model = Duffing { mass: 1.0, damping: 2.0, stiffness: 50.0, hardening: 9.0, fixed: vec![] };
/// let baseline = Baseline::new(model, Sampling::default(), 0.02);
/// let scales = Scales::plain(&baseline);
/// let model = Structure { hidden: vec![16, 16], ..Structure::default() }.build(baseline, &scales, 7)?;
/// assert_eq!((model.states, model.count()), (2, (16 * 3 + 16) + (16 * 16 + 16) + (2 * 16 + 2) + 2 * 3));
/// # Ok::<(), lacuna::lfr::LfrError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Structure {
    /// Where the learned part stands.
    pub form: Form,
    /// States x_a that are added to the baseline's: 0 makes a static augmentation.
    pub augmented_states: usize,
    /// Whether the state equation is augmented (parallel, series-out).
    pub state_equation: bool,
    /// Whether the output equation is augmented as well (parallel, series-out); that of a model
    /// without states always is.
    pub output_equation: bool,
    /// Widths of the networks' hidden layers.
    pub hidden: Vec<usize>,
    /// Names of the baseline's states that the state equation is augmented in; empty: all. A
    /// force enters the equation of a speed alone, and what is learned can then be read as one.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub into: Vec<String>,
    /// Names of the baseline's states and inputs that the networks see; empty: all.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub of: Vec<String>,
}

impl Default for Structure {
    fn default() -> Self {
        Self {
            form: Form::Parallel,
            augmented_states: 0,
            state_equation: true,
            output_equation: false,
            hidden: vec![16, 16],
            into: vec![],
            of: vec![],
        }
    }
}

/// Offsets and scales of a baseline's signals: of inputs and outputs from the record, of
/// states from the baseline's simulation. Augmented states count as they are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scales {
    /// Of each baseline state.
    pub states: Vec<(f64, f64)>,
    /// Of each input.
    pub inputs: Vec<(f64, f64)>,
    /// Of each output.
    pub outputs: Vec<(f64, f64)>,
}

impl Scales {
    /// Offsets 0 and scales 1.
    pub fn plain(baseline: &Baseline) -> Self {
        let (n, plain) = (baseline.sizes(), |count: usize| vec![(0.0, 1.0); count]);
        Self { states: plain(n.x), inputs: plain(n.u), outputs: plain(n.y) }
    }

    /// Mean and standard deviation of series; 1 where that is 0.
    pub fn of(states: &[&[f64]], inputs: &[&[f64]], outputs: &[&[f64]]) -> Self {
        let each = |series: &[&[f64]]| series.iter().map(|s| spread(s)).collect();
        Self { states: each(states), inputs: each(inputs), outputs: each(outputs) }
    }
}

/// Mean and standard deviation of the finite values; 1 where that is 0 but for rounding.
fn spread(values: &[f64]) -> (f64, f64) {
    let finite = || values.iter().filter(|v| v.is_finite());
    let count = finite().count().max(1) as f64;
    let mean = finite().sum::<f64>() / count;
    let deviation = (finite().map(|v| (v - mean).powi(2)).sum::<f64>() / count).sqrt();
    (mean, if deviation > 1e-12 * mean.abs() { deviation } else { 1.0 })
}

/// What a network sees or moves, with its offset and scale.
#[derive(Clone)]
struct Port<T> {
    at: T,
    scale: (f64, f64),
}

impl Structure {
    /// The structure around a baseline, its networks drawn from `seed`; block 0 is the
    /// baseline.
    ///
    /// # Errors
    ///
    /// If the scales do not fit, or nothing is learned.
    pub fn build(
        &self,
        baseline: Baseline,
        scales: &Scales,
        seed: u64,
    ) -> Result<Interconnection, LfrError> {
        let n = baseline.sizes();
        let given = [scales.states.len(), scales.inputs.len(), scales.outputs.len()];
        for (expected, found) in [n.x, n.u, n.y].into_iter().zip(given) {
            if expected != found {
                return Err(LfrError::Scales { expected, found });
            }
        }
        let signals = baseline.system.signals();
        let states = signals.states.iter().map(|state| &state.signal.name[..]);
        let inputs = signals.inputs.iter().map(|input| &input.name[..]);
        known("structure.into", &self.into, states.clone())?;
        known("structure.of", &self.of, states.chain(inputs))?;
        let mut plan = Plan::new(baseline, scales, self.augmented_states);
        let (x, u) = (plan.states(), plan.inputs());
        let augmented = plan.augmented();
        let seen = [x, u.clone()].concat();
        match self.form {
            Form::Parallel | Form::SeriesOut => {
                let behind = self.form == Form::SeriesOut;
                let own = |result: Vec<Port<Source>>| if behind { result } else { vec![] };
                let mut moved = if self.state_equation { plan.next_states() } else { vec![] };
                moved.extend(plan.next_augmented());
                // a model without states has the output equation only
                let output = self.output_equation || plan.n == 0;
                if !(moved.is_empty() && output) {
                    let seen = [seen.clone(), own(plan.f_base())].concat();
                    plan.learn(&seen, &moved, self, seed)?;
                }
                if output {
                    let moved = plan.measured();
                    plan.learn(&[seen, own(plan.h_base())].concat(), &moved, self, seed ^ OTHER)?;
                }
            }
            Form::SeriesIn => {
                let moved = [plan.before(), plan.next_augmented()].concat();
                plan.learn(&seen, &moved, self, seed)?;
            }
            Form::InputBlock => {
                let moved = [plan.before().split_off(n.x), plan.next_augmented()].concat();
                plan.learn(&[augmented, u].concat(), &moved, self, seed)?;
            }
            Form::OutputBlock => {
                let moved = [plan.measured(), plan.next_augmented()].concat();
                plan.learn(&[augmented, plan.h_base()].concat(), &moved, self, seed)?;
            }
        }
        let model = plan.model;
        model.check()?;
        Ok(model)
    }
}

/// Keeps the seeds of two networks apart.
const OTHER: u64 = 0x9e37_79b9_7f4a_7c15;

/// A model under construction.
struct Plan<'a> {
    model: Interconnection,
    scales: &'a Scales,
    /// Baseline states.
    n: usize,
}

impl<'a> Plan<'a> {
    /// The baseline alone.
    fn new(baseline: Baseline, scales: &'a Scales, augmented: usize) -> Self {
        let n = baseline.sizes();
        let mut s = Matrix::default();
        for i in 0..n.x {
            s.select(Sink::Block(0, i), Source::State(i));
            s.select(Sink::State(i), Source::Block(0, i));
        }
        for i in 0..n.u {
            s.select(Sink::Block(0, n.x + i), Source::Input(i));
        }
        for i in 0..n.y {
            s.select(Sink::Output(i), Source::Block(0, n.x + i));
        }
        let (states, blocks) = (n.x + augmented, vec![Block::Baseline(baseline)]);
        let model = Interconnection { states, inputs: n.u, outputs: n.y, blocks, s };
        Self { model, scales, n: n.x }
    }

    fn ports<T>(scales: &[(f64, f64)], at: impl Fn(usize) -> T) -> Vec<Port<T>> {
        scales.iter().enumerate().map(|(i, &scale)| Port { at: at(i), scale }).collect()
    }

    fn states(&self) -> Vec<Port<Source>> {
        [Self::ports(&self.scales.states, Source::State), self.augmented()].concat()
    }

    fn augmented(&self) -> Vec<Port<Source>> {
        let port = |i| Port { at: Source::State(i), scale: (0.0, 1.0) };
        (self.n..self.model.states).map(port).collect()
    }

    fn inputs(&self) -> Vec<Port<Source>> {
        Self::ports(&self.scales.inputs, Source::Input)
    }

    fn f_base(&self) -> Vec<Port<Source>> {
        Self::ports(&self.scales.states, |i| Source::Block(0, i))
    }

    fn h_base(&self) -> Vec<Port<Source>> {
        Self::ports(&self.scales.outputs, |i| Source::Block(0, self.n + i))
    }

    fn next_states(&self) -> Vec<Port<Sink>> {
        Self::ports(&self.scales.states, Sink::State)
    }

    fn next_augmented(&self) -> Vec<Port<Sink>> {
        let port = |i| Port { at: Sink::State(i), scale: (0.0, 1.0) };
        (self.n..self.model.states).map(port).collect()
    }

    fn measured(&self) -> Vec<Port<Sink>> {
        Self::ports(&self.scales.outputs, Sink::Output)
    }

    /// What the baseline is given.
    fn before(&self) -> Vec<Port<Sink>> {
        let scales = [&self.scales.states[..], &self.scales.inputs[..]].concat();
        Self::ports(&scales, |i| Sink::Block(0, i))
    }

    /// Adds a network from `seen` to `moved`. What is added has no offset.
    fn learn(
        &mut self,
        seen: &[Port<Source>],
        moved: &[Port<Sink>],
        structure: &Structure,
        seed: u64,
    ) -> Result<(), LfrError> {
        let signals = match &self.model.blocks[0] {
            Block::Baseline(baseline) => baseline.system.signals(),
            Block::Network(_) => crate::model::Signals::discrete(),
        };
        let (mut seen, mut moved) = (seen.to_vec(), moved.to_vec());
        seen.retain(|port| is_seen(&structure.of, &signals, port.at));
        moved.retain(|port| is_moved(&structure.into, &signals, port.at));
        if moved.is_empty() {
            return Err(LfrError::NothingLearned);
        }
        let layout = Layout::new(seen.len(), &structure.hidden, moved.len());
        let layout = layout.map_err(|error: NetworkError| LfrError::Network(error))?;
        let net = ResNet::new(layout, Start::Zero, seed);
        let number = self.model.blocks.len();
        let inputs = seen.iter().map(|port| port.scale).collect();
        let outputs = moved.iter().map(|port| (0.0, port.scale.1)).collect();
        self.model.blocks.push(Block::Network(Learned::scaled(net, inputs, outputs)?));
        for (i, port) in seen.iter().enumerate() {
            self.model.s.select(Sink::Block(number, i), port.at);
        }
        for (i, port) in moved.iter().enumerate() {
            self.model.s.select(port.at, Source::Block(number, i));
        }
        Ok(())
    }
}
