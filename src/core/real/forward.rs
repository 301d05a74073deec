//! Forward mode over a recorded computation, along many directions at once.
//!
//! ```text
//! v_i = φ_i(v_j, v_k),   v̇_i = v̇_j ∂φ_i/∂v_j + v̇_k ∂φ_i/∂v_k
//! ```
//!
//! (Griewank and Walther, Evaluating Derivatives, 2nd ed., 2008, section 3.1.) A value is computed once, and
//! every lane of a register is a direction of its own: what a [`Dual`] over lanes does for as many points
//! as there are lanes, this does for one point along eight directions. Kinks follow the rule of dual numbers.

use super::straight_line::{Leaf, Op, StraightLine, each_binary, each_unary};
use super::tape::{Binary, Node, Tape, Unary};
use super::{Dual, F64x8, Real};
use crate::per_lanes;

/// Directions in one register.
const LANES: usize = 8;

/// A recorded computation with room for its values and slopes.
///
/// # Example
///
/// ```
/// use lacuna::real::{Forward, Given, Real, Tape, Trace};
///
/// let (y, tape) = Tape::record(|| {
///     let x = Trace::given(Given::State(0), 0.0);
///     x.sin() * x
/// });
/// let mut forward = Forward::of(&tape, &[y.node(&tape)], 1).unwrap();
/// forward.give(0, 0.5);
/// forward.seed(0, 0);
/// forward.run();
/// let mut slope = [0.0];
/// forward.slopes(0, 0, &mut slope);
/// assert_eq!(forward.value(0), 0.5_f64.sin() * 0.5);
/// assert!((slope[0] - (0.5_f64.cos() * 0.5 + 0.5_f64.sin())).abs() < 1e-15);
/// ```
#[derive(Debug, Clone)]
pub struct Forward {
    line: StraightLine,
    /// Registers of slopes that every number has.
    registers: usize,
    /// Each the same in all lanes.
    values: Vec<F64x8>,
    slopes: Vec<F64x8>,
    /// Room for what is handed on.
    handed: Vec<F64x8>,
}

impl Forward {
    /// What some results are made of, a constant being `None`, along so many directions; `None` where a delay
    /// line is among it, which a single step does not know.
    pub fn of(tape: &Tape, results: &[Option<Node>], directions: usize) -> Option<Self> {
        let line = StraightLine::of(tape, results)?;
        let registers = directions.div_ceil(LANES);
        let mut values = vec![F64x8::constant(0.0); line.count()];
        for (value, leaf) in values.iter_mut().zip(&line.leaves) {
            if let Leaf::Constant(constant) = leaf {
                *value = F64x8::constant(*constant);
            }
        }
        let slopes = vec![F64x8::constant(0.0); registers * line.count()];
        Some(Self { line, registers, values, slopes, handed: vec![] })
    }

    /// What it begins with.
    pub fn leaves(&self) -> &[Leaf] {
        &self.line.leaves
    }

    /// Registers that the slopes of all numbers take.
    pub fn registers(&self) -> usize {
        self.slopes.len()
    }

    /// Sets the value of a leaf.
    pub fn give(&mut self, leaf: usize, value: f64) {
        self.values[leaf] = F64x8::constant(value);
    }

    /// Lets a leaf move one to one along a direction, and along no other.
    pub fn seed(&mut self, leaf: usize, direction: usize) {
        let own = &mut self.slopes[leaf * self.registers..][..self.registers];
        own.fill(F64x8::constant(0.0));
        own[direction / LANES].0[direction % LANES] = 1.0;
    }

    /// Computes all results and their slopes from what the leaves have.
    pub fn run(&mut self) {
        let Self { line, registers, values, slopes, .. } = self;
        forward(&line.ops, line.leaves.len(), *registers, values, slopes);
    }

    /// The value of a result.
    pub fn value(&self, result: usize) -> f64 {
        self.line.roots[result].map_or(f64::NAN, |root| self.values[root as usize].0[0])
    }

