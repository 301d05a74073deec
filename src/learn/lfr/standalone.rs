//! An interconnection as a model like any other: what a fitted model is saved as.

use std::sync::OnceLock;

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::model::{
    Ask, Block as Question, Call, Fault, LaneNumber, Law, Signal, Signals, State, TimeKind,
};
use crate::system::System;

use super::compiled::{Compiled, gather, row};
use super::program::{Op, Place, Program};
use super::solo;
use super::{Baseline, Block, Interconnection, Learned, LfrError, Sink, Source};

/// An augmented model (Hoekstra et al., eq. `augmentation_structure`) as a discrete-time
/// model: it simulates, can be estimated, diagnosed and extended like any other. Its states
/// are the baseline's and then `xa1`.., its parameters the baseline's. The prediction error
/// ê is 0, as in every free run; what S hands from it to the states is the gain by which the model
/// predicts.
///
/// # Example
///
/// ```
/// use lacuna::lfr::{AugmentedModel, Baseline, Scales, Structure};
/// use lacuna::plugins::systems::Duffing;
/// use lacuna::system::Sampling;
///
/// let model = Duffing { mass: 1.0, damping: 2.0, stiffness: 50.0, hardening: 9.0, fixed: vec![] };
/// let baseline = Baseline::new(model, Sampling::default(), 0.02);
/// let scales = Scales::plain(&baseline);
/// let joined = Structure::default().build(baseline, &scales, 7)?;
/// let system = AugmentedModel::new(joined).into_system()?;
/// assert_eq!(system.signals().states.len(), 2);
/// # Ok::<(), lacuna::lfr::LfrError>(())
/// ```
#[derive(Debug, Serialize, Deserialize)]
#[serde(transparent)]
pub struct AugmentedModel {
    /// Baseline, learned blocks and S.
    pub of: Interconnection,
    #[serde(skip)]
    compiled: OnceLock<Option<Compiled>>,
}

impl AugmentedModel {
    /// An interconnection as a model.
    pub fn new(of: Interconnection) -> Self {
        Self { of, compiled: OnceLock::new() }
    }

    /// The model as a system, sampled as its baseline is. Values that were fitted for the
    /// baseline's parameters are written into the baseline itself.
    ///
    /// # Errors
    ///
    /// If the interconnection is wrong, or no model by itself: an algebraic loop, not exactly
    /// one baseline.
    pub fn into_system(mut self) -> Result<System, LfrError> {
        self.of.check()?;
        for (number, block) in self.of.blocks.iter_mut().enumerate() {
            let Block::Baseline(baseline) = block else { continue };
            let Some(theta) = baseline.theta.take() else { continue };
            let names = baseline.system.signals().parameters;
            let changes: Vec<(String, f64)> = names
                .iter()
                .zip(theta)
                .filter(|(parameter, value)| parameter.value != *value)
                .map(|(parameter, value)| (parameter.name.clone(), value))
                .collect();
            let model = baseline.system.model.as_ref();
            baseline.system.model = crate::model::with_parameters(model, &changes)
                .map_err(|e| LfrError::Baseline { block: number, reason: e.to_string() })?;
        }
        if let Some(fault) = self.faults().into_iter().next() {
            let reason = format!("{} is {}, not {}", fault.key, fault.found, fault.expected);
            return Err(LfrError::Baseline { block: 0, reason });
        }
        let sampling_time = self.baseline().map(|baseline| baseline.sampling_time);
        let sampling = crate::system::Sampling { sampling_time, ..Default::default() };
        Ok(System::new(self, sampling))
    }

    fn baseline(&self) -> Option<&Baseline> {
        self.of.blocks.iter().find_map(|block| match block {
            Block::Baseline(baseline) => Some(baseline),
            Block::Network(_) => None,
        })
    }

    fn compiled(&self) -> Option<&Compiled> {
        self.compiled.get_or_init(|| Compiled::of(&self.of)).as_ref()
    }

    fn learned(&self, block: usize) -> Option<&Learned> {
        match self.of.blocks.get(block) {
            Some(Block::Network(learned)) => Some(learned),
            _ => None,
        }
    }

