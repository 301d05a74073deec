//! A network on one block of samples: forward, and back along the chain rule.

use super::kernel::{Instants, Tiles, affine, mode, outer};
use super::pack::{Line, Precision, Row};
use super::rows::tanh;
use super::{Layout, ResNet};

/// Offsets and scales around a network: y = offset_y + scale_y net((x - offset_x) / scale_x).
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Frame {
    /// Offset and scale of each input.
    pub inputs: Vec<(f64, f64)>,
    /// Offset and scale of each output.
    pub outputs: Vec<(f64, f64)>,
}

impl Frame {
    /// Offsets 0 and scales 1.
    pub fn plain(layout: &Layout) -> Self {
        Self {
            inputs: vec![(0.0, 1.0); layout.inputs()],
            outputs: vec![(0.0, 1.0); layout.outputs()],
        }
    }
}

/// A network's weights arranged for the kernels, the frame folded into them.
#[derive(Debug, Clone)]
pub(crate) struct Arranged<E: Precision> {
    layout: Layout,
    frame: Frame,
    hidden: Vec<Tiles<E>>,
    output: Tiles<E>,
    linear: Tiles<E>,
    /// Transposed: from a layer's result back to what it was made of.
    hidden_back: Vec<Tiles<E>>,
    output_back: Tiles<E>,
    linear_back: Tiles<E>,
}

impl<E: Precision> Arranged<E> {
    /// All weights zero until [`Self::set`] is called.
    pub fn new(layout: &Layout, frame: Frame) -> Self {
        let (layers, output, linear) = (layout.layers(), layout.output_map(), layout.linear_map());
        Self {
            frame,
            hidden: layers.iter().map(|l| Tiles::new(l.outputs, l.inputs)).collect(),
            hidden_back: layers.iter().map(|l| Tiles::new(l.inputs, l.outputs)).collect(),
            output: Tiles::new(output.outputs, output.inputs),
            output_back: Tiles::new(output.inputs, output.outputs),
            linear: Tiles::new(linear.outputs, linear.inputs),
            linear_back: Tiles::new(linear.inputs, linear.outputs),
            layout: layout.clone(),
        }
    }

    /// The same with the weights of a network.
    pub fn of(net: &ResNet, frame: Frame) -> Self {
        let mut arranged = Self::new(net.layout(), frame);
        arranged.set(net.weights());
        arranged
    }

    /// Sizes.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Takes over a vector of weights in the order of [`Layout`].
    pub fn set(&mut self, w: &[f64]) {
        let (inputs, outputs) = (&self.frame.inputs, &self.frame.outputs);
        for (l, layer) in self.layout.layers().into_iter().enumerate() {
            let bias = layer.bias.unwrap_or(0);
            let raw = |o: usize, j: usize| w[layer.weights + o * layer.inputs + j];
            if l == 0 {
                let weight = |o: usize, j: usize| raw(o, j) / inputs[j].1;
                let shift = |o: usize| {
                    w[bias + o] - (0..layer.inputs).map(|j| weight(o, j) * inputs[j].0).sum::<f64>()
                };
                self.hidden[l].fill(weight, shift);
                self.hidden_back[l].fill(|j, o| weight(o, j), |_| 0.0);
            } else {
                self.hidden[l].fill(raw, |o| w[bias + o]);
                self.hidden_back[l].fill(|j, o| raw(o, j), |_| 0.0);
            }
        }
        let (output, linear) = (self.layout.output_map(), self.layout.linear_map());
        let bias = self.layout.output_bias().start;
        let raw = |o: usize, j: usize| w[output.weights + o * output.inputs + j] * outputs[o].1;
        let slope = |o: usize, j: usize| {
            w[linear.weights + o * linear.inputs + j] * outputs[o].1 / inputs[j].1
        };
        let shift = |o: usize| {
            let linear: f64 = (0..linear.inputs).map(|j| slope(o, j) * inputs[j].0).sum();
            outputs[o].0 + w[bias + o] * outputs[o].1 - linear
        };
        self.output.fill(raw, shift);
        self.output_back.fill(|j, o| raw(o, j), |_| 0.0);
        self.linear.fill(slope, |_| 0.0);
        self.linear_back.fill(|j, o| slope(o, j), |_| 0.0);
    }

