//! An interconnection laid out in memory: which rows of numbers one sample needs and in
//! which order they are filled.

use std::ops::Range;

use super::interconnection::Interconnection;
use super::order::{Graph, Part};
use super::{Block, Entry, LfrError, Sink, Source};

/// Where a row stands: in the frame of its sample, which is kept for the way back, in the
/// next sample's frame, or in what all samples share.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    Frame(usize),
    Next(usize),
    Shared(usize),
}

impl Place {
    fn plus(self, by: usize) -> Self {
        match self {
            Self::Frame(i) => Self::Frame(i + by),
            Self::Next(i) => Self::Next(i + by),
            Self::Shared(i) => Self::Shared(i + by),
        }
    }
}

/// The value of one or several entries of S.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Factor {
    One,
    Fixed(f64),
    /// Number of the learned entry.
    Learned(usize),
}

/// Several neighbouring entries of S with the same value.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Run {
    pub to: Place,
    pub from: Place,
    /// Adjoints of both; inputs have none.
    pub adjoint_to: usize,
    pub adjoint_from: Option<usize>,
    pub len: usize,
    pub factor: Factor,
    /// Whether it is the first to fill its rows.
    pub first: bool,
    /// Whether both are the same rows, so that nothing has to be copied.
    pub alias: bool,
}

/// One step of a sample.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Op {
    /// Rows of S.
    Gather(Vec<Run>),
    /// Rows without any entry.
    Zero(Place),
    Network(usize),
    Next(usize),
    /// Some of the outputs of h_base, by their numbers in w.
    Readout(usize, Vec<usize>),
    /// Outputs are known: errors can be formed.
    Error(Range<usize>),
    /// Steps that wait for each other: solved together.
    Loop(Loop),
}

/// Steps that wait for each other.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Loop {
    /// Rows of z that do not depend on the loop.
    pub before: Vec<Op>,
    /// The parts of the loop, each given its z.
    pub parts: Vec<Op>,
    /// The rows of z that depend on the loop: guessed and corrected.
    pub gathers: Vec<Op>,
    /// Places and adjoints of these rows.
    pub cut: Vec<(Place, usize)>,
    /// Signals along the loop.
    pub path: Vec<String>,
}

/// Rows of one block.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Rows {
    pub z: Place,
    pub w: Place,
    pub adjoint_z: usize,
    pub adjoint_w: usize,
    /// Leading rows of z along which derivatives are wanted.
    pub wanted: usize,
    /// Hidden units of a network, in the frame.
    pub h: Range<usize>,
}

/// The layout and order of one sample.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Program {
    pub states: usize,
    pub inputs: usize,
    pub outputs: usize,
    /// Rows of a frame: x, u, e, then what blocks keep.
    pub frame: usize,
    /// Rows that all samples share.
    pub shared: usize,
    /// Rows of adjoints.
    pub adjoints: usize,
    /// First shared row of ŷ.
    pub y: usize,
    pub blocks: Vec<Rows>,
    pub ops: Vec<Op>,
    pub uses_error: bool,
    /// Number of learned entries of S.
    pub learned: usize,
}

/// Adjoints begin with those of x+ and x.
impl Program {
    pub fn adjoint_error(&self) -> Range<usize> {
        2 * self.states..2 * self.states + self.outputs
    }
    pub fn adjoint_output(&self) -> Range<usize> {
        let begin = 2 * self.states + self.outputs;
        begin..begin + self.outputs
    }