    /// The slopes of a result along the directions from `first` on.
    pub fn slopes(&self, result: usize, first: usize, to: &mut [f64]) {
        let Some(root) = self.line.roots[result] else { return to.fill(0.0) };
        let own = &self.slopes[root as usize * self.registers..];
        for (j, to) in to.iter_mut().enumerate() {
            let d = first + j;
            *to = own[d / LANES].0[d % LANES];
        }
    }

    /// Hands results, with their slopes, on to leaves: pairs of a result and a leaf.
    pub fn hand_on(&mut self, pairs: &[(usize, usize)]) {
        let Self { line, registers, values, slopes, handed } = self;
        let of = |number: usize| number * *registers..(number + 1) * *registers;
        // a result may be a leaf itself
        handed.clear();
        for &(result, leaf) in pairs {
            let from = line.roots[result].map_or(leaf, |root| root as usize);
            handed.push(values[from]);
            handed.extend_from_slice(&slopes[of(from)]);
        }
        for (&(_, leaf), handed) in pairs.iter().zip(handed.chunks_exact(1 + *registers)) {
            values[leaf] = handed[0];
            slopes[of(leaf)].copy_from_slice(&handed[1..]);
        }
    }
}

/// A slope times a derivative; no slope stays none, however large the derivative.
#[inline(always)]
fn times<R: Real>(slope: R, derivative: R) -> R {
    slope.abs().where_positive(slope * derivative, R::constant(0.0))
}

/// The registers of a number's slopes.
#[inline(always)]
fn own<R>(slopes: &[R], of: u32, registers: usize) -> &[R] {
    &slopes[of as usize * registers..][..registers]
}

// loops and no closures: a closure is a function of its own, which does not get the vector instructions of
// the one around it
per_lanes! {
    /// Values and slopes of all numbers after the leaves.
    fn forward[; R](ops: &[Op], leaves: usize, registers: usize, values: &mut [R], slopes: &mut [R]) {
        for (i, op) in ops.iter().enumerate() {
            let number = leaves + i;
            let (before, rest) = slopes.split_at_mut(number * registers);
            let to = &mut rest[..registers];
            values[number] = match *op {
                Op::One(f, a) => {
                    let x = Dual::<R, 1>::along(values[a as usize], 0);
                    let y = each_unary!(f, F => F.of(x));
                    let along = own(before, a, registers);
                    for r in 0..registers {
                        to[r] = along[r] * y.slope[0];
                    }
                    y.value
                }
                Op::Two(Binary::Add, a, b) => {
                    let (s, t) = (own(before, a, registers), own(before, b, registers));
                    for r in 0..registers {
                        to[r] = s[r] + t[r];
                    }
                    values[a as usize] + values[b as usize]
                }
                Op::Two(Binary::Subtract, a, b) => {
                    let (s, t) = (own(before, a, registers), own(before, b, registers));
                    for r in 0..registers {
                        to[r] = s[r] - t[r];
                    }
                    values[a as usize] - values[b as usize]
                }
                Op::Two(Binary::Multiply, a, b) => {
                    let (x, y) = (values[a as usize], values[b as usize]);
                    let (s, t) = (own(before, a, registers), own(before, b, registers));
                    for r in 0..registers {
                        to[r] = s[r] * y + x * t[r];
                    }
                    x * y
                }
                Op::Two(f, a, b) => {
                    let x = Dual::<R, 2>::along(values[a as usize], 0);
                    let y = Dual::<R, 2>::along(values[b as usize], 1);
                    let z = each_binary!(f, F => F.of(x, y));
                    let (s, t) = (own(before, a, registers), own(before, b, registers));
                    for r in 0..registers {
                        to[r] = times(s[r], z.slope[0]) + times(t[r], z.slope[1]);
                    }
                    z.value
                }
                Op::Choice(at, yes, no) => {
                    let at = values[at as usize];
                    let (s, t) = (own(before, yes, registers), own(before, no, registers));
                    for r in 0..registers {
                        to[r] = at.where_positive(s[r], t[r]);
                    }
                    at.where_positive(values[yes as usize], values[no as usize])
                }
            };
        }
    }
}
