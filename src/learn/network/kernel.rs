//! The two loops that take most of the time of learning.

use super::pack::{Line, Pack, Precision, Row, per_pack};

/// A matrix and a bias, arranged so that four outputs are computed together.
#[derive(Debug, Clone)]
pub(crate) struct Tiles<E> {
    outputs: usize,
    inputs: usize,
    /// Four rows interleaved: for each tile and input, four weights.
    weights: Vec<[E; 4]>,
    bias: Vec<[E; 4]>,
}

impl<E: Precision> Tiles<E> {
    /// Zeros.
    pub fn new(outputs: usize, inputs: usize) -> Self {
        let tiles = outputs.div_ceil(4);
        let zero = [E::of(0.0); 4];
        Self { outputs, inputs, weights: vec![zero; tiles * inputs], bias: vec![zero; tiles] }
    }

    /// Fills in the weight of output `o` and input `j`, and the bias of output `o`.
    pub fn fill(&mut self, weight: impl Fn(usize, usize) -> f64, bias: impl Fn(usize) -> f64) {
        for o in 0..self.outputs {
            self.bias[o / 4][o % 4] = E::of(bias(o));
            for j in 0..self.inputs {
                self.weights[o / 4 * self.inputs + j][o % 4] = E::of(weight(o, j));
            }
        }
    }
}

/// What [`affine`] makes of W x + b.
pub(crate) mod mode {
    /// out = W x + b
    pub const SET: u8 = 0;
    /// out += W x
    pub const ADD: u8 = 1;
    /// out = (W x) (1 - h^2), where h = tanh(..) is handed in
    pub const SLOPE: u8 = 2;
}

per_pack! {
    /// W x + b for the first `out.len()` outputs, one block of samples; see [`mode`].
    pub(crate) fn affine<E, P, const MODE: u8>(
        tiles: &Tiles<E>, x: &[Row<E>], h: &[Row<E>], out: &mut [Row<E>],
    ) {
        let x = &x[..tiles.inputs];
        for (tile, out) in out.chunks_mut(4).enumerate() {
            let h = if MODE == mode::SLOPE { &h[tile * 4..][..out.len()] } else { h };
            let weights = &tiles.weights[tile * tiles.inputs..][..tiles.inputs];
            let mut at = 0;
            while at < E::BLOCK {
                // SIDE is 4, 2 or 1; the length of an array has to be known here
                match P::SIDE {
                    4 => strip::<P, 4, MODE>(weights, &tiles.bias[tile], x, h, out, at),
                    2 => strip::<P, 2, MODE>(weights, &tiles.bias[tile], x, h, out, at),
                    _ => strip::<P, 1, MODE>(weights, &tiles.bias[tile], x, h, out, at),
                }
                at += P::SIDE * P::N;
            }
        }
    }
}

/// Four outputs for `K` packs of samples from lane `at` on.
#[inline(always)]
fn strip<P: Pack, const K: usize, const MODE: u8>(
    weights: &[[P::Number; 4]],
    bias: &[P::Number; 4],
    x: &[Row<P::Number>],
    h: &[Row<P::Number>],
    out: &mut [Row<P::Number>],
    at: usize,
) {
    debug_assert!(at + K * P::N <= P::Number::BLOCK);
    let mut sum = [[P::constant(0.0); K]; 4];
    for i in 0..4 {
        for k in 0..K {
            sum[i][k] = match MODE {
                // SAFETY: here and below, at + K N <= BLOCK, the length of a row
                mode::ADD if i < out.len() => unsafe { P::load(out[i].ptr().add(at + k * P::N)) },
                mode::SET => P::splat(bias[i]),
                _ => P::constant(0.0),
            };
        }
    }
    // two at a time: half the counting
    let (pairs, last) = x.as_chunks::<2>();
    let (weight_pairs, last_weights) = weights.as_chunks::<2>();
    for (x, weights) in pairs.iter().zip(weight_pairs) {
        more::<P, K>(&mut sum, &x[0], &weights[0], at);
        more::<P, K>(&mut sum, &x[1], &weights[1], at);
    }
    for (x, weights) in last.iter().zip(last_weights) {
        more::<P, K>(&mut sum, x, weights, at);
    }
    for (i, out) in out.iter_mut().enumerate() {
        let Some(sum) = sum.get(i) else { break };
        for (k, &sum) in sum.iter().enumerate() {
            let lane = at + k * P::N;
            let result = match MODE {
                mode::SLOPE => {
                    // SAFETY: at + N <= BLOCK, the length of a row.
                    let h = unsafe { P::load(h[i].ptr().add(lane)) };
                    sum.mul(h.fnma(h, P::constant(1.0)))
                }
                _ => sum,
            };
            // SAFETY: at + N <= BLOCK, the length of a row.
            unsafe { result.store(out.mut_ptr().add(lane)) };
        }
    }
}