    fn reply<R: LaneNumber>(&self, ask: Ask, question: &Question<'_, R>, out: &mut [R]) {
        let (Some(compiled), Some(baseline)) = (self.compiled(), self.baseline()) else {
            return out.fill(R::constant(f64::NAN));
        };
        let (program, n, ramps) = (&compiled.program, question.sizes, self.ramped());
        let inner = baseline.sizes();
        let law: &dyn Law = baseline.system.model.as_ref();
        let nothing = vec![R::constant(0.0); inner.x.max(inner.u).max(inner.w)];
        let end = program.shared + program.frame;
        let mut rows = vec![R::constant(0.0); end + program.states];
        let mut room = solo::Room::new(inner.x);
        for (pack, out) in out.chunks_exact_mut(n.answer(ask).max(1)).enumerate() {
            let theta = &question.theta[pack * n.theta..][..n.theta];
            if ask == Ask::Derived {
                let [x, u, w] = [inner.x, inner.u, inner.w].map(|count| &nothing[..count]);
                let own = Question {
                    sizes: inner,
                    packs: 1,
                    theta,
                    derived: &[],
                    x,
                    u,
                    w,
                    read: &[],
                    time: question.time,
                };
                law.answer(ask, R::call(&own, out));
                continue;
            }
            let derived = &question.derived[pack * n.derived..][..n.derived];
            let x = &question.x[pack * n.x..][..n.x];
            let ramp = if ramps { &question.w[pack * n.w..][..n.w] } else { &[] };
            if ask == Ask::Coordinates {
                out.copy_from_slice(x);
                continue;
            }
            let frame = &mut rows[program.shared..];
            frame[..n.x].copy_from_slice(x);
            frame[n.x..n.x + n.u].copy_from_slice(&question.u[pack * n.u..][..n.u]);
            frame[n.x + n.u..program.frame].fill(R::constant(0.0));
            let steps = if ask == Ask::Output { &compiled.for_output } else { &compiled.for_next };
            let at = |place: Place| row(program, place);
            for &step in steps {
                match &program.ops[step] {
                    Op::Gather(runs) => {
                        runs.iter().for_each(|run| gather(program, &mut rows, run, compiled));
                    }
                    Op::Zero(place) => rows[at(*place)] = R::constant(0.0),
                    Op::Network(block) => {
                        let (b, z) = (&program.blocks[*block], at(program.blocks[*block].z));
                        let Some(learned) = self.learned(*block) else { continue };
                        let (n_z, n_w) = (learned.input_scales.len(), learned.output_scales.len());
                        let z = rows[z..z + n_z].to_vec();
                        solo::learned(learned, &z, &mut rows[at(b.w)..][..n_w]);
                    }
                    Op::Next(block) => {
                        let (z, w) = (program.blocks[*block].z, program.blocks[*block].w);
                        let z = rows[at(z)..][..inner.x + inner.u].to_vec();
                        let known = solo::Known { law, sizes: inner, theta, derived, ramp };
                        let to = &mut rows[at(w)..][..inner.x];
                        room.next(&known, baseline.pace(), &z, question.time, to);
                    }
                    Op::Readout(block, outputs) => {
                        let (z, w) = (program.blocks[*block].z, program.blocks[*block].w);
                        let z = rows[at(z)..][..inner.x + inner.u].to_vec();
                        let known = solo::Known { law, sizes: inner, theta, derived, ramp };
                        let mut y = vec![R::constant(0.0); inner.y];
                        known.ask(Ask::Output, &z[..inner.x], &z[inner.x..], question.time, &mut y);
                        for &output in outputs {
                            rows[at(w) + output] = y[output - inner.x];
                        }
                    }
                    // errors stay 0; loops are refused before
                    Op::Error(_) | Op::Loop(_) => {}
                }
            }
            let from = if ask == Ask::Output { program.y } else { end };
            out.copy_from_slice(&rows[from..][..out.len()]);
        }
    }
}

impl Law for AugmentedModel {
    fn signals(&self) -> Signals {
        let mut signals = Signals::discrete();
        if let Some(baseline) = self.baseline() {
            signals = baseline.system.signals();
            let theta = baseline.theta();
            signals.parameters.iter_mut().zip(theta).for_each(|(p, value)| p.value = value);
        }
        signals.time = TimeKind::Discrete;
        // effects enter between samples, no longer inside the baseline's integrator
        (signals.channels, signals.coordinates) = (vec![], vec![]);
        if self.ramped() {
            let ramp = |input: &Signal| Signal::new(&format!("{}.ramp", input.name), &input.unit);
            signals.channels = signals.inputs.iter().map(ramp).collect();
        }
        let own = signals.states.len();
        let added = (own..self.of.states).map(|i| State {
            signal: Signal::new(&format!("xa{}", i + 1 - own), ""),
            initial: 0.0,
        });
        signals.states.extend(added);
        signals
    }

