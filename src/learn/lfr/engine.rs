//! One sample of an interconnection on a block of lanes, forward and back.

use crate::network::{Arranged, Instants, Line, Row, flush, prefetch};

use super::driver::{Driver, Sight};
use super::interconnection::Interconnection;
use super::march::Room;
use super::number::Number;
use super::program::{Op, Place, Program, Rows};
use super::rows::{Base, gather, scatter, two};
use super::work::{BATCH, Work};
use super::{Block, LfrError};

/// An interconnection prepared for one precision and one value of its parameters; threads
/// share it and bring a [`Work`] each.
pub(crate) struct Engine<'a, E: Number> {
    pub program: Program,
    /// Whether errors are taken as 0 wherever S hands them on, as in a simulation.
    pub blind: bool,
    pub(super) parts: Vec<Evaluator<'a, E>>,
    pub(super) learned: Vec<E>,
}

/// What evaluates a block.
pub(super) enum Evaluator<'a, E: Number> {
    Network(Box<Arranged<E>>),
    Baseline(Box<Driver<'a, E>>),
}

impl<'a, E: Number> Engine<'a, E> {
    /// A model at the values of its parameters.
    pub fn new(model: &'a Interconnection) -> Result<Self, LfrError> {
        let program = Program::new(model)?;
        let parts = model.blocks.iter().enumerate().map(|(number, block)| match block {
            Block::Network(net) => {
                Evaluator::Network(Box::new(Arranged::of(&net.net, net.frame())))
            }
            Block::Baseline(baseline) => {
                let rows = &program.blocks[number];
                Evaluator::Baseline(Box::new(Driver::new(
                    baseline,
                    rows.wanted > baseline.sizes().x,
                )))
            }
        });
        let learned = model.s.learned().map(|(.., value)| E::of(value)).collect();
        Ok(Self { parts: parts.collect(), program, blind: false, learned })
    }

    /// Takes over other parameters, in the order of [`Interconnection::parameters`].
    pub fn set(&mut self, parameters: &[f64]) {
        let mut rest = parameters;
        for part in &mut self.parts {
            match part {
                Evaluator::Network(net) => {
                    let (own, others) = rest.split_at(net.layout().len());
                    net.set(own);
                    rest = others;
                }
                Evaluator::Baseline(driver) => {
                    let (own, others) = rest.split_at(driver.free.len());
                    if !own.is_empty() {
                        let mut theta = driver.theta.clone();
                        driver.free.iter().zip(own).for_each(|(&i, &value)| theta[i] = value);
                        driver.set(&theta);
                    }
                    rest = others;
                }
            }
        }
        self.learned.iter_mut().zip(rest).for_each(|(to, &value)| *to = E::of(value));
    }

