//! A loop closed around an augmented plant: the controller as one more block of S.
//!
//! ```text
//! [x+; c+; y; z; z_c] = S' [x; c; r; d; e; w; w_c],   w_c = [G; C](z_c),  z_c = [c; r; y]
//! ```
//!
//! with S' the S of the plant in which every plant input is what the controller gives and what
//! is added to it. Whatever is learned beside the plant then sees the input that really drives
//! it, and what it adds to an output is seen by the controller.

use super::ClosedLoop;
use crate::lfr::{Baseline, Block, Entry, Interconnection, LfrError, Sink, Source};
use crate::system::{Sampling, System};

impl ClosedLoop {
    /// The interconnection of an augmented plant (its states, inputs and outputs being the
    /// plant's, states added behind them) with the controller around it: states of the
    /// controller are the last ones, inputs those of the closed loop.
    ///
    /// # Errors
    ///
    /// If the loop is not wired, the plant another one, or S learns an entry that the loop would
    /// have to hold twice.
    pub fn around(&self, open: &Interconnection) -> Result<Interconnection, LfrError> {
        let number = open.blocks.len();
        let fault = |reason: String| LfrError::Baseline { block: number, reason };
        let wired = match self.wired() {
            Ok(wired) => wired,
            Err(f) => return Err(fault(format!("{} is {}, not {}", f.key, f.found, f.expected))),
        };
        if (open.inputs, open.outputs) != (wired.plant.u, wired.plant.y) {
            return Err(fault(format!(
                "the loop is around a plant of {} inputs and {} outputs, not of {} and {}",
                wired.plant.u, wired.plant.y, open.inputs, open.outputs
            )));
        }
        let model = crate::model::with_parameters(self.controller.law.as_ref(), &[])
            .map_err(|error| fault(error.to_string()))?;
        let system =
            System { sampling: Sampling::default(), model, effects: vec![], written: vec![] };
        let sampling_time = self.plant.sampling_time;
        let block = Baseline { system, sampling_time, free: vec![], theta: None };
        let (first, states) = (open.states, wired.law.x);
        let mut closed = Interconnection {
            states: first + states,
            inputs: wired.signals.inputs.len(),
            outputs: open.outputs,
            blocks: [&open.blocks[..], &[Block::Baseline(block)]].concat(),
            s: crate::lfr::Matrix::default(),
        };
        // what stands for an input of the plant
        let driving = |input: usize| -> Vec<Source> {
            if let Some(&(_, from)) = wired.outside.iter().find(|(to, _)| *to == input) {
                return vec![Source::Input(from)];
            }
            let each = wired.drives.iter().enumerate().filter(|(_, (to, _))| *to == input);
            each.flat_map(|(i, &(_, added))| {
                std::iter::once(Source::Block(number, states + i)).chain(added.map(Source::Input))
            })
            .collect()
        };
        let mut put = |to: Sink, from: Source, entry: Entry| {
            let sources = match from {
                Source::Input(input) => driving(input),
                other => vec![other],
            };
            for from in sources {
                let value = closed.s.value(to, from) + entry.value;
                closed.s.set(to, from, Entry { value, ..entry });
            }
        };
        for (to, from, entry) in open.s.entries() {
            if entry.learned && matches!(from, Source::Input(_)) {
                return Err(fault(format!("S learns {from} -> {to}, an input of a closed loop")));
            }
            put(to, from, entry);
        }
        let references = self.controller.references.len();
        for (i, &output) in wired.measured.iter().enumerate() {
            for (from, entry) in open.s.row(Sink::Output(output)) {
                if entry.learned {
                    return Err(fault(format!("S learns {from} -> an output that is fed back")));
                }
                put(Sink::Block(number, states + references + i), from, entry);
            }
        }
        for i in 0..states {
            closed.s.select(Sink::Block(number, i), Source::State(first + i));
            closed.s.select(Sink::State(first + i), Source::Block(number, i));
        }
        for i in 0..references {
            closed.s.select(Sink::Block(number, states + i), Source::Input(i));
        }
        closed.check()?;
        Ok(closed)
    }

    /// The closed loop that a model is, if it is one.
    pub fn of(system: &System) -> Option<Self> {
        if system.model.typetag_name() != "closed_loop" || !system.effects.is_empty() {
            return None;
        }
        let mut table = serde_json::to_value(system.model.as_ref()).ok()?;
        serde_json::from_value(table.get_mut("closed_loop")?.take()).ok()
    }
}