    fn faults(&self) -> Vec<Fault> {
        let count = self.of.blocks.iter().filter(|b| matches!(b, Block::Baseline(_))).count();
        if count != 1 {
            return vec![Fault::new("blocks", format!("{count} baselines"), "exactly one")];
        }
        if let Err(error) = self.of.check() {
            return vec![Fault::new("s", error, "an interconnection that fits together")];
        }
        let n = self.baseline().map(Baseline::sizes);
        let sizes = [
            ("inputs", self.of.inputs, n.map_or(0, |n| n.u)),
            ("outputs", self.of.outputs, n.map_or(0, |n| n.y)),
        ];
        for (key, found, expected) in sizes {
            if found != expected {
                return vec![Fault::new(key, found, format!("{expected}, as the baseline has"))];
            }
        }
        if self.of.states < n.map_or(0, |n| n.x) {
            return vec![Fault::new("states", self.of.states, "at least the baseline's")];
        }
        if let Some(path) = self.of.algebraic_loops().first() {
            let expected = "no loop without a state in it";
            return vec![Fault::new("s", format!("the loop {}", path.join(" -> ")), expected)];
        }
        match Program::new(&self.of) {
            Ok(_) => vec![],
            Err(error) => vec![Fault::new("s", error, "an interconnection that can run")],
        }
    }

    fn answer(&self, ask: Ask, call: Call<'_>) {
        match call {
            Call::F64(question, out) => self.reply(ask, question, out),
            Call::F32(question, out) => self.reply(ask, question, out),
            Call::Dual64(question, out) => self.reply(ask, question, out),
            Call::Dual32(question, out) => self.reply(ask, question, out),
            Call::Trace(question, out) => self.reply(ask, question, out),
        }
    }

    fn composed(&self) -> bool {
        true
    }

    fn ramped(&self) -> bool {
        self.baseline().is_some_and(Baseline::ramps)
    }

    fn key(&self, parameter: &str) -> String {
        let number = self.of.blocks.iter().position(|b| matches!(b, Block::Baseline(_)));
        let inner = self.baseline().map_or_else(String::new, |baseline| {
            let model = baseline.system.model.as_ref();
            format!("{}.{}", model.typetag_name(), model.key(parameter))
        });
        format!("blocks.{}.baseline.system.model.{inner}", number.unwrap_or(0))
    }

    /// What S hands from errors to states; none where errors enter anything else, which no gain says.
    fn innovation_gain(&self) -> Option<DMatrix<f64>> {
        let mut gain: Option<DMatrix<f64>> = None;
        for (to, from, entry) in self.of.s.entries() {
            let Source::Error(output) = from else { continue };
            let Sink::State(state) = to else { return None };
            let empty = || DMatrix::zeros(self.of.states, self.of.outputs);
            gain.get_or_insert_with(empty)[(state, output)] = entry.value;
        }
        gain
    }
}

crate::register!(StateSpaceModel for AugmentedModel, "augmented",
    "a baseline with learned blocks, joined by the matrix S",
    "states = 1\ninputs = 1\noutputs = 1\n\
     s = [{ to = { state = 0 }, from = { block = [0, 0] }, value = 1.0 }, \
     { to = { state = 0 }, from = { block = [1, 0] }, value = 1.0 }, \
     { to = { output = 0 }, from = { block = [0, 1] }, value = 1.0 }, \
     { to = { block = [0, 0] }, from = { state = 0 }, value = 1.0 }, \
     { to = { block = [0, 1] }, from = { input = 0 }, value = 1.0 }, \
     { to = { block = [1, 0] }, from = { state = 0 }, value = 1.0 }]\n\
     blocks = [{ baseline = { sampling_time = 0.1, system = { model = { lti = { A = [[0.9]], B = [[0.2]], C = [[1.0]] } } } } }, \
     { network = { net = { layout = { inputs = 1, hidden = [1], outputs = 1 }, weights = [1.0, 0.0, -0.1, 0.0, 0.0] }, \
     input_scales = [[0.0, 1.0]], output_scales = [[0.0, 1.0]] } }]");
