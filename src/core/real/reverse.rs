//! Reverse mode over a recorded computation.
//!
//! ```text
//! v_i = φ_i(v_j, v_k);   from the last i to the first: v̄_j += v̄_i ∂φ_i/∂v_j,  v̄_k += v̄_i ∂φ_i/∂v_k
//! ```
//!
//! One sweep forward and one back give the slopes of a weighted sum of all results along everything
//! that was given, whatever their number (the cheap gradient principle: Griewank and Walther,
//! Evaluating Derivatives, 2nd ed., 2008, ch. 3 and 4). Kinks follow the rule of dual numbers.

use super::straight_line::{Leaf, Op, StraightLine, each_binary, each_unary};
use super::tape::{Binary, Node, Tape, Unary};
use super::{Dual, InRegisters, Real};
use crate::per_lanes;

/// A tape made ready for sweeps: what its results are made of, leaves first.
///
/// # Example
///
/// ```
/// use lacuna::real::{F64x8, Given, Leaf, Real, Reverse, Tape, Trace};
///
/// let (y, tape) = Tape::record(|| {
///     let x = Trace::given(Given::State(0), 0.5);
///     x.sin() * x
/// });
/// let reverse = Reverse::of(&tape, &[y.node(&tape)]).unwrap();
/// assert_eq!(reverse.leaves(), [Leaf::Given(Given::State(0))]);
/// let x = F64x8::constant(0.5);
/// let [mut values, mut slopes] = reverse.room::<F64x8>();
/// values[..Reverse::PACKS].fill(x);
/// reverse.forward(&mut values);
/// let weights = vec![F64x8::constant(2.0); Reverse::PACKS];
/// reverse.back(&values, &mut slopes, &weights);
/// let slope = 2.0 * (0.5_f64.cos() * 0.5 + 0.5_f64.sin());
/// assert!((slopes[0].0[0] - slope).abs() < 1e-15);
/// ```
#[derive(Debug, Clone)]
pub struct Reverse(StraightLine);

impl Reverse {
    /// Packs of numbers that one sweep takes together: value `p` of number `i` stands at
    /// `i * PACKS + p`.
    pub const PACKS: usize = 4;

    /// Sweeps over what some results are made of, a constant being `None`; `None` where a delay line
    /// is among it, which a single step does not know.
    pub fn of(tape: &Tape, results: &[Option<Node>]) -> Option<Self> {
        StraightLine::of(tape, results).map(Self)
    }

    /// What it begins with: the first numbers.
    pub fn leaves(&self) -> &[Leaf] {
        &self.0.leaves
    }

    /// Room for the values of all numbers and for their slopes, constants filled in.
    pub fn room<R: InRegisters>(&self) -> [Vec<R>; 2] {
        let zeros = || vec![R::constant(0.0); self.0.count() * Self::PACKS];
        let mut values = zeros();
        for (leaf, values) in self.0.leaves.iter().zip(values.chunks_exact_mut(Self::PACKS)) {
            if let Leaf::Constant(value) = leaf {
                values.fill(R::constant(*value));
            }
        }
        [values, zeros()]
    }

    /// Computes all values, those of the leaves being given.
    pub fn forward<R: InRegisters>(&self, values: &mut [R]) {
        forward(&self.0.ops, self.0.leaves.len(), values);
    }

    /// Packs of a result whose values are there; `None` where it is a constant.
    pub fn result<'r, R>(&self, values: &'r [R], number: usize) -> Option<&'r [R]> {
        self.0.roots[number].map(|root| &values[root as usize * Self::PACKS..][..Self::PACKS])
    }

    /// The slopes of the sum of all results, each times its weight (laid out as the values), along
    /// every leaf. Slopes have to be 0 before; those of the leaves have to be set to 0 by whoever has read
    /// them, all others are.
    pub fn back<R: InRegisters>(&self, values: &[R], slopes: &mut [R], weights: &[R]) {
        for (root, weights) in self.0.roots.iter().zip(weights.chunks_exact(Self::PACKS)) {
            let Some(root) = root else { continue };
            let to = slopes[*root as usize * Self::PACKS..].iter_mut();
            to.zip(weights).for_each(|(to, &weight)| *to += weight);
        }
        backward(&self.0.ops, self.0.leaves.len(), values, slopes);
    }
}

const N: usize = Reverse::PACKS;

/// A number's packs.
#[inline(always)]
fn packs<R: Copy>(of: &[R], i: u32) -> [R; N] {
    let from = i as usize * N;
    std::array::from_fn(|p| of[from + p])
}

