//! Blocks of an interconnection for one pack of any number that laws are called with.

use crate::model::{Ask, Block as Question, LaneNumber, Law, Sizes};
use crate::per_lanes;

use super::block::{Learned, Pace};
use super::combine;

/// A baseline at one value of its parameters.
pub(super) struct Known<'a, R> {
    pub law: &'a dyn Law,
    pub sizes: Sizes,
    pub theta: &'a [R],
    pub derived: &'a [R],
    /// How far the inputs move until the next sample; empty where they are held.
    pub ramp: &'a [R],
}

impl<R: LaneNumber> Known<'_, R> {
    /// One question, with nothing in the channels but the ramp of a law that finds it there.
    pub fn ask(&self, ask: Ask, x: &[R], u: &[R], time: R, out: &mut [R]) {
        let mut w = vec![R::constant(0.0); self.sizes.w];
        let Self { law, sizes, theta, derived, ramp } = *self;
        if law.ramped() {
            w[..ramp.len()].copy_from_slice(ramp);
        }
        let question = Question { sizes, packs: 1, theta, derived, x, u, w: &w, read: &[], time };
        law.answer(ask, R::call(&question, out));
    }
}

/// Room for the states inside a sample.
pub(super) struct Room<R> {
    x: Vec<R>,
    trial: Vec<R>,
    sum: Vec<R>,
    k: Vec<R>,
}

impl<R: LaneNumber> Room<R> {
    pub fn new(states: usize) -> Self {
        let zeros = || vec![R::constant(0.0); states];
        Self { x: zeros(), trial: zeros(), sum: zeros(), k: zeros() }
    }

    /// f_base: from z = [x; u] at `time` to the states one sample later.
    pub fn next(&mut self, known: &Known<'_, R>, pace: Pace, z: &[R], time: R, end: &mut [R]) {
        let (x, u) = z.split_at(known.sizes.x);
        if pace == Pace::Discrete {
            return known.ask(Ask::Derivative, x, u, time, end);
        }
        self.x.copy_from_slice(x);
        let (h, tableau) = (pace.step(), pace.tableau());
        let mut now_u = u.to_vec();
        for j in 0..pace.substeps() {
            self.sum.copy_from_slice(&self.x);
            self.trial.copy_from_slice(&self.x);
            for (i, stage) in tableau.iter().enumerate() {
                let at = j as f64 + stage.at;
                let share = at / pace.substeps() as f64;
                for ((now, &u), &du) in now_u.iter_mut().zip(u).zip(known.ramp) {
                    *now = u + du * share;
                }
                known.ask(Ask::Derivative, &self.trial, &now_u, time + at * h, &mut self.k);
                let further = tableau.get(i + 1).map_or(0.0, |next| h * next.from_before);
                let (trial, sum) = (&mut self.trial, &mut self.sum);
                combine::stage(trial, sum, &self.x, &self.k, further, h * stage.weight);
            }
            self.x.copy_from_slice(&self.sum);
        }
        end.copy_from_slice(&self.x);
    }
}

per_lanes! {
    /// y += W x, row after row, and then tanh if `bent`.
    fn affine[; R](weights: &[f64], x: &[R], y: &mut [R], bent: bool) {
        let n = x.len();
        for (o, y) in y.iter_mut().enumerate() {
            let mut sum = *y;
            for (weight, x) in weights[o * n..][..n].iter().zip(x) {
                sum += *x * *weight;
            }
            *y = if bent { sum.tanh() } else { sum };
        }
    }
}

/// w = φ(z) with the scales around the network.
pub(super) fn learned<R: LaneNumber>(learned: &Learned, z: &[R], w: &mut [R]) {
    let (layout, weights) = (learned.net.layout(), learned.net.weights());
    let scaled =
        |(z, (offset, scale)): (&R, &(f64, f64))| (*z - R::constant(*offset)) * (1.0 / scale);
    let x: Vec<R> = z.iter().zip(&learned.input_scales).map(scaled).collect();
    let biases = |range: std::ops::Range<usize>| -> Vec<R> {
        weights[range].iter().map(|&bias| R::constant(bias)).collect()
    };
    let mut h = x.clone();
    let mut layer = 0;
    while let Some((rows, bias)) = layout.hidden_layer(layer) {
        let mut next = biases(bias);
        affine(&weights[rows], &h, &mut next, true);
        h = next;
        layer += 1;
    }
    let mut y = biases(layout.output_bias());
    if layer > 0 {
        affine(&weights[layout.output()], &h, &mut y, false);
    }
    affine(&weights[layout.linear()], &x, &mut y, false);
    for ((w, y), (offset, scale)) in w.iter_mut().zip(y).zip(&learned.output_scales) {
        *w = y * *scale + R::constant(*offset);
    }
}
