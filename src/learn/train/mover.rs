//! The network that moves augmented states: what it sees of a record, and where it enters.

use crate::encoder::{Baseline as Known, EncoderError};
use crate::lfr::{Block, Interconnection, Sink, Source};

/// Something a network sees that does not come from an augmented state.
pub(super) struct Drive {
    /// Its place among what the network sees.
    pub at: usize,
    /// As the network sees it: about its mean, over its spread.
    pub values: Vec<f64>,
}

/// The network that moves the augmented states.
pub(super) struct Mover {
    /// Number of its block.
    pub block: usize,
    /// What it sees beside the augmented states.
    pub drives: Vec<Drive>,
    /// Where it enters the baseline.
    pub targets: Vec<Sink>,
    /// For every augmented state: its place among what the network gives, and sees.
    pub places: Vec<(usize, usize)>,
}

impl Mover {
    /// Of a model with augmented states; nothing where no network moves them all.
    pub fn of(
        model: &Interconnection,
        known: &Known<'_>,
        first: usize,
    ) -> Result<Option<Self>, EncoderError> {
        let course = known.simulate()?;
        let into = |block: usize| {
            let all = model.s.entries();
            all.filter_map(move |(to, from, _)| match from {
                Source::Block(b, o) if b == block => Some((to, o)),
                _ => None,
            })
        };
        let moves = |b: &usize| {
            matches!(model.blocks[*b], Block::Network(_))
                && into(*b).any(|(to, _)| to == Sink::State(first))
        };
        let Some(block) = (0..model.blocks.len()).find(moves) else { return Ok(None) };
        let Block::Network(learned) = &model.blocks[block] else { return Ok(None) };
        let mut targets: Vec<Sink> = vec![];
        for other in
            (0..model.blocks.len()).filter(|b| matches!(model.blocks[*b], Block::Network(_)))
        {
            targets.extend(into(other).map(|(to, _)| to));
        }
        targets.retain(|to| !matches!(to, Sink::State(i) if *i >= first));
        let (inputs, _) = known.drives();
        let (mut from_u, mut from_rest, mut seen) = (vec![], vec![], vec![]);
        for (at, &(offset, scale)) in learned.input_scales.iter().enumerate() {
            let Some((from, _)) = model.s.row(Sink::Block(block, at)).next() else { continue };
            let scaled = |values: &[f64]| Drive {
                at,
                values: values.iter().map(|v| (v - offset) / scale).collect(),
            };
            match from {
                Source::State(i) if i >= first => seen.push((i - first, at)),
                Source::State(i) => from_rest.push(scaled(&course.states[i])),
                Source::Input(i) => from_u.push(scaled(&inputs[i])),
                Source::Block(0, i) if i >= first => {
                    from_rest.push(scaled(&course.outputs[i - first]));
                }
                _ => {}
            }
        }
        // inputs are what a record varies; states stand in where the network sees none
        let drives = if from_u.is_empty() { from_rest } else { from_u };
        let places = (first..model.states).map(|state| {
            let given = into(block).find(|(to, _)| *to == Sink::State(state))?.1;
            Some((given, seen.iter().find(|(i, _)| *i == state - first)?.1))
        });
        let places: Option<Vec<(usize, usize)>> = places.collect();
        Ok(places.map(|places| Self { block, drives, targets, places }))
    }
}
