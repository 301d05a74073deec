//! Which parameters of a learned part belong to one signal: what a penalty removes together, and
//! what an ablation switches off.

use serde::{Deserialize, Serialize};

use crate::lfr::{Block, Interconnection, Sink, Source};
use crate::model::Signals;

/// What a group of parameters belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GroupKind {
    /// An augmented state: everything into it and out of it.
    State,
    /// A signal that a network sees (an entry of z).
    Input,
    /// A signal that a network gives (an entry of w).
    Output,
}

/// Parameters that belong to one signal.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// What it is.
    pub kind: GroupKind,
    /// Name of the signal.
    pub name: String,
    /// Number of the network's block.
    pub block: usize,
    /// Positions in [`Interconnection::parameters`].
    pub entries: Vec<usize>,
}

/// The groups of all networks of an interconnection, augmented states first.
pub fn groups(model: &Interconnection, signals: Option<&Signals>) -> Vec<Group> {
    let state_name = |i: usize| {
        let own = signals.map_or(0, |signals| signals.states.len());
        let known = signals.and_then(|signals| signals.states.get(i));
        known.map_or_else(|| format!("xa{}", i + 1 - own.min(i)), |state| state.signal.name.clone())
    };
    let named = |list: Option<&Vec<crate::model::Signal>>, i: usize, letter: &str| {
        let known = list.and_then(|list| list.get(i));
        known.map_or_else(|| format!("{letter}{}", i + 1), |signal| signal.name.clone())
    };
    let augmented = baseline_states(model)..model.states;
    let (mut states, mut ends, mut at) = (vec![], vec![], 0);
    for (number, block) in model.blocks.iter().enumerate() {
        let learned = match block {
            Block::Baseline(baseline) => {
                at += baseline.free.len();
                continue;
            }
            Block::Network(learned) => learned,
        };
        let layout = learned.net.layout();
        let (inputs, outputs) = (layout.inputs(), layout.outputs());
        let column = |j: usize| {
            let first = layout.hidden_layer(0).map(|(rows, _)| rows);
            let rows = first.into_iter().chain([layout.linear()]);
            rows.flat_map(move |rows| rows.skip(j).step_by(inputs)).map(|i| at + i).collect()
        };
        let row = |o: usize| {
            let width = layout.output().len() / outputs.max(1);
            let own = layout.output().skip(o * width).take(width);
            let bias = layout.output_bias().skip(o).take(1);
            let linear = layout.linear().skip(o * inputs).take(inputs);
            own.chain(bias).chain(linear).map(|i| at + i).collect::<Vec<usize>>()
        };
        let (mut seen, mut given) = (vec![(String::new(), None); inputs], vec![]);
        for (j, seen) in seen.iter_mut().enumerate() {
            *seen = match model.s.row(Sink::Block(number, j)).next().map(|(from, _)| from) {
                Some(Source::State(i)) => (state_name(i), Some(i)),
                Some(Source::Input(i)) => (named(signals.map(|s| &s.inputs), i, "u"), None),
                Some(Source::Block(b, i)) => (format!("w{}.{}", b + 1, i + 1), None),
                _ => (format!("z{}", j + 1), None),
            };
        }
        for o in 0..outputs {
            let to = model.s.entries().find(|(_, from, _)| *from == Source::Block(number, o));
            given.push(match to.map(|(to, ..)| to) {
                Some(Sink::State(i)) => (state_name(i), Some(i)),
                Some(Sink::Output(i)) => (named(signals.map(|s| &s.outputs), i, "y"), None),
                _ => (format!("w{}", o + 1), None),
            });
        }
        for state in augmented.clone() {
            let into = given.iter().position(|(_, to)| *to == Some(state));
            let out = seen.iter().position(|(_, from)| *from == Some(state));
            let mut entries: Vec<usize> = into.map(row).unwrap_or_default();
            entries.extend(out.map(column).unwrap_or_else(Vec::new));
            entries.sort_unstable();
            entries.dedup();
            if !entries.is_empty() {
                let kind = GroupKind::State;
                states.push(Group { kind, name: state_name(state), block: number, entries });
            }
        }
        let is_added = |to: &Option<usize>| to.is_some_and(|i| augmented.contains(&i));
        for (j, (name, from)) in seen.into_iter().enumerate() {
            if !is_added(&from) {
                let kind = GroupKind::Input;
                ends.push(Group { kind, name, block: number, entries: column(j) });
            }
        }
        for (o, (name, to)) in given.into_iter().enumerate() {
            if !is_added(&to) {
                ends.push(Group { kind: GroupKind::Output, name, block: number, entries: row(o) });
            }
        }
        at += layout.len();
    }
    states.extend(ends);
    states
}

/// States that are the baseline's own.
fn baseline_states(model: &Interconnection) -> usize {
    let own = model.blocks.iter().map(|block| match block {
        Block::Baseline(baseline) => baseline.sizes().x,
        Block::Network(_) => 0,
    });
    own.sum::<usize>().min(model.states)
}
