//! Asking a law at single points: values, slopes, and what follows from them.

use nalgebra::{DMatrix, DVector};

use super::block::{Ask, Block, Dual64, Sizes};
use super::lane_number::LaneNumber;
use super::law::{Law, Matrices};
use crate::real::{F64x8, Real};

type D = Dual64;

/// One point of a law: parameters, states, inputs, own channels, time.
#[derive(Debug, Clone)]
pub struct Point {
    /// Parameters.
    pub theta: Vec<f64>,
    /// States.
    pub x: Vec<f64>,
    /// Inputs.
    pub u: Vec<f64>,
    /// Own channels.
    pub w: Vec<f64>,
    /// Time in s.
    pub time: f64,
}

/// A direction in which slopes are wanted, with the same shape as a [`Point`].
#[derive(Debug, Clone, Copy)]
pub enum Along<'a> {
    /// In the states.
    State(&'a [f64]),
    /// In the inputs.
    Input(&'a [f64]),
    /// In the own channels.
    Channel(&'a [f64]),
    /// In the parameters.
    Theta(&'a [f64]),
}

fn constants<R: Real>(values: &[f64]) -> Vec<R> {
    values.iter().map(|&v| R::constant(v)).collect()
}

/// One pack's answer, with the derived numbers asked for first.
fn answer<R: LaneNumber>(
    law: &dyn Law,
    sizes: Sizes,
    ask: Ask,
    [theta, x, u, w]: [&[R]; 4],
    time: R,
) -> Vec<R> {
    let mut derived = vec![R::constant(0.0); sizes.derived];
    let block = Block { sizes, packs: 1, theta, derived: &[], x, u, w, read: &[], time };
    if sizes.derived > 0 {
        law.answer(Ask::Derived, R::call(&block, &mut derived));
    }
    let mut out = vec![R::constant(0.0); sizes.answer(ask)];
    law.answer(ask, R::call(&Block { derived: &derived, ..block }, &mut out));
    out
}

/// The law's answer at a point.
pub fn value(law: &dyn Law, sizes: Sizes, ask: Ask, at: &Point) -> Vec<f64> {
    let (theta, x) = (constants::<F64x8>(&at.theta), constants::<F64x8>(&at.x));
    let (u, w) = (constants::<F64x8>(&at.u), constants::<F64x8>(&at.w));
    let out = answer(law, sizes, ask, [&theta, &x, &u, &w], F64x8::constant(at.time));
    out.iter().map(|v| v.lane(0)).collect()
}

/// The derivative of the law's answer along one direction, exactly.
pub fn slope(law: &dyn Law, sizes: Sizes, ask: Ask, at: &Point, along: Along<'_>) -> Vec<f64> {
    let mut theta = constants::<D>(&at.theta);
    let mut x = constants::<D>(&at.x);
    let mut u = constants::<D>(&at.u);
    let mut w = constants::<D>(&at.w);
    let (target, direction) = match along {
        Along::State(d) => (&mut x, d),
        Along::Input(d) => (&mut u, d),
        Along::Channel(d) => (&mut w, d),
        Along::Theta(d) => (&mut theta, d),
    };
    for (dual, &d) in target.iter_mut().zip(direction) {
        dual.slope[0] = F64x8::constant(d);
    }
    let out = answer(law, sizes, ask, [&theta, &x, &u, &w], D::constant(at.time));
    out.iter().map(|v| v.slope[0].lane(0)).collect()
}

/// A unit vector.
pub fn unit(n: usize, i: usize) -> Vec<f64> {
    let mut e = vec![0.0; n];
    if let Some(entry) = e.get_mut(i) {
        *entry = 1.0;
    }
    e
}

/// The law's matrices at a point: slopes along every state, input and own channel, and the
/// constant parts that make the linear law meet the true one there.
pub fn matrices(law: &dyn Law, sizes: Sizes, at: &Point) -> Matrices {
    let columns = |ask: Ask, n: usize, along: &dyn Fn(&[f64]) -> Vec<f64>| {
        let columns: Vec<_> = (0..n).map(|i| DVector::from_vec(along(&unit(n, i)))).collect();
        if columns.is_empty() {
            DMatrix::zeros(sizes.answer(ask), 0)
        } else {
            DMatrix::from_columns(&columns)
        }
    };
    let along_state = |ask| columns(ask, sizes.x, &|d| slope(law, sizes, ask, at, Along::State(d)));
    let along_input = |ask| columns(ask, sizes.u, &|d| slope(law, sizes, ask, at, Along::Input(d)));
    let ask = Ask::Derivative;
    let g = if law.signals().channels.is_empty() {
        DMatrix::identity(sizes.x, sizes.x)
    } else {
        columns(ask, sizes.w, &|d| slope(law, sizes, ask, at, Along::Channel(d)))
    };
    let (a, b) = (along_state(Ask::Derivative), along_input(Ask::Derivative));
    let (c, d) = (along_state(Ask::Output), along_input(Ask::Output));
    let (x, u) = (DVector::from_column_slice(&at.x), DVector::from_column_slice(&at.u));
    let f = DVector::from_vec(value(law, sizes, Ask::Derivative, at)) - &a * &x - &b * &u;
    let h = DVector::from_vec(value(law, sizes, Ask::Output, at)) - &c * &x - &d * &u;
    Matrices { a, b, g, f, c, d, h }
}

/// The equilibrium nearest 0 for inputs 0: Newton's method on the derivative (or on the next
/// state minus the state), each step the least-norm one, from 0 and, where the law has no
/// slope there, from the model's initial state.
pub fn equilibrium(law: &dyn Law) -> Option<(Vec<f64>, Vec<f64>)> {
    let signals = law.signals();
    let sizes = Sizes::of(&signals);
    let discrete = !signals.time.is_continuous();
    let start = |x: Vec<f64>| Point {
        theta: signals.theta(),
        x,
        u: vec![0.0; sizes.u],
        w: vec![0.0; sizes.w],
        time: 0.0,
    };
    for x in [vec![0.0; sizes.x], signals.initial()] {
        let mut at = start(x);
        for _ in 0..100 {
            let mut rest = DVector::from_vec(value(law, sizes, Ask::Derivative, &at));
            let mut slope = matrices(law, sizes, &at).a;
            if discrete {
                rest -= DVector::from_column_slice(&at.x);
                slope -= DMatrix::identity(sizes.x, sizes.x);
            }
            if !rest.iter().all(|v| v.is_finite()) {
                break;
            }
            let scale = 1.0 + at.x.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
            if rest.amax() <= 1e-12 * scale {
                return Some((at.x, at.u));
            }
            let Ok(inverse) = slope.pseudo_inverse(1e-12) else { break };
            let step = inverse * rest;
            for (x, d) in at.x.iter_mut().zip(step.iter()) {
                *x -= d;
            }
        }
    }
    None
}
