//! Code generation by operator overloading: what a law does with its numbers, written down as
//! a graph of operations (Griewank and Walther, Evaluating Derivatives, 2nd ed., 2008, ch. 6).
//!
//! v_i = φ_i(v_j), j before i: every operation of a [`Trace`](super::Trace) adds one term to
//! the tape of its thread. Equal terms are there once; what is known is computed at once.

use std::cell::RefCell;
use std::collections::HashMap;

use super::Real;

/// Number of a term on its tape.
pub type Node = u32;

/// A function of one number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[allow(missing_docs)] // each is the method of `Real` of that name
pub enum Unary {
    Negative,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Ln,
    Sqrt,
    Abs,
    Signum,
}

/// A function of two numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[allow(missing_docs)] // each is the operator or the method of `Real` of that name
pub enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Atan2,
    Min,
    Max,
    Power,
}

/// What is given from outside at every step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Given {
    /// A number that may be changed between runs.
    Parameter(u32),
    /// A number that is kept from step to step.
    State(u32),
    /// An input at this sample.
    Input(u32),
    /// An input at the next sample.
    Next(u32),
    /// Time at the start of the step, in s.
    Time,
    /// Number of the step within its sample, from 0.
    Substep,
    /// 1 once a step has been made, 0 before.
    Started,
}

/// One term of a recorded computation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Term {
    /// A constant, by its bits.
    Constant(u64),
    /// Something given.
    Given(Given),
    /// A function of one term.
    One(Unary, Node),
    /// A function of two terms.
    Two(Binary, Node, Node),
    /// The second where the first is above zero, else the third.
    Choice(Node, Node, Node),
    /// The mean over the step of what entered a delay line `back` steps ago and was held.
    PastHeld {
        /// Number of the line.
        line: u32,
        /// How many steps ago, above zero.
        back: Node,
        /// What enters now.
        now: Node,
    },
    /// The value `at` steps from now on the straight lines between what entered a delay line.
    PastLine {
        /// Number of the line.
        line: u32,
        /// At most 1; below zero in the past.
        at: Node,
        /// What enters now.
        now: Node,
        /// What will have been reached at the end of the step.
        end: Node,
    },
}

impl Term {
    /// The terms that it is made of.
    pub fn operands(&self) -> impl Iterator<Item = Node> + use<> {
        let all = match *self {
            Self::Constant(_) | Self::Given(_) => [None; 3],
            Self::One(_, a) => [Some(a), None, None],
            Self::Two(_, a, b) => [Some(a), Some(b), None],
            Self::Choice(a, b, c) => [Some(a), Some(b), Some(c)],
            Self::PastHeld { back, now, .. } => [Some(back), Some(now), None],
            Self::PastLine { at, now, end, .. } => [Some(at), Some(now), Some(end)],
        };
        all.into_iter().flatten()
    }
}

/// What remembers a series of values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Line {
    /// How many of them.
    pub depth: usize,
    /// What enters it at every step.
    pub enters: Node,
}

/// A recorded computation; terms stand behind those that they are made of.
#[derive(Debug, Clone, Default)]
pub struct Tape {
    terms: Vec<Term>,
    known: HashMap<Term, Node>,
    lines: Vec<Line>,
}

thread_local! {
    static TAPE: RefCell<Option<Tape>> = const { RefCell::new(None) };
}

impl Tape {
    /// Records what `work` computes in [`Trace`](super::Trace) numbers, on this thread.
    ///
    /// # Example
    ///
    /// ```
    /// use lacuna::real::{Given, Real, Tape, Trace};
    ///
    /// let (root, tape) = Tape::record(|| {
    ///     let x = Trace::given(Given::State(0), 0.5);
    ///     (x * x + x * x).sin()
    /// });
    /// // x, x x, their sum, its sine
    /// assert_eq!(tape.terms().len(), 4);
    /// assert_eq!(root.node(&tape), Some(3));
    /// assert_eq!(root.value(), 0.5_f64.sin());
    /// ```
    pub fn record<T>(work: impl FnOnce() -> T) -> (T, Self) {
        let before = TAPE.replace(Some(Self::default()));
        let done = work();
        (done, TAPE.replace(before).unwrap_or_default())
    }

    /// All terms.
    pub fn terms(&self) -> &[Term] {
        &self.terms
    }

    /// All delay lines.
    pub fn lines(&self) -> &[Line] {
        &self.lines
    }

    /// The number of a term, there already or from now on.
    pub(super) fn add(&mut self, term: Term) -> Node {
        *self.known.entry(term).or_insert_with(|| {
            self.terms.push(term);
            (self.terms.len() - 1) as Node
        })
    }

    /// The number of a term on the tape of this thread, where one is being recorded.
    pub(super) fn note(term: impl FnOnce(&mut Self) -> Term) -> Option<Node> {
        TAPE.with_borrow_mut(|tape| {
            let tape = tape.as_mut()?;
            let term = term(tape);
            Some(tape.add(term))
        })
    }

    /// Notes one more delay line; its number.
    pub(super) fn line(depth: usize, enters: impl FnOnce(&mut Self) -> Node) -> Option<u32> {
        TAPE.with_borrow_mut(|tape| {
            let tape = tape.as_mut()?;
            let enters = enters(tape);
            tape.lines.push(Line { depth, enters });
            Some((tape.lines.len() - 1) as u32)
        })
    }
}

impl Unary {
    /// The value for a number of any kind.
    #[inline(always)]
    pub fn of<R: Real>(self, x: R) -> R {
        match self {
            Self::Negative => -x,
            Self::Sin => x.sin(),
            Self::Cos => x.cos(),
            Self::Tan => x.tan(),
            Self::Asin => x.asin(),
            Self::Acos => x.acos(),
            Self::Atan => x.atan(),
            Self::Sinh => x.sinh(),
            Self::Cosh => x.cosh(),
            Self::Tanh => x.tanh(),
            Self::Exp => x.exp(),
            Self::Ln => x.ln(),
            Self::Sqrt => x.sqrt(),
            Self::Abs => x.abs(),
            Self::Signum => x.signum(),
        }
    }
}

impl Binary {
    /// The value for two numbers of any kind.
    #[inline(always)]
    pub fn of<R: Real>(self, a: R, b: R) -> R {
        match self {
            Self::Add => a + b,
            Self::Subtract => a - b,
            Self::Multiply => a * b,
            Self::Divide => a / b,
            Self::Atan2 => a.atan2(b),
            Self::Min => a.min(b),
            Self::Max => a.max(b),
            Self::Power => a.powf(b),
        }
    }
}
