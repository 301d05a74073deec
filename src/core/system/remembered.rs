//! What a simulation remembers beside states, to go back to: delay lines, filters in paths, play.

use super::group::Group;
use super::inputs::InputPaths;
use super::outputs::OutputPaths;
use super::wiring::{EffectNumber, Wiring};

/// What a group remembers beside states: what is on its way in its paths, and where its plays are.
pub struct Remembered<R> {
    outputs: OutputPaths<R>,
    inputs: InputPaths<R>,
    wirings: Vec<Wiring<R>>,
}

impl<R: EffectNumber> Group<'_, R> {
    /// What it remembers now beside states.
    pub fn memory(&self) -> Remembered<R> {
        Remembered {
            outputs: self.outputs.clone(),
            inputs: self.inputs.clone(),
            wirings: self.wirings.clone(),
        }
    }

    /// Goes back to what it remembered.
    pub fn recall(&mut self, memory: &Remembered<R>) {
        self.outputs.clone_from(&memory.outputs);
        self.inputs.clone_from(&memory.inputs);
        self.wirings.clone_from(&memory.wirings);
    }
}
