//! Single samples that stand alone: outliers of the instrument, not of the machine.

use crate::evidence::{Seen, VarianceFunction};
use crate::fit::problem::Problem;
use crate::statistics::median;

/// Deviations beyond this many robust standard deviations are spikes.
const BEYOND: f64 = 6.0;

impl Problem<'_> {
    /// Gives weight 0 to samples that lie far off, for the noise that is usual at what the model says
    /// there, and whose neighbours do not follow; what was flagged before is judged anew.
    pub fn flag_spikes(&mut self, y: &[Vec<f64>]) {
        let time: Vec<f64> = (0..self.len()).map(|k| k as f64).collect();
        for o in 0..self.y.len() {
            let known = self.known[o].clone();
            let off = |k: usize| if known[k] { self.y[o][k] - y[o][k] } else { 0.0 };
            let mut r: Vec<f64> = (0..self.len()).map(off).collect();
            let seen = Seen { yhat: &y[o], time: &time, residual: &r, white: &r };
            if let Some(variance) = VarianceFunction::of(seen) {
                let at = y[o].iter().zip(&time);
                r.iter_mut().zip(at).for_each(|(r, (y, t))| *r /= variance.deviation(*y, *t));
            }
            for (k, spike) in spikes(&r, &known).into_iter().enumerate() {
                self.weight[o][k] = f64::from(u8::from(known[k] && !spike));
            }
        }
    }

    /// Samples flagged at present, per output.
    pub fn spikes(&self) -> Vec<Vec<usize>> {
        let flagged = |(weight, known): (&Vec<f64>, &Vec<bool>)| {
            (0..self.len()).filter(|&k| known[k] && weight[k] == 0.0).collect()
        };
        self.weight.iter().zip(&self.known).map(flagged).collect()
    }
}

/// Which of the residuals are spikes: far from the median, and far from the mean of their
/// neighbours, each by its own robust scale (1.4826 times the median magnitude).
pub(crate) fn spikes(r: &[f64], known: &[bool]) -> Vec<bool> {
    let values: Vec<f64> = r.iter().zip(known).filter(|(_, k)| **k).map(|(r, _)| *r).collect();
    if values.len() < 16 {
        return vec![false; r.len()];
    }
    let centre = median(&values);
    let far: Vec<f64> = r.iter().map(|v| (v - centre).abs()).collect();
    let single: Vec<f64> = (0..r.len())
        .map(|k| {
            let neighbours: Vec<f64> = [k.checked_sub(1), Some(k + 1)]
                .into_iter()
                .flatten()
                .filter(|&j| j < r.len() && known[j])
                .map(|j| r[j])
                .collect();
            let around = crate::statistics::mean(&neighbours);
            if neighbours.is_empty() { far[k] } else { (r[k] - around).abs() }
        })
        .collect();
    let of_known = |x: &[f64]| {
        let kept: Vec<f64> = x.iter().zip(known).filter(|(_, k)| **k).map(|(v, _)| *v).collect();
        1.4826 * median(&kept)
    };
    let (scale_far, scale_single) = (of_known(&far), of_known(&single));
    (0..r.len())
        .map(|k| known[k] && far[k] > BEYOND * scale_far && single[k] > BEYOND * scale_single)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_spike_in_a_smooth_residual() {
        let mut r: Vec<f64> = (0..500).map(|k| (k as f64 * 0.7).sin()).collect();
        r[200] += 30.0;
        let found = spikes(&r, &[true; 500]);
        assert_eq!(found.iter().position(|&s| s), Some(200));
        assert_eq!(found.iter().filter(|&&s| s).count(), 1);
    }
}