    /// Lays a model out.
    pub fn new(model: &Interconnection) -> Result<Self, LfrError> {
        model.check()?;
        let (states, inputs, outputs) = (model.states, model.inputs, model.outputs);
        let uses_error = model.s.entries().any(|(_, from, _)| matches!(from, Source::Error(_)));
        let graph = Graph::new(model);
        let groups = graph.order();
        let looped = groups.iter().any(|group| graph.is_loop(group));
        let learned = model.s.learned().count();
        let mut program = Self {
            states,
            inputs,
            outputs,
            frame: states + inputs + if uses_error { outputs } else { 0 },
            shared: outputs,
            adjoints: 2 * states + 2 * outputs,
            y: 0,
            blocks: vec![],
            ops: vec![],
            uses_error,
            learned,
        };
        for (b, block) in model.blocks.iter().enumerate() {
            let (nz, nw) = (block.inputs(), block.outputs());
            let z = program.alias(model, b, nz).unwrap_or_else(|| {
                program.frame += nz;
                Place::Frame(program.frame - nz)
            });
            // what a learned entry multiplies is needed on the way back
            let keep = looped
                || model
                    .s
                    .learned()
                    .any(|(_, from, _)| matches!(from, Source::Block(o, _) if o == b));
            let w = if keep {
                program.frame += nw;
                Place::Frame(program.frame - nw)
            } else {
                program.shared += nw;
                Place::Shared(program.shared - nw)
            };
            let units = match block {
                Block::Network(learned) => learned.net.layout().units(),
                Block::Baseline(_) => 0,
            };
            let computed = |i: usize| {
                model.s.row(Sink::Block(b, i)).any(|(from, _)| !matches!(from, Source::Input(_)))
            };
            let wanted = (0..nz).rev().find(|&i| computed(i)).map_or(0, |last| last + 1);
            let h = program.frame..program.frame + units;
            program.frame += units;
            let adjoint_z = program.adjoints;
            program.adjoints += nz + nw;
            program.blocks.push(Rows { z, w, adjoint_z, adjoint_w: adjoint_z + nz, wanted, h });
        }
        program.arrange(model, &graph, groups)?;
        Ok(program)
    }

    /// z of a block as neighbouring rows of x and u, where S only selects those.
    fn alias(&self, model: &Interconnection, block: usize, inputs: usize) -> Option<Place> {
        let mut first = None;
        for i in 0..inputs {
            let row: Vec<_> = model.s.row(Sink::Block(block, i)).collect();
            let [(from, entry)] = row[..] else { return None };
            let at = match from {
                Source::State(s) => s,
                Source::Input(u) => self.states + u,
                _ => return None,
            };
            let start = *first.get_or_insert(at.checked_sub(i)?);
            if entry.learned || entry.value != 1.0 || at != start + i {
                return None;
            }
        }
        first.map(Place::Frame)
    }

    fn source(&self, from: Source) -> (Place, Option<usize>) {
        match from {
            Source::State(i) => (Place::Frame(i), Some(self.states + i)),
            Source::Input(i) => (Place::Frame(self.states + i), None),
            Source::Error(i) => {
                let place = Place::Frame(self.states + self.inputs + i);
                (place, Some(self.adjoint_error().start + i))
            }
            Source::Block(b, i) => (self.blocks[b].w.plus(i), Some(self.blocks[b].adjoint_w + i)),
        }
    }

    fn sink(&self, to: Sink) -> (Place, usize) {
        match to {
            Sink::State(i) => (Place::Next(i), i),
            Sink::Output(i) => (Place::Shared(self.y + i), self.adjoint_output().start + i),
            Sink::Block(b, i) => (self.blocks[b].z.plus(i), self.blocks[b].adjoint_z + i),
        }
    }

    /// The steps that fill the given rows of S.
    fn gather(&self, model: &Interconnection, sinks: &[Sink]) -> Vec<Op> {
        let mut ops = vec![];
        let learned: Vec<(Sink, Source)> =
            model.s.learned().map(|(to, from, _)| (to, from)).collect();
        let rows: Vec<Vec<Run>> = sinks
            .iter()
            .map(|&sink| {
                let (to, adjoint_to) = self.sink(sink);
                let run = |(k, (source, entry)): (usize, (Source, Entry))| {
                    let (from, adjoint_from) = self.source(source);
                    let number = learned.iter().position(|own| *own == (sink, source));
                    let factor = match number {
                        Some(number) => Factor::Learned(number),
                        None if entry.value == 1.0 => Factor::One,
                        None => Factor::Fixed(entry.value),
                    };
                    let (first, alias) = (k == 0, to == from);
                    Run { to, from, adjoint_to, adjoint_from, len: 1, factor, first, alias }
                };
                model.s.row(sink).enumerate().map(run).collect()
            })
            .collect();
        for (row, &sink) in rows.iter().zip(sinks) {
            if row.is_empty() {
                ops.push(Op::Zero(self.sink(sink).0));
            }
        }
        let terms = rows.iter().map(Vec::len).max().unwrap_or(0);
        let mut runs: Vec<Run> = vec![];
        for k in 0..terms {
            for run in rows.iter().filter_map(|row| row.get(k)) {
                match runs.last_mut() {
                    Some(last) if joins(last, run) => last.len += 1,
                    _ => runs.push(run.clone()),
                }
            }
        }
        if !runs.is_empty() {
            ops.push(Op::Gather(runs));
        }
        ops
    }

