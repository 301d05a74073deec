//! How far simulations are from what was measured, and which of two is nearer.

use std::ops::Range;

use crate::fit::problem::{Part, Problem};
use crate::statistics::{mixture, rms};

impl Problem<'_> {
    /// Sets the outputs' scales to what this simulation leaves of each.
    pub fn rescale(&mut self, yhat: &[Vec<f64>]) {
        if self.y.len() < 2 {
            return;
        }
        for o in 0..self.y.len() {
            let off: Vec<f64> = self.y[o].iter().zip(&yhat[o]).map(|(a, b)| a - b).collect();
            let r = self.counted(o, &off, Part::All);
            let left = rms(&r);
            if left > 0.0 && left.is_finite() {
                self.scale[o] = left;
            }
        }
    }

    /// Mean square of the residual on a part, in units of the scales.
    pub fn mean_square(&self, yhat: &[Vec<f64>], part: Part) -> f64 {
        rms(&self.residual(yhat, part)).powi(2)
    }

    /// Samples that count in a part.
    pub fn samples(&self, part: Part) -> impl Iterator<Item = usize> + '_ {
        let (a, b): (&[Range<usize>], &[Range<usize>]) = match part {
            Part::Fit => (&self.fit, &[]),
            Part::Choose => (&self.choose, &[]),
            Part::All => (&self.fit, &self.choose),
        };
        a.iter().chain(b).cloned().flatten()
    }

    /// In which segment each sample of a part is.
    pub fn segments_of(&self, part: Part) -> impl Iterator<Item = usize> + '_ {
        let segments = &self.drive.segments;
        self.samples(part).map(|k| segments.partition_point(|segment| segment.end <= k))
    }

    /// The samples that count in a part, as stretches without a break, in order.
    pub fn stretches(&self, part: Part) -> Vec<Range<usize>> {
        let mut samples: Vec<usize> = self.samples(part).collect();
        samples.sort_unstable();
        let mut all: Vec<Range<usize>> = vec![];
        for k in samples {
            match all.last_mut() {
                Some(last)
                    if last.end == k && !self.drive.segments.iter().any(|s| s.start == k) =>
                {
                    last.end += 1;
                }
                _ => all.push(k..k + 1),
            }
        }
        all
    }

    /// Weighted residuals y - yhat over a part, outputs one after the other.
    pub fn residual(&self, yhat: &[Vec<f64>], part: Part) -> Vec<f64> {
        let mut r = vec![];
        for o in 0..self.y.len() {
            let over = 1.0 / self.scale[o];
            let (y, yhat, weight) = (&self.y[o], &yhat[o], &self.weight[o]);
            r.extend(
                self.samples(part).map(
                    |k| {
                        if weight[k] > 0.0 { (y[k] - yhat[k]) * over } else { 0.0 }
                    },
                ),
            );
        }
        r
    }

    /// One output's values over a part, where they count.
    pub fn counted(&self, o: usize, values: &[f64], part: Part) -> Vec<f64> {
        self.samples(part).filter(|&k| self.weight[o][k] > 0.0).map(|k| values[k]).collect()
    }

    /// Products of two stacked series, added over outputs: one value per sample.
    pub fn per_sample(&self, a: &[f64], b: &[f64]) -> Vec<f64> {
        let n = a.len() / self.y.len().max(1);
        let mut q: Vec<f64> = a[..n].iter().zip(&b[..n]).map(|(a, b)| a * b).collect();
        for o in 1..self.y.len() {
            for (k, q) in q.iter_mut().enumerate() {
                *q += a[o * n + k] * b[o * n + k];
            }
        }
        q
    }

    /// Score that b is better than a on a part.
    pub fn better(&self, a: &[Vec<f64>], b: &[Vec<f64>], part: Part) -> f64 {
        self.between(a, b, part).map_or(0.0, |(ff, fr)| mixture(&ff, &fr))
    }

    /// What b changes of a, squared and times the residual of a; `None` where they are the same.
    fn between(&self, a: &[Vec<f64>], b: &[Vec<f64>], part: Part) -> Option<(Vec<f64>, Vec<f64>)> {
        let ra = self.residual(a, part);
        let rb = self.residual(b, part);
        let f: Vec<f64> = ra.iter().zip(&rb).map(|(a, b)| a - b).collect();
        let ff = self.per_sample(&f, &f);
        let same = ff.iter().sum::<f64>() < 1e-24 * ra.iter().map(|r| r * r).sum::<f64>();
        (!same).then(|| (ff, self.per_sample(&f, &ra)))
    }
}
