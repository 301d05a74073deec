//! The numbers of a linearisation, at the parameters of every lane.

use super::super::block::{Ask, Block, DIRECTIONS, Dual64};
use super::super::lane_number::LaneNumber;
use super::super::{Sizes, StateSpaceModel};
use crate::per_lanes;
use crate::real::{F64x8, Real};

type D = Dual64;

/// Where the numbers stand behind those that the inner law derives: for every state its
/// constant, then the slopes along x, u, w; for every output its constant, then those along x, u.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    /// Sizes of the inner law.
    pub inner: Sizes,
}

impl Place {
    /// How many numbers a row has.
    fn width(self, ask: Ask) -> usize {
        let n = self.inner;
        1 + n.x + n.u + if ask == Ask::Derivative { n.w } else { 0 }
    }

    /// How many numbers there are.
    pub fn count(self) -> usize {
        let n = self.inner;
        n.x * self.width(Ask::Derivative) + n.y * self.width(Ask::Output)
    }

    /// The first of a question's numbers, the inner law's own counted.
    fn first(self, ask: Ask) -> usize {
        let states = self.inner.x * self.width(Ask::Derivative);
        self.inner.derived + if ask == Ask::Derivative { 0 } else { states }
    }
}

per_lanes! {
    /// The answer of the linear law: constant + slopes times (x, u, w).
    fn rows[; R](block: &Block<'_, R>, first: usize, width: usize, out: &mut [R]) {
        let n = block.sizes;
        for (pack, out) in out.chunks_exact_mut(out.len() / block.packs).enumerate() {
            let table = &block.derived[pack * n.derived..][..n.derived][first..];
            let (x, u) = (&block.x[pack * n.x..][..n.x], &block.u[pack * n.u..][..n.u]);
            let w = &block.w[pack * n.w..][..n.w];
            for (out, row) in out.iter_mut().zip(table.chunks_exact(width)) {
                let mut sum = row[0];
                let mut slopes = &row[1..];
                for values in [x, u, w] {
                    for (&slope, &value) in slopes.iter().zip(values) {
                        sum += slope * value;
                    }
                    slopes = &slopes[values.len().min(slopes.len())..];
                }
                *out = sum;
            }
        }
    }
}

/// What the linear law answers, from the numbers among the block's derived ones.
pub(super) fn answer<R: LaneNumber>(place: Place, ask: Ask, block: &Block<'_, R>, out: &mut [R]) {
    if !out.is_empty() {
        rows(block, place.first(ask), place.width(ask), out);
    }
}

/// Where the numbers of a pack go: `skip` numbers behind the first of `stride`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rows {
    pub stride: usize,
    pub skip: usize,
}

/// Fills in the numbers at each pack's parameters and at one time.
pub(super) fn fill(
    of: &dyn StateSpaceModel,
    place: Place,
    (x, u): &(Vec<f64>, Vec<f64>),
    (theta, packs): (&[F64x8], usize),
    time: f64,
    (rows, out): (Rows, &mut [F64x8]),
) {
    let n = place.inner;
    let theta: Vec<D> = theta.iter().map(|&v| D::fixed(v)).collect();
    let zero = D::constant(0.0);
    // all packs' states, then their inputs, then their channels
    let (inputs, channels, end) = (packs * n.x, packs * (n.x + n.u), packs * (n.x + n.u + n.w));
    let mut point = vec![zero; end];
    for (to, &at) in point.iter_mut().zip(x.iter().cycle().take(inputs)) {
        to.value = F64x8::constant(at);
    }
    for (to, &at) in point[inputs..].iter_mut().zip(u.iter().cycle().take(channels - inputs)) {
        to.value = F64x8::constant(at);
    }
    let time = D::constant(time);
    let mut derived = vec![zero; packs * n.derived];
    if n.derived > 0 {
        let (x, rest) = point.split_at(inputs);
        let (u, w) = rest.split_at(channels - inputs);
        let block = Block { sizes: n, packs, theta: &theta, derived: &[], x, u, w, time };
        of.answer(Ask::Derived, D::call(&block, &mut derived));
    }

    let mut answers = vec![zero; packs * n.x.max(n.y)];
    let directions = n.x + n.u + n.w;
    for begin in (0..directions.max(1)).step_by(DIRECTIONS) {
        let group = begin..(begin + DIRECTIONS).min(directions);
        let each = [(0, n.x, 0), (inputs, n.u, n.x), (channels, n.w, n.x + n.u)];
        for (start, width, first) in each {
            for (i, dual) in point[start..][..packs * width].iter_mut().enumerate() {
                let direction = first + i % width;
                dual.slope = zero.slope;
                if group.contains(&direction) {
                    dual.slope[direction - begin] = F64x8::constant(1.0);
                }
            }
        }
        let (x, rest) = point.split_at(inputs);
        let (u, w) = rest.split_at(channels - inputs);
        let block = Block { sizes: n, packs, theta: &theta, derived: &derived, x, u, w, time };
        for ask in [Ask::Derivative, Ask::Output] {
            let (width, height) = (place.width(ask), n.answer(ask));
            let answers = &mut answers[..packs * height];
            of.answer(ask, D::call(&block, answers));
            let first = rows.skip + place.first(ask) - n.derived;
            for (at, dual) in answers.iter().enumerate() {
                let start = at / height * rows.stride + first + at % height * width;
                let row = &mut out[start..][..width];
                row[0] = dual.value;
                for (direction, &slope) in group.clone().zip(&dual.slope) {
                    if let Some(entry) = row.get_mut(1 + direction) {
                        *entry = slope;
                    }
                }
            }
        }
    }
    // value at the point = constant + slopes times the point
    for out in out.chunks_exact_mut(rows.stride) {
        let table = &mut out[rows.skip..][..place.count()];
        let (states, outputs) = table.split_at_mut(n.x * place.width(Ask::Derivative));
        for (rows, ask) in [(states, Ask::Derivative), (outputs, Ask::Output)] {
            for row in rows.chunks_exact_mut(place.width(ask)) {
                for (i, &at) in x.iter().chain(u).enumerate() {
                    let part = row[1 + i] * at;
                    row[0] -= part;
                }
            }
        }
    }
}
