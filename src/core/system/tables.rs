//! The two tables that effects are wired through: what they may see, where they may enter.

use crate::model::{Signal, Signals};

/// Where an entry of a table comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// Own coordinate or channel number.
    Own(usize),
    /// Input number.
    Input(usize),
    /// Output number.
    Output(usize),
    /// Time.
    Time,
    /// State number, seen but not offered by name.
    State(usize),
}

/// What an effect may depend on: own coordinates, inputs, outputs, time; then the states,
/// which have no name here but serve as rates.
#[derive(Debug, Clone)]
pub struct Sources {
    /// Named entries and their origins.
    pub entries: Vec<(Signal, Origin)>,
    /// How many entries may be named.
    pub named: usize,
}

/// Where an effect may enter: own channels, inputs, outputs.
#[derive(Debug, Clone)]
pub struct Targets {
    /// Entries and their origins.
    pub entries: Vec<(Signal, Origin)>,
}

impl Sources {
    /// The sources of a model.
    pub fn of(signals: &Signals) -> Self {
        let mut entries: Vec<_> =
            signals.own_coordinates().into_iter().enumerate().map(own).collect();
        entries.extend(signals.inputs.iter().cloned().enumerate().map(input));
        entries.extend(signals.outputs.iter().cloned().enumerate().map(output));
        entries.push((Signal::new("time", "s"), Origin::Time));
        let named = entries.len();
        let states = signals.states.iter().enumerate();
        entries.extend(states.map(|(i, s)| (s.signal.clone(), Origin::State(i))));
        Self { entries, named }
    }

    /// Position of time, the last of the named ones.
    pub fn time(&self) -> usize {
        self.named - 1
    }

    /// Position of a name.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.entries[..self.named].iter().position(|(signal, _)| signal.name == name)
    }

    /// Names that may be used.
    pub fn names(&self) -> Vec<String> {
        self.entries[..self.named].iter().map(|(signal, _)| signal.name.clone()).collect()
    }

    /// Whether an entry is an output: what enters an output depends on none.
    pub fn is_output(&self, entry: usize) -> bool {
        matches!(self.entries[entry].1, Origin::Output(_))
    }

    /// Position of an origin.
    pub fn at(&self, origin: Origin) -> Option<usize> {
        self.entries.iter().position(|(_, o)| *o == origin)
    }
}

impl Targets {
    /// The targets of a model.
    pub fn of(signals: &Signals) -> Self {
        let mut entries: Vec<_> = signals.own_channels().into_iter().enumerate().map(own).collect();
        entries.extend(signals.inputs.iter().cloned().enumerate().map(input));
        entries.extend(signals.outputs.iter().cloned().enumerate().map(output));
        Self { entries }
    }

    /// Position of a name.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.entries.iter().position(|(signal, _)| signal.name == name)
    }

    /// Names that may be used.
    pub fn names(&self) -> Vec<String> {
        self.entries.iter().map(|(signal, _)| signal.name.clone()).collect()
    }
}

fn own((i, signal): (usize, Signal)) -> (Signal, Origin) {
    (signal, Origin::Own(i))
}

fn input((i, signal): (usize, Signal)) -> (Signal, Origin) {
    (signal, Origin::Input(i))
}

fn output((i, signal): (usize, Signal)) -> (Signal, Origin) {
    (signal, Origin::Output(i))
}
