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
            let mut r = self.off(o, &y[o]);
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

    /// Of some rows of an output those that stand alone in what `y` leaves: what a model accounts for was no
    /// outlier, whatever an earlier one said. A free run may drift, so only neighbours are asked.
    pub fn still_isolated(&self, o: usize, y: &[f64], rows: &[usize]) -> Vec<usize> {
        if rows.is_empty() {
            return vec![];
        }
        let (known, r) = (&self.known[o], self.off(o, y));
        let far: Vec<f64> = r.iter().map(|v| v.abs()).collect();
        let apart = in_units(&apart(&r, &far, known), known);
        rows.iter().copied().filter(|&k| apart[k] > BEYOND).collect()
    }

    /// What `y` leaves of an output; 0 where nothing was measured.
    fn off(&self, o: usize, y: &[f64]) -> Vec<f64> {
        let known = self.known[o].iter();
        let each = known.zip(&self.y[o]).zip(y);
        each.map(|((known, measured), y)| if *known { measured - y } else { 0.0 }).collect()
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
    let (far, single) = (in_units(&far, known), in_units(&apart(r, &far, known), known));
    (0..r.len()).map(|k| known[k] && far[k] > BEYOND && single[k] > BEYOND).collect()
}

/// Distances of residuals from the mean of their neighbours; `far` where there are none.
fn apart(r: &[f64], far: &[f64], known: &[bool]) -> Vec<f64> {
    (0..r.len())
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
        .collect()
}

/// Magnitudes in units of their robust scale.
fn in_units(x: &[f64], known: &[bool]) -> Vec<f64> {
    let kept: Vec<f64> = x.iter().zip(known).filter(|(_, k)| **k).map(|(v, _)| *v).collect();
    let scale = 1.4826 * median(&kept);
    x.iter().map(|v| if *v > 0.0 { v / scale } else { 0.0 }).collect()
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
