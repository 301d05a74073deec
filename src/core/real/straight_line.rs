//! A recorded computation made ready for sweeps: a straight-line program.
//!
//! ```text
//! v_i = φ_i(v_j, v_k), j and k before i; the first ones are given
//! ```
//!
//! (Griewank and Walther, Evaluating Derivatives, 2nd ed., 2008, section 2.2.)

use super::tape::{Binary, Given, Node, Tape, Term, Unary};

/// One operation; operands are numbers of leaves and of operations before it.
#[derive(Debug, Clone, Copy)]
pub(super) enum Op {
    One(Unary, u32),
    Two(Binary, u32, u32),
    Choice(u32, u32, u32),
}

/// What a recorded computation begins with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Leaf {
    /// A constant.
    Constant(f64),
    /// Something given from outside.
    Given(Given),
}

/// What some results are made of, leaves first.
#[derive(Debug, Clone)]
pub(super) struct StraightLine {
    pub leaves: Vec<Leaf>,
    pub ops: Vec<Op>,
    /// The number of each result; none where it is a constant.
    pub roots: Vec<Option<u32>>,
}

impl StraightLine {
    /// What some results are made of, a constant being `None`; `None` where a delay line is among it, which a
    /// single step does not know.
    pub fn of(tape: &Tape, results: &[Option<Node>]) -> Option<Self> {
        let terms = tape.terms();
        let mut needed = vec![false; terms.len()];
        results.iter().flatten().for_each(|&node| needed[node as usize] = true);
        for i in (0..terms.len()).rev() {
            if needed[i] {
                terms[i].operands().for_each(|operand| needed[operand as usize] = true);
            }
        }
        let mut leaves = vec![];
        let mut number = vec![0_u32; terms.len()];
        for (i, term) in terms.iter().enumerate().filter(|(i, _)| needed[*i]) {
            let leaf = match *term {
                Term::Constant(bits) => Leaf::Constant(f64::from_bits(bits)),
                Term::Given(given) => Leaf::Given(given),
                _ => continue,
            };
            number[i] = leaves.len() as u32;
            leaves.push(leaf);
        }
        let mut ops = vec![];
        for (i, term) in terms.iter().enumerate().filter(|(i, _)| needed[*i]) {
            let at = |node: Node| number[node as usize];
            let op = match *term {
                Term::Constant(_) | Term::Given(_) => continue,
                Term::One(function, a) => Op::One(function, at(a)),
                Term::Two(function, a, b) => Op::Two(function, at(a), at(b)),
                Term::Choice(a, b, c) => Op::Choice(at(a), at(b), at(c)),
                Term::PastHeld { .. } | Term::PastLine { .. } => return None,
            };
            number[i] = (leaves.len() + ops.len()) as u32;
            ops.push(op);
        }
        let roots = results.iter().map(|node| node.map(|node| number[node as usize])).collect();
        Some(Self { leaves, ops, roots })
    }

    /// Leaves and operations.
    pub fn count(&self) -> usize {
        self.leaves.len() + self.ops.len()
    }
}

/// One arm for each function, so that each is compiled as itself.
macro_rules! each_unary {
    ($function:expr, $with:ident => $work:expr) => {
        $crate::real::straight_line::each!($function, Unary: Negative, Sin, Cos, Tan, Asin, Acos, Atan, Sinh,
            Cosh, Tanh, Exp, Ln, Sqrt, Abs, Signum => $with $work)
    };
}

/// The same for functions of two numbers.
macro_rules! each_binary {
    ($function:expr, $with:ident => $work:expr) => {
        $crate::real::straight_line::each!($function, Binary: Add, Subtract, Multiply, Divide, Atan2, Min, Max,
            Power => $with $work)
    };
}

macro_rules! each {
    ($function:expr, $kind:ident: $($name:ident),* => $with:ident $work:expr) => {
        match $function {
            $($kind::$name => {
                const $with: $kind = $kind::$name;
                $work
            })*
        }
    };
}

pub(super) use {each, each_binary, each_unary};