    fn drivers(&self) -> impl Iterator<Item = &Driver<'a, E>> {
        self.parts.iter().filter_map(|part| match part {
            Evaluator::Baseline(driver) => Some(&**driver),
            Evaluator::Network(_) => None,
        })
    }

    /// Whether anything looks at the time.
    pub fn timed(&self) -> bool {
        self.drivers().any(|driver| driver.timed)
    }

    /// Whether inputs move between samples.
    pub fn ramps(&self) -> bool {
        self.drivers().any(|driver| driver.ramps)
    }

    /// Whether the way back has to be told again what was known at each sample.
    pub fn looks_again(&self) -> bool {
        self.timed() || self.ramps() || self.program.uses_error
    }

    /// Memory for `samples` samples; all zeros, so that nothing is ever not a number by
    /// accident.
    pub fn work(&self, samples: usize) -> Work<E> {
        let program = &self.program;
        let rows = |count: usize| vec![Row::zero(); count];
        let slopes = self.parts.iter().map(|part| match part {
            Evaluator::Network(net) => {
                rows(BATCH * (net.layout().units() + net.layout().outputs()))
            }
            Evaluator::Baseline(_) => vec![],
        });
        let lines = self.parts.iter().map(|part| match part {
            Evaluator::Network(net) => vec![Line::zero(); net.layout().len()],
            Evaluator::Baseline(_) => vec![],
        });
        let rooms = self.parts.iter().map(|part| match part {
            Evaluator::Network(_) => None,
            Evaluator::Baseline(driver) => Some(Room::new(driver)),
        });
        let spare = self.parts.iter().map(|part| match part {
            Evaluator::Network(_) => 0,
            Evaluator::Baseline(driver) => driver.sizes.x.max(driver.sizes.y),
        });
        Work {
            rows: rows(program.shared + (samples + 1) * program.frame),
            shared: program.shared,
            stride: program.frame,
            errors: rows(samples * program.outputs),
            measured: rows(program.outputs),
            du: rows(program.inputs),
            time: Row::zero(),
            adjoints: rows(program.adjoints),
            waiting: 0,
            s_lines: vec![Line::zero(); program.learned],
            spare: rows(spare.max().unwrap_or(0)),
            slopes: slopes.collect(),
            lines: lines.collect(),
            rooms: rooms.collect(),
            unsolved: None,
        }
    }

    /// From x and u in the frame of `sample`, and the measured outputs, to ŷ, its error and
    /// the states of the next sample.
    pub fn forward(&self, work: &mut Work<E>, sample: usize) {
        let base = Base { frame: work.frame(sample), stride: work.stride };
        for op in &self.program.ops {
            self.step(work, base, op);
        }
        let outputs = self.program.outputs;
        for i in 0..outputs {
            let error = &mut work.errors[sample * outputs + i];
            residual(&work.rows[self.program.y + i], &work.measured[i], error);
        }
    }

    /// One step forward.
    pub(super) fn step(&self, work: &mut Work<E>, base: Base, op: &Op) {
        match op {
            Op::Gather(runs) => gather(&mut work.rows, base, runs, &self.learned),
            Op::Zero(place) => work.rows[base.at(*place)] = Row::zero(),
            Op::Network(block) => {
                let Evaluator::Network(net) = &self.parts[*block] else { return };
                let (at, n) = (&self.program.blocks[*block], net.layout());
                let (z, w) = (base.at(at.z), base.at(at.w));
                let h = base.frame + at.h.start;
                let ranges = [z..z + n.inputs(), h..h + n.units(), w..w + n.outputs()];
                if let Ok([z, h, w]) = work.rows.get_disjoint_mut(ranges) {
                    net.forward(z, h, w);
                }
            }
            Op::Next(block) => {
                let Evaluator::Baseline(driver) = &self.parts[*block] else { return };
                let (at, n) = (&self.program.blocks[*block], driver.sizes);
                let Work { rows, rooms, du, time, .. } = work;
                let Some(room) = &mut rooms[*block] else { return };
                let (z, end) = two(rows, base.at(at.z), n.x + n.u, base.at(at.w), n.x);
                room.next(driver, Sight { z, du: driver.ramp(du), time }, end);
            }
            Op::Readout(block, outputs) => {
                let Evaluator::Baseline(driver) = &self.parts[*block] else { return };
                let (at, n) = (&self.program.blocks[*block], driver.sizes);
                let Work { rows, rooms, time, spare, .. } = work;
                let Some(room) = &mut rooms[*block] else { return };
                let z = base.at(at.z);
                let sight = Sight { z: &rows[z..z + n.x + n.u], du: &[], time };
                room.output(driver, sight, &mut spare[..n.y]);
                for &output in outputs {
                    rows[base.at(at.w) + output] = spare[output - n.x];
                }
            }
            Op::Error(outputs) => {
                let first = base.frame + self.program.states + self.program.inputs;
                for i in outputs.clone() {
                    let y = work.rows[self.program.y + i];
                    let error = &mut work.rows[first + i];
                    if self.blind {
                        error.lanes_mut().fill(E::of(0.0));
                        continue;
                    }
                    residual(&y, &work.measured[i], error);
                    error.lanes_mut().iter_mut().for_each(|e| *e = E::of(-e.wide()));
                }
            }
            Op::Loop(inner) => self.solve(work, base, inner),
        }
    }

    /// From the derivatives along the next states (the first adjoints) and along ŷ (in the
    /// adjoints of the outputs) to those along this sample's states, which become the first
    /// adjoints.
    pub fn back(&self, work: &mut Work<E>, sample: usize) {
        let program = &self.program;
        let base = Base { frame: work.frame(sample), stride: work.stride };
        let outputs = program.adjoint_output();
        work.adjoints[program.states..outputs.start].fill(Row::zero());
        work.adjoints[outputs.end..].fill(Row::zero());
        if sample > 0 {
            // all samples together are too many for the second cache, and the way from the
            // third one is long
            let before = work.frame(sample - 1);
            prefetch(&work.rows[before..before + work.stride]);
        }
        let slot = BATCH - 1 - work.waiting;
        for op in program.ops.iter().rev() {
            self.step_back(work, base, op, slot);
        }
        let (next, state) = work.adjoints.split_at_mut(program.states);
        next.copy_from_slice(&state[..program.states]);
        flush(next);
        work.waiting += 1;
        if work.waiting == BATCH || sample == 0 {
            self.collect(work, sample);
        }
    }

    /// One step back.
    pub(super) fn step_back(&self, work: &mut Work<E>, base: Base, op: &Op, slot: usize) {
        match op {
            Op::Gather(runs) => {
                let Work { adjoints, rows, s_lines, .. } = work;
                scatter(adjoints, rows, base, runs, &self.learned, s_lines);
            }
            Op::Zero(_) => {}
            Op::Network(block) => {
                let Evaluator::Network(net) = &self.parts[*block] else { return };
                let (at, n) = (&self.program.blocks[*block], net.layout());
                let per = n.units() + n.outputs();
                let own = &mut work.slopes[*block][slot * per..][..per];
                let (d, gy) = own.split_at_mut(n.units());
                gy.copy_from_slice(&work.adjoints[at.adjoint_w..][..n.outputs()]);
                let h = &work.rows[base.frame + at.h.start..][..n.units()];
                let gx = &mut work.adjoints[at.adjoint_z..][..at.wanted];
                net.back(h, gy, d, gx);
            }
            Op::Next(block) => {
                let Evaluator::Baseline(driver) = &self.parts[*block] else { return };
                let (at, n) = (&self.program.blocks[*block], driver.sizes);
                let Work { rows, rooms, du, time, adjoints, spare, .. } = work;
                let Some(room) = &mut rooms[*block] else { return };
                let z = base.at(at.z);
                let sight = Sight { z: &rows[z..z + n.x + n.u], du: driver.ramp(du), time };
                let lambda = &mut spare[..n.x];
                lambda.copy_from_slice(&adjoints[at.adjoint_w..][..n.x]);
                let (along_x, along_u) = along(adjoints, at, n.x, n.u);
                room.next_back(driver, sight, lambda, along_x, along_u);
            }
            Op::Readout(block, outputs) => {
                let Evaluator::Baseline(driver) = &self.parts[*block] else { return };
                let (at, n) = (&self.program.blocks[*block], driver.sizes);
                let Work { rows, rooms, time, adjoints, spare, .. } = work;
                let Some(room) = &mut rooms[*block] else { return };
                let z = base.at(at.z);
                let sight = Sight { z: &rows[z..z + n.x + n.u], du: &[], time };
                let along_y = &mut spare[..n.y];
                along_y.fill(Row::zero());
                for &output in outputs {
                    along_y[output - n.x] = adjoints[at.adjoint_w + output];
                }
                let (along_x, along_u) = along(adjoints, at, n.x, n.u);
                room.output_back(driver, sight, along_y, along_x, along_u);
            }
            Op::Error(_) if self.blind => {}
            Op::Error(outputs) => {
                // ê = y − ŷ where something was measured
                for i in outputs.clone() {
                    let from = work.adjoints[self.program.adjoint_error().start + i];
                    let y = self.program.adjoint_output().start + i;
                    let to = work.adjoints[y].lanes_mut().iter_mut();
                    for ((to, from), m) in to.zip(from.lanes()).zip(work.measured[i].lanes()) {
                        if !m.wide().is_nan() {
                            *to = E::of(to.wide() - from.wide());
                        }
                    }
                }
            }
            Op::Loop(inner) => self.solve_back(work, base, inner, slot),
        }
    }

    /// Gathers the weight gradients of the samples that wait; `sample` is the first of them.
    fn collect(&self, work: &mut Work<E>, sample: usize) {
        let (steps, frame, stride) = (work.waiting, work.frame(sample), work.stride);
        for (block, part) in self.parts.iter().enumerate() {
            let Evaluator::Network(net) = part else { continue };
            let at = &self.program.blocks[block];
            let per = net.layout().units() + net.layout().outputs();
            let z = match at.z {
                Place::Frame(i) => i,
                Place::Next(_) | Place::Shared(_) => continue,
            };
            let rows = &work.rows[..];
            let x = Instants { rows, at: frame + z, stride };
            let h = Instants { rows, at: frame + at.h.start, stride };
            let d = Instants { rows: &work.slopes[block], at: (BATCH - steps) * per, stride: per };
            net.collect(steps, x, h, d, &mut work.lines[block]);
        }
        work.waiting = 0;
    }

    /// Adds the gradient that has gathered to `gradient` (in the order of
    /// [`Interconnection::parameters`]) and starts again from 0.
    pub fn unload(&self, work: &mut Work<E>, gradient: &mut [f64]) {
        let mut rest = gradient;
        for (block, part) in self.parts.iter().enumerate() {
            let own;
            match part {
                Evaluator::Network(net) => {
                    (own, rest) = rest.split_at_mut(net.layout().len());
                    net.unfold(&work.lines[block], own);
                    work.lines[block].fill(Line::zero());
                }
                Evaluator::Baseline(driver) => {
                    (own, rest) = rest.split_at_mut(driver.free.len());
                    let Some(room) = &mut work.rooms[block] else { continue };
                    room.unload(own);
                }
            }
        }
        for (to, line) in rest.iter_mut().zip(&mut work.s_lines) {
            *to += line.sum();
            *line = Line::zero();
        }
    }
}

/// Adjoints of the states and inputs of a baseline; those of the inputs are empty where
/// nobody wants them.
fn along<'w, E: Number>(
    adjoints: &'w mut [Row<E>],
    at: &Rows,
    n: usize,
    inputs: usize,
) -> (&'w mut [Row<E>], &'w mut [Row<E>]) {
    let (x, u) = adjoints[at.adjoint_z..].split_at_mut(n);
    (&mut x[..n], if at.wanted > n { &mut u[..inputs] } else { &mut [] })
}

/// error = ŷ − y, 0 where nothing was measured.
fn residual<E: Number>(y: &Row<E>, measured: &Row<E>, error: &mut Row<E>) {
    for ((e, y), m) in error.lanes_mut().iter_mut().zip(y.lanes()).zip(measured.lanes()) {
        let (y, m) = (y.wide(), m.wide());
        *e = E::of(if m.is_nan() { 0.0 } else { y - m });
    }
}