    /// Puts all steps in order.
    fn arrange(
        &mut self,
        model: &Interconnection,
        graph: &Graph,
        groups: Vec<Vec<usize>>,
    ) -> Result<(), LfrError> {
        let mut filled = vec![];
        let mut ops = vec![];
        for group in &groups {
            if !graph.is_loop(group) {
                ops.extend(self.steps(model, graph, group[0], &mut filled));
                continue;
            }
            let path = graph.path(group);
            if group.iter().any(|&part| matches!(graph.parts[part], Part::Output(_))) {
                return Err(LfrError::ErrorLoop { path });
            }
            ops.push(Op::Loop(self.cut(model, graph, group, &mut filled, path)));
        }
        let next: Vec<Sink> = (0..self.states).map(Sink::State).collect();
        ops.extend(self.gather(model, &next));
        self.ops = merged(ops);
        Ok(())
    }

    /// The steps of one part.
    fn steps(
        &self,
        model: &Interconnection,
        graph: &Graph,
        part: usize,
        filled: &mut Vec<Sink>,
    ) -> Vec<Op> {
        let part = &graph.parts[part];
        let mut rows = Graph::rows(model, part);
        rows.retain(|row| !filled.contains(row));
        filled.extend(&rows);
        let mut ops = self.gather(model, &rows);
        ops.extend(self.evaluation(part));
        ops
    }

    /// The step that evaluates a part whose z is there.
    fn evaluation(&self, part: &Part) -> Option<Op> {
        match *part {
            Part::Next(b) => Some(Op::Next(b)),
            Part::Readout(b, i) => Some(Op::Readout(b, vec![i])),
            Part::Network(b) => Some(Op::Network(b)),
            Part::Output(i) => self.uses_error.then_some(Op::Error(i..i + 1)),
        }
    }

    /// Parts that wait for each other, cut at the rows of z that parts of the group fill.
    fn cut(
        &self,
        model: &Interconnection,
        graph: &Graph,
        group: &[usize],
        filled: &mut Vec<Sink>,
        path: Vec<String>,
    ) -> Loop {
        let inside = |from: Source| group.iter().any(|&p| gives(&graph.parts[p], model, from));
        let (mut free, mut bound) = (vec![], vec![]);
        for &part in group {
            for sink in Graph::rows(model, &graph.parts[part]) {
                if filled.contains(&sink) {
                    continue;
                }
                filled.push(sink);
                let own = model.s.row(sink).any(|(from, _)| inside(from));
                if own { bound.push(sink) } else { free.push(sink) }
            }
        }
        let parts = group.iter().filter_map(|&part| self.evaluation(&graph.parts[part]));
        Loop {
            before: self.gather(model, &free),
            parts: merged(parts.collect()),
            gathers: self.gather(model, &bound),
            cut: bound.into_iter().map(|sink| self.sink(sink)).collect(),
            path,
        }
    }
}

/// Whether a part gives a signal.
fn gives(part: &Part, model: &Interconnection, from: Source) -> bool {
    let Source::Block(b, i) = from else { return false };
    match *part {
        Part::Network(own) => own == b,
        Part::Readout(own, output) => own == b && output == i,
        Part::Next(own) => {
            own == b && matches!(&model.blocks[b], Block::Baseline(base) if i < base.sizes().x)
        }
        Part::Output(_) => false,
    }
}

/// Whether `next` continues `run` row by row.
fn joins(run: &Run, next: &Run) -> bool {
    let adjoint = match (run.adjoint_from, next.adjoint_from) {
        (Some(a), Some(b)) => a + run.len == b,
        (None, None) => true,
        _ => false,
    };
    run.to.plus(run.len) == next.to
        && run.from.plus(run.len) == next.from
        && run.adjoint_to + run.len == next.adjoint_to
        && adjoint
        && run.factor == next.factor
        && !matches!(run.factor, Factor::Learned(_))
        && run.first == next.first
        && run.alias == next.alias
}

/// Joins neighbouring steps of the same kind.
fn merged(ops: Vec<Op>) -> Vec<Op> {
    let mut out: Vec<Op> = vec![];
    for op in ops {
        match (out.last_mut(), op) {
            (Some(Op::Readout(b, i)), Op::Readout(other, more)) if *b == other => i.extend(more),
            (Some(Op::Error(range)), Op::Error(more)) if range.end == more.start => {
                range.end = more.end;
            }
            (_, op) => out.push(op),
        }
    }
    out
}
