//! A linearisation frozen along a path: what a linear replay of the filter needs.
//!
//! About the predicted states xm and the filtered ones xp of some run,
//! x[k+1] = xm[k+1] + A (x - xp) + G (m + w - force), y = h(xm) + C (x - xm) + d + v.
//! A replay with other variances needs no model: 4000 samples take milliseconds.
//! Source: Kristensen, Madsen and Jorgensen, Automatica 40, 2004, section 3.

use std::ops::Range;

use super::earlier::Earlier;

/// A frozen linearisation; tables are sample by sample, matrices row by row.
#[derive(Debug, Clone, Default)]
pub(crate) struct Path {
    /// States, forces (own channels and inputs), outputs, samples.
    pub n: usize,
    pub forces: usize,
    pub outputs: usize,
    pub len: usize,
    pub segments: Vec<Range<usize>>,
    /// Next states along states, and along forces.
    pub a: Vec<f64>,
    pub g: Vec<f64>,
    /// Next states along what sensors add to the outputs, of a law that reads these back; else empty.
    pub read: Vec<f64>,
    /// Outputs along states, and along forces where these enter rates that an output reads.
    pub c: Vec<f64>,
    pub d: Vec<f64>,
    /// Measured less predicted, without wander; not a number where not measured or left out.
    pub e: Vec<f64>,
    /// Filtered less predicted states.
    pub jump: Vec<f64>,
    /// Forces of the augmented state that the path was run with.
    pub force: Vec<f64>,
    /// Filtered states.
    pub states: Vec<f64>,
    /// Predicted outputs, without wander.
    pub predicted: Vec<f64>,
    /// Predicted outputs before the laws on their paths, where sources are asked for.
    pub unread: Vec<f64>,
    /// Variances of the states at the start of a segment.
    pub p0: Vec<f64>,
    /// What is not known in the first samples of a segment.
    pub earlier: Earlier,
    /// Next states and outputs along parameters, where asked for.
    pub theta: Vec<f64>,
    pub c_theta: Vec<f64>,
    /// Table of sources at the filtered states, where asked for.
    pub seen: Vec<f64>,
    /// Whether the linearisation at a sample is that of the sample before; empty: unknown.
    pub as_before: Vec<bool>,
}

impl Path {
    pub fn a(&self, k: usize) -> &[f64] {
        &self.a[k * self.n * self.n..][..self.n * self.n]
    }

    pub fn g(&self, k: usize) -> &[f64] {
        &self.g[k * self.n * self.forces..][..self.n * self.forces]
    }

    /// Next state `i` along what the sensor of output `o` adds: 0 where that is not fed back.
    pub fn read(&self, k: usize, i: usize, o: usize) -> f64 {
        self.read.get((k * self.n + i) * self.outputs + o).copied().unwrap_or(0.0)
    }

    /// Whether the linearisation at `k` is that at the sample before.
    pub fn is_as_before(&self, k: usize) -> bool {
        self.as_before.get(k).is_some_and(|same| *same)
    }

    /// Notes where the linearisation does not change, as that of a linear model never does.
    pub fn mark_equal(&mut self) {
        let equal = |of: &[f64], size: usize, k: usize| {
            of[(k - 1) * size..][..size] == of[k * size..][..size]
        };
        let (n, nf, ny) = (self.n, self.forces, self.outputs);
        let same = |k: usize| {
            k > 0
                && equal(&self.a, n * n, k)
                && equal(&self.g, n * nf, k)
                && equal(&self.c, ny * n, k)
                && (self.read.is_empty() || equal(&self.read, ny * n, k))
                && (self.d.is_empty() || equal(&self.d, ny * nf, k))
        };
        self.as_before = (0..self.len).map(same).collect();
    }

    /// Rows of output `o`, along states and along forces; the latter empty where no output reads these.
    pub fn rows(&self, k: usize, o: usize) -> (&[f64], &[f64]) {
        let d = match self.has_direct() {
            true => &self.d[(k * self.outputs + o) * self.forces..][..self.forces],
            false => &[][..],
        };
        (self.c(k, o), d)
    }

    /// Whether an output reads what enters the plant.
    pub fn has_direct(&self) -> bool {
        !self.d.is_empty()
    }

    /// Row of output `o`.
    pub fn c(&self, k: usize, o: usize) -> &[f64] {
        &self.c[(k * self.outputs + o) * self.n..][..self.n]
    }

    /// The size of a force that moves the states as much from sample to sample as they move:
    /// rms(g' dx) / mean(g' g), per channel and input.
    pub fn force_scales(&self) -> Vec<f64> {
        let (n, nf) = (self.n, self.forces);
        (0..nf)
            .map(|c| {
                let (mut along, mut size, mut count) = (0.0, 0.0, 0);
                for segment in &self.segments {
                    for k in segment.start..segment.end.saturating_sub(1) {
                        let g = self.g(k);
                        let (now, next) = (&self.states[k * n..][..n], &self.states[(k + 1) * n..]);
                        let dot: f64 = (0..n).map(|i| g[i * nf + c] * (next[i] - now[i])).sum();
                        along += dot * dot;
                        size += (0..n).map(|i| g[i * nf + c].powi(2)).sum::<f64>();
                        count += 1;
                    }
                }
                let count = count.max(1) as f64;
                let scale = (along / count).sqrt() / (size / count).max(f64::MIN_POSITIVE);
                if scale.is_finite() && scale > 0.0 { scale } else { 0.0 }
            })
            .collect()
    }
}