/// Adds one input's share.
#[inline(always)]
fn more<P: Pack, const K: usize>(
    sum: &mut [[P; K]; 4],
    x: &Row<P::Number>,
    weights: &[P::Number; 4],
    at: usize,
) {
    let mut value = [P::constant(0.0); K];
    for (k, value) in value.iter_mut().enumerate() {
        // SAFETY: at + K N <= BLOCK, the length of a row
        *value = unsafe { P::load(x.ptr().add(at + k * P::N)) };
    }
    for i in 0..4 {
        let weight = P::splat(weights[i]);
        for k in 0..K {
            sum[i][k] = value[k].fma(weight, sum[i][k]);
        }
    }
}

/// The same rows at several instants: row `i` of instant `t` is `rows[at + t * stride + i]`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Instants<'a, E: Precision> {
    /// All rows.
    pub rows: &'a [Row<E>],
    /// First row of the first instant.
    pub at: usize,
    /// Rows from one instant to the next.
    pub stride: usize,
}

impl<'a, E: Precision> Instants<'a, E> {
    /// Rows of one instant alone.
    pub fn one(rows: &'a [Row<E>]) -> Self {
        Self { rows, at: 0, stride: 0 }
    }

    #[inline(always)]
    fn row(&self, instant: usize, i: usize) -> &'a Row<E> {
        &self.rows[self.at + instant * self.stride + i]
    }

    /// The same instants, `by` rows further down.
    pub fn below(self, by: usize) -> Self {
        Self { at: self.at + by, ..self }
    }
}

per_pack! {
    /// Adds to the gradient of W (and b) the sum over instants and lanes of d_o x_j
    /// (and d_o), partial sums side by side in a line per weight.
    pub(crate) fn outer<E, P>(
        outputs: usize, inputs: usize, steps: usize, d: Instants<'_, E>, x: Instants<'_, E>,
        weights: &mut [Line<E>], bias: Option<&mut [Line<E>]>,
    ) {
        let whole = inputs - inputs % P::TILE;
        let mut bias = bias;
        let mut o = 0;
        while o < outputs {
            let mut j = 0;
            while j < whole {
                match P::TILE {
                    4 => tile::<P, 4>(o, j, outputs, inputs, steps, d, x, weights, None),
                    3 => tile::<P, 3>(o, j, outputs, inputs, steps, d, x, weights, None),
                    2 => tile::<P, 2>(o, j, outputs, inputs, steps, d, x, weights, None),
                    _ => tile::<P, 1>(o, j, outputs, inputs, steps, d, x, weights, None),
                }
                j += P::TILE;
            }
            let bias = bias.as_deref_mut();
            match inputs - whole {
                3 => tile::<P, 3>(o, j, outputs, inputs, steps, d, x, weights, bias),
                2 => tile::<P, 2>(o, j, outputs, inputs, steps, d, x, weights, bias),
                1 => tile::<P, 1>(o, j, outputs, inputs, steps, d, x, weights, bias),
                _ if bias.is_some() => tile::<P, 0>(o, j, outputs, inputs, steps, d, x, weights, bias),
                _ => {}
            }
            o += 4;
        }
    }
}

/// Four outputs and `J` inputs.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
fn tile<P: Pack, const J: usize>(
    o: usize,
    j: usize,
    outputs: usize,
    inputs: usize,
    steps: usize,
    d: Instants<'_, P::Number>,
    x: Instants<'_, P::Number>,
    weights: &mut [Line<P::Number>],
    bias: Option<&mut [Line<P::Number>]>,
) {
    let mut sum = [[P::constant(0.0); J]; 4];
    let mut sum_d = [P::constant(0.0); 4];
    // a tile that reaches beyond the last output repeats it and drops what comes out
    let row = |i: usize| (o + i).min(outputs - 1);
    let with_bias = bias.is_some();
    for t in 0..steps {
        let d = [d.row(t, row(0)), d.row(t, row(1)), d.row(t, row(2)), d.row(t, row(3))];
        let mut from = [d[0]; J];
        for (i, from) in from.iter_mut().enumerate() {
            *from = x.row(t, j + i);
        }
        let mut at = 0;
        while at < P::Number::BLOCK {
            let mut value = [P::constant(0.0); J];
            for i in 0..J {
                // SAFETY: here and below, at + N <= BLOCK, the length of a row
                value[i] = unsafe { P::load(from[i].ptr().add(at)) };
            }
            for q in 0..4 {
                // SAFETY: at + N <= BLOCK, the length of a row.
                let slope = unsafe { P::load(d[q].ptr().add(at)) };
                for i in 0..J {
                    sum[q][i] = slope.fma(value[i], sum[q][i]);
                }
                if with_bias {
                    sum_d[q] = sum_d[q].add(slope);
                }
            }
            at += P::N;
        }
    }
    for q in 0..(outputs - o).min(4) {
        for i in 0..J {
            add_to::<P>(&mut weights[(o + q) * inputs + j + i], sum[q][i]);
        }
    }
    if let Some(bias) = bias {
        for q in 0..(outputs - o).min(4) {
            add_to::<P>(&mut bias[o + q], sum_d[q]);
        }
    }
}

/// Adds to a line of partial sums.
#[inline(always)]
pub(super) fn add_to<P: Pack>(line: &mut Line<P::Number>, sum: P) {
    let at = line.mut_ptr();
    // SAFETY: no pack is longer than a line
    unsafe { P::load(at).add(sum).store(at) };
}
