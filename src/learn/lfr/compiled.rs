//! What an interconnection needs to answer for one pack of numbers: the order of its steps.

use crate::real::Real;

use super::program::{Factor, Op, Place, Program, Run};
use super::{Block, Interconnection};

/// What every answer needs.
#[derive(Debug)]
pub(super) struct Compiled {
    pub program: Program,
    /// Number of the baseline's block.
    pub baseline: usize,
    /// Values of the learned entries of S.
    pub learned: Vec<f64>,
    /// Steps that outputs need, and that next states need.
    pub for_output: Vec<usize>,
    pub for_next: Vec<usize>,
}

impl Compiled {
    pub fn of(model: &Interconnection) -> Option<Self> {
        let program = Program::new(model).ok()?;
        let baselines = model.blocks.iter().enumerate();
        let mut numbers = baselines.filter(|(_, b)| matches!(b, Block::Baseline(_)));
        let (Some((baseline, _)), None) = (numbers.next(), numbers.next()) else { return None };
        let outputs: Vec<usize> = (program.y..program.y + program.outputs).collect();
        let end = program.shared + program.frame;
        let next: Vec<usize> = (end..end + program.states).collect();
        let learned = model.s.learned().map(|(.., value)| value).collect();
        let mut compiled =
            Self { program, baseline, learned, for_output: vec![], for_next: vec![] };
        compiled.for_output = compiled.needed(model, outputs);
        compiled.for_next = compiled.needed(model, next);
        Some(compiled)
    }

    /// The steps that fill some rows, and what these rows are made of.
    fn needed(&self, model: &Interconnection, mut rows: Vec<usize>) -> Vec<usize> {
        let (program, mut steps) = (&self.program, vec![]);
        let at = |place: Place| row(program, place);
        let n_x = match &model.blocks[self.baseline] {
            Block::Baseline(baseline) => baseline.sizes().x,
            Block::Network(_) => 0,
        };
        for (number, op) in program.ops.iter().enumerate().rev() {
            let inputs = |b: usize| {
                at(program.blocks[b].z)..at(program.blocks[b].z) + model.blocks[b].inputs()
            };
            let w = |b: usize| at(program.blocks[b].w);
            let (fills, reads): (Vec<usize>, Vec<usize>) = match op {
                Op::Gather(runs) => {
                    let rows = |place: Place, run: &Run| at(place)..at(place) + run.len;
                    let to = runs.iter().flat_map(|run| rows(run.to, run)).collect();
                    (to, runs.iter().flat_map(|run| rows(run.from, run)).collect())
                }
                Op::Zero(place) => (vec![at(*place)], vec![]),
                Op::Network(b) => {
                    ((w(*b)..w(*b) + model.blocks[*b].outputs()).collect(), inputs(*b).collect())
                }
                Op::Next(b) => ((w(*b)..w(*b) + n_x).collect(), inputs(*b).collect()),
                Op::Readout(b, outputs) => {
                    (outputs.iter().map(|o| w(*b) + o).collect(), inputs(*b).collect())
                }
                Op::Error(_) | Op::Loop(_) => continue,
            };
            if fills.iter().any(|fill| rows.contains(fill)) {
                steps.push(number);
                rows.extend(reads);
            }
        }
        steps.reverse();
        steps
    }
}

/// The number of a row where shared rows, the frame and the next states stand one after the
/// other.
pub(super) fn row(program: &Program, place: Place) -> usize {
    match place {
        Place::Shared(i) => i,
        Place::Frame(i) => program.shared + i,
        Place::Next(i) => program.shared + program.frame + i,
    }
}

/// One run of S.
pub(super) fn gather<R: Real>(program: &Program, rows: &mut [R], run: &Run, compiled: &Compiled) {
    if run.alias {
        return;
    }
    let (from, to) = (row(program, run.from), row(program, run.to));
    for i in 0..run.len {
        let value = match run.factor {
            Factor::One => rows[from + i],
            Factor::Fixed(factor) => rows[from + i] * factor,
            Factor::Learned(number) => rows[from + i] * compiled.learned[number],
        };
        rows[to + i] = if run.first { value } else { rows[to + i] + value };
    }
}
