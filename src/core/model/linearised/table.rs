//! The numbers of a linearisation, at the parameters of every lane.

use super::super::block::{Ask, Block, DIRECTIONS, Dual64};
use super::super::lane_number::LaneNumber;
use super::super::{Sizes, StateSpaceModel};
use crate::per_lanes;
use crate::real::{F64x8, Real};

type D = Dual64;

/// Where the numbers stand behind those that the inner law derives: for every state its
/// constant, then the slopes along x, u, w and, of a law that reads its outputs back, along what
/// sensors add to these; for every output its constant, then those along x, u.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    /// Sizes of the inner law.
    pub inner: Sizes,
    /// Outputs that the inner law reads back.
    pub read: usize,
}

impl Place {
    /// Where the numbers of a law stand.
    pub fn of(law: &dyn StateSpaceModel) -> Self {
        let inner = Sizes::of(&law.signals());
        Self { inner, read: if law.fed_back() { inner.y } else { 0 } }
    }

    /// How many numbers a row has.
    fn width(self, ask: Ask) -> usize {
        let n = self.inner;
        1 + n.x + n.u + if ask == Ask::Derivative { n.w + self.read } else { 0 }
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
    /// The answer of the linear law: constant + slopes times (x, u, w, what sensors add).
    fn rows[; R](
        block: &Block<'_, R>,
        added: &[R],
        place: (usize, usize),
        out: &mut [R],
    ) {
        let (n, (first, width)) = (block.sizes, place);
        for (pack, out) in out.chunks_exact_mut(out.len() / block.packs).enumerate() {
            let table = &block.derived[pack * n.derived..][..n.derived][first..];
            let (x, u) = (&block.x[pack * n.x..][..n.x], &block.u[pack * n.u..][..n.u]);
            let w = &block.w[pack * n.w..][..n.w];
            let added = added.get(pack * n.y..(pack + 1) * n.y).unwrap_or(&[]);
            for (out, row) in out.iter_mut().zip(table.chunks_exact(width)) {
                let mut sum = row[0];
                let mut slopes = &row[1..];
                for values in [x, u, w, added] {
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
    if out.is_empty() {
        return;
    }
    let mut added = block.read.to_vec();
    if !added.is_empty() {
        let mut y = added.clone();
        answer(place, Ask::Output, &Block { read: &[], ..*block }, &mut y);
        added.iter_mut().zip(y).for_each(|(read, y)| *read -= y);
    }
    rows(block, &added, (place.first(ask), place.width(ask)), out);
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
    let (inputs, channels) = (packs * n.x, packs * (n.x + n.u));
    let end = packs * (n.x + n.u + n.w);
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
        let block =
            Block { sizes: n, packs, theta: &theta, derived: &[], x, u, w, read: &[], time };
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
        let block =
            Block { sizes: n, packs, theta: &theta, derived: &derived, x, u, w, read: &[], time };
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
    if place.read > 0 {
        point.iter_mut().for_each(|dual| dual.slope = zero.slope);
        let (x, rest) = point.split_at(inputs);
        let (u, w) = rest.split_at(channels - inputs);
        let block =
            Block { sizes: n, packs, theta: &theta, derived: &derived, x, u, w, read: &[], time };
        along_read(of, place, block, (rows, out));
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

/// Fills in the slopes of the next states along what sensors add to the outputs that are read back.
fn along_read(
    of: &dyn StateSpaceModel,
    place: Place,
    block: Block<'_, D>,
    (rows, out): (Rows, &mut [F64x8]),
) {
    let (n, zero) = (place.inner, D::constant(0.0));
    let mut read = vec![zero; block.packs * n.y];
    of.answer(Ask::Output, D::call(&block, &mut read));
    let mut answers = vec![zero; block.packs * n.x];
    let (width, first) = (place.width(Ask::Derivative), rows.skip + 1 + n.x + n.u + n.w);
    for begin in (0..place.read).step_by(DIRECTIONS) {
        for (i, dual) in read.iter_mut().enumerate() {
            dual.slope = zero.slope;
            if let Some(slope) = (i % n.y).checked_sub(begin).and_then(|d| dual.slope.get_mut(d)) {
                *slope = F64x8::constant(1.0);
            }
        }
        of.answer(Ask::Derivative, D::call(&Block { read: &read, ..block }, &mut answers));
        for (at, dual) in answers.iter().enumerate() {
            let row = at / n.x * rows.stride + at % n.x * width + first;
            let to = out[row..][..place.read][begin..].iter_mut();
            to.zip(&dual.slope).for_each(|(to, slope)| *to = *slope);
        }
    }
}