    /// y = net(x), with the hidden units' values in `h` (one row per unit).
    pub fn forward(&self, x: &[Row<E>], h: &mut [Row<E>], y: &mut [Row<E>]) {
        let (mut before, mut rest) = (x, h);
        for (layer, &units) in self.hidden.iter().zip(self.layout.hidden()) {
            let (own, after) = rest.split_at_mut(units);
            affine::<E, { mode::SET }>(layer, before, &[], own);
            tanh(own);
            (before, rest) = (own, after);
        }
        let last = if self.hidden.is_empty() { &[] } else { before };
        affine::<E, { mode::SET }>(&self.output, last, &[], y);
        affine::<E, { mode::ADD }>(&self.linear, x, &[], y);
    }

    /// From dV/dy back to dV/dx for the first `gx.len()` inputs; `d` takes dV/d(argument of
    /// tanh), one row per unit.
    pub fn back(&self, h: &[Row<E>], gy: &[Row<E>], d: &mut [Row<E>], gx: &mut [Row<E>]) {
        let (mut after, mut rest, mut values) = (gy, d, h);
        let backward = self.hidden_back.iter().skip(1).chain([&self.output_back]);
        for (layer, &units) in backward.rev().zip(self.layout.hidden().iter().rev()) {
            let (earlier, own) = rest.split_at_mut(rest.len() - units);
            let (values_before, value) = values.split_at(values.len() - units);
            affine::<E, { mode::SLOPE }>(layer, after, value, own);
            (after, rest, values) = (own, earlier, values_before);
        }
        if gx.is_empty() {
            return;
        }
        affine::<E, { mode::SET }>(&self.linear_back, gy, &[], gx);
        if let Some(first) = self.hidden_back.first() {
            affine::<E, { mode::ADD }>(first, after, &[], gx);
        }
    }

    /// Adds the gradient over several instants to `lines` (one per weight). `d` holds at
    /// each instant what [`Self::back`] left, followed by dV/dy.
    pub fn collect(
        &self,
        steps: usize,
        x: Instants<'_, E>,
        h: Instants<'_, E>,
        d: Instants<'_, E>,
        lines: &mut [Line<E>],
    ) {
        let (mut from, mut below) = (x, 0);
        for layer in self.layout.layers() {
            let own = &mut lines[layer.weights..];
            let (weights, rest) = own.split_at_mut(layer.outputs * layer.inputs);
            let d = d.below(below);
            outer(layer.outputs, layer.inputs, steps, d, from, weights, Some(rest));
            from = h.below(below);
            below += layer.outputs;
        }
        let (output, linear) = (self.layout.output_map(), self.layout.linear_map());
        let d = d.below(below);
        let (weights, bias) = lines[output.weights..].split_at_mut(output.outputs * output.inputs);
        outer(output.outputs, output.inputs, steps, d, from, weights, Some(bias));
        outer(linear.outputs, linear.inputs, steps, d, x, &mut lines[linear.weights..], None);
    }

    /// Adds what the lines hold to the gradient by the network's own weights, the frame
    /// taken out again.
    pub fn unfold(&self, lines: &[Line<E>], gradient: &mut [f64]) {
        let sum = |at: usize| lines[at].sum();
        let (inputs, outputs) = (&self.frame.inputs, &self.frame.outputs);
        for (l, layer) in self.layout.layers().into_iter().enumerate() {
            let bias = layer.bias.unwrap_or(0);
            for o in 0..layer.outputs {
                let of_bias = sum(bias + o);
                gradient[bias + o] += of_bias;
                for j in 0..layer.inputs {
                    let at = layer.weights + o * layer.inputs + j;
                    let (offset, scale) = if l == 0 { inputs[j] } else { (0.0, 1.0) };
                    gradient[at] += (sum(at) - of_bias * offset) / scale;
                }
            }
        }
        let (output, linear) = (self.layout.output_map(), self.layout.linear_map());
        let bias = self.layout.output_bias().start;
        for o in 0..output.outputs {
            let (of_bias, scale_y) = (sum(bias + o), outputs[o].1);
            gradient[bias + o] += of_bias * scale_y;
            for j in 0..output.inputs {
                let at = output.weights + o * output.inputs + j;
                gradient[at] += sum(at) * scale_y;
            }
            for j in 0..linear.inputs {
                let at = linear.weights + o * linear.inputs + j;
                let (offset, scale) = inputs[j];
                gradient[at] += (sum(at) - of_bias * offset) / scale * scale_y;
            }
        }
    }
}
