//! A recorded answer of a step, with the leaves that what is given goes to.

use crate::real::{Forward, Given, Leaf, Node, Tape};

/// Registers of slopes of all numbers up to which a program is replayed: half a megabyte.
const REGISTERS: usize = 8192;

/// How many of what the directions of a program are, in their order. What is recorded as given has the
/// parameters first, then the forces.
#[derive(Clone, Copy)]
pub(super) struct Sizes {
    pub states: usize,
    pub forces: usize,
    pub parameters: usize,
}

/// A recorded answer, with the leaves that what is given goes to.
pub(super) struct Program {
    pub forward: Forward,
    given: Vec<(Given, usize)>,
    sizes: Sizes,
}

impl Program {
    /// Some results of a tape along so many directions, all of which are there or none; `None` where a delay
    /// line is among it, or it is too large.
    pub fn of(tape: &Tape, results: &[Node], directions: usize, sizes: Sizes) -> Option<Self> {
        let nodes: Vec<Option<Node>> = results.iter().copied().map(Some).collect();
        let forward = Forward::of(tape, &nodes, directions)?;
        let leaves = forward.leaves().iter().enumerate();
        let given = leaves.filter_map(|(i, leaf)| match leaf {
            Leaf::Given(given) => Some((*given, i)),
            Leaf::Constant(_) => None,
        });
        let given: Vec<(Given, usize)> = given.collect();
        if forward.registers() > REGISTERS {
            return None;
        }
        let mut program = Self { forward, given, sizes };
        if directions > 0 {
            program.seed_states();
            program.seed_rest();
        }
        Some(program)
    }

    /// Where something given goes, if it is asked for.
    pub fn leaf(&self, of: Given) -> Option<usize> {
        self.given.iter().find(|(given, _)| *given == of).map(|(_, leaf)| *leaf)
    }

    /// Lets states move along directions of their own.
    pub fn seed_states(&mut self) {
        for &(given, leaf) in &self.given {
            if let Given::State(i) = given {
                self.forward.seed(leaf, i as usize);
            }
        }
    }

    /// Lets forces and parameters do so.
    fn seed_rest(&mut self) {
        let Sizes { states, forces, parameters } = self.sizes;
        for &(given, leaf) in &self.given {
            let Given::Parameter(i) = given else { continue };
            let direction = match (i as usize).checked_sub(parameters) {
                Some(force) => states + force,
                None => states + forces + i as usize,
            };
            self.forward.seed(leaf, direction);
        }
    }

    /// Gives every leaf the value that it is told of; the others keep theirs.
    pub fn give(&mut self, value: impl Fn(Given) -> Option<f64>) {
        for &(given, leaf) in &self.given {
            if let Some(value) = value(given) {
                self.forward.give(leaf, value);
            }
        }
    }
}