#[inline(always)]
fn map<R: Real>(mut x: [R; N], f: Unary) -> [R; N] {
    for x in &mut x {
        *x = f.of(*x);
    }
    x
}

#[inline(always)]
fn join<R: Real>(mut x: [R; N], y: [R; N], f: Binary) -> [R; N] {
    for p in 0..N {
        x[p] = f.of(x[p], y[p]);
    }
    x
}

/// Adds weight times slope; nothing weighs nothing, however steep.
#[inline(always)]
fn add<R: Real>(slopes: &mut [R], to: u32, weight: [R; N], slope: [R; N]) {
    let to = &mut slopes[to as usize * N..][..N];
    for p in 0..N {
        let zero = R::constant(0.0);
        to[p] += weight[p].abs().where_positive(weight[p] * slope[p], zero);
    }
}

per_lanes! {
    /// All values after the leaves'.
    fn forward[; R](ops: &[Op], leaves: usize, values: &mut [R]) {
        for (i, op) in ops.iter().enumerate() {
            let value = match *op {
                Op::One(f, a) => {
                    let x = packs(values, a);
                    each_unary!(f, F => map(x, F))
                }
                Op::Two(f, a, b) => {
                    let (x, y) = (packs(values, a), packs(values, b));
                    each_binary!(f, F => join(x, y, F))
                }
                Op::Choice(at, yes, no) => {
                    let (mut at, yes, no) = (packs(values, at), packs(values, yes), packs(values, no));
                    for p in 0..N {
                        at[p] = at[p].where_positive(yes[p], no[p]);
                    }
                    at
                }
            };
            values[(leaves + i) * N..][..N].copy_from_slice(&value);
        }
    }
}

/// The slope of a function of one number.
#[inline(always)]
fn slope_of<R: Real>(mut x: [R; N], f: Unary) -> [R; N] {
    for x in &mut x {
        *x = f.of(Dual::<R, 1>::along(*x, 0)).slope[0];
    }
    x
}

/// The slopes of a function of two numbers.
#[inline(always)]
fn slopes_of<R: Real>(mut x: [R; N], mut y: [R; N], f: Binary) -> [[R; N]; 2] {
    for p in 0..N {
        let dual = f.of(Dual::<R, 2>::along(x[p], 0), Dual::<R, 2>::along(y[p], 1));
        [x[p], y[p]] = dual.slope;
    }
    [x, y]
}

per_lanes! {
    /// Slopes handed from every operation to its operands.
    fn backward[; R](ops: &[Op], leaves: usize, values: &[R], slopes: &mut [R]) {
        let one = [R::constant(1.0); N];
        for (i, op) in ops.iter().enumerate().rev() {
            let own = (leaves + i) as u32;
            let weight = packs(slopes, own);
            slopes[own as usize * N..][..N].fill(R::constant(0.0));
            match *op {
                Op::One(Unary::Negative, a) => add(slopes, a, weight, [R::constant(-1.0); N]),
                Op::One(Unary::Tanh, a) => {
                    let mut slope = packs(values, own);
                    for t in &mut slope {
                        *t = -(*t * *t) + 1.0;
                    }
                    add(slopes, a, weight, slope);
                }
                Op::One(f, a) => {
                    let x = packs(values, a);
                    let slope = each_unary!(f, F => slope_of(x, F));
                    add(slopes, a, weight, slope);
                }
                Op::Two(Binary::Add, a, b) => {
                    add(slopes, a, weight, one);
                    add(slopes, b, weight, one);
                }
                Op::Two(Binary::Subtract, a, b) => {
                    add(slopes, a, weight, one);
                    add(slopes, b, weight, [R::constant(-1.0); N]);
                }
                Op::Two(Binary::Multiply, a, b) => {
                    let (x, y) = (packs(values, a), packs(values, b));
                    add(slopes, a, weight, y);
                    add(slopes, b, weight, x);
                }
                Op::Two(f, a, b) => {
                    let (x, y) = (packs(values, a), packs(values, b));
                    let [along_a, along_b] = each_binary!(f, F => slopes_of(x, y, F));
                    add(slopes, a, weight, along_a);
                    add(slopes, b, weight, along_b);
                }
                Op::Choice(at, yes, no) => {
                    let (zero, mut left, mut right) = (R::constant(0.0), weight, weight);
                    for (p, at) in packs(values, at).into_iter().enumerate() {
                        left[p] = at.where_positive(weight[p], zero);
                        right[p] = at.where_positive(zero, weight[p]);
                    }
                    add(slopes, yes, left, one);
                    add(slopes, no, right, one);
                }
            }
        }
    }
}
