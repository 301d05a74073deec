//! Which samples an encoder sees, and in which order.

use std::ops::Range;

use serde::{Deserialize, Serialize};

/// The samples of outputs and inputs that the state at sample k is estimated from.
///
/// **The order, the same in the whole library:** outputs before inputs; the newest sample
/// on top; within a sample, signals in the order of the model. So the vector is
///
/// ```text
/// [y_{k-1}; y_{k-2}; ..; y_{k-n_a}; u_{k-1}; ..; u_{k-n_b}]
/// ```
///
/// and with the current sample it is `[y_k; y_{k-1}; ..; y_{k-n_a}; u_k; ..; u_{k-n_b}]`,
/// one sample more of each. The paper stacks its matrices so (Hoekstra et al.,
/// eq. `y_k_k+n`), with the current sample; its encoder (eq. `encoder_ann_struct`) sees the
/// past only. That is the default here: scored on y_k, an encoder that sees y_k flatters
/// the first step.
///
/// ```
/// use lacuna::encoder::Window;
///
/// let window = Window { n_a: 2, n_b: 1, current_sample: false };
/// let (y, u) = ([0.0, 1.0, 2.0, 3.0], [10.0, 11.0, 12.0, 13.0]);
/// assert_eq!(window.gather(&[&y], &[&u], &[2, 3]), [1.0, 2.0, 0.0, 1.0, 11.0, 12.0]);
/// //                                    rows: y_{k-1}   y_{k-2}   u_{k-1}; one column per k
/// assert_eq!(window.rows(1, 1), 3);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Window {
    /// Past samples of the outputs.
    pub n_a: usize,
    /// Past samples of the inputs.
    pub n_b: usize,
    /// Whether sample k itself is seen too.
    #[serde(default)]
    pub current_sample: bool,
}

impl Window {
    /// As many past samples of outputs and inputs, without the current one.
    pub fn past(n: usize) -> Self {
        Self { n_a: n, n_b: n, current_sample: false }
    }

    /// The same with the current sample.
    #[must_use]
    pub fn with_current(self) -> Self {
        Self { current_sample: true, ..self }
    }

    /// Samples of each output.
    pub fn outputs(&self) -> usize {
        self.n_a.saturating_add(usize::from(self.current_sample))
    }

    /// Samples of each input.
    pub fn inputs(&self) -> usize {
        self.n_b.saturating_add(usize::from(self.current_sample))
    }

    /// Length of the vector for so many outputs and inputs.
    pub fn rows(&self, n_y: usize, n_u: usize) -> usize {
        self.outputs().saturating_mul(n_y).saturating_add(self.inputs().saturating_mul(n_u))
    }

    /// Samples that have to come before sample k.
    pub fn reach(&self) -> usize {
        self.n_a.max(self.n_b)
    }

    /// How far back a row's sample is, and the signal's number: outputs first, then inputs.
    pub(crate) fn places(&self, n_y: usize, n_u: usize) -> Vec<Place> {
        let newest = usize::from(!self.current_sample);
        let lags = |samples: usize| newest..newest + samples;
        let outputs = lags(self.outputs())
            .flat_map(|lag| (0..n_y).map(move |signal| Place { output: true, lag, signal }));
        let inputs = lags(self.inputs())
            .flat_map(|lag| (0..n_u).map(move |signal| Place { output: false, lag, signal }));
        outputs.chain(inputs).collect()
    }

    /// The vectors of several samples side by side: row by row, one column per entry of `ks`.
    /// `y` and `u` hold one series per output and input.
    ///
    /// # Panics
    ///
    /// Where a sample of `ks` is nearer to the start of a series than [`Window::reach`], or
    /// beyond its end.
    #[track_caller]
    pub fn gather(&self, y: &[&[f64]], u: &[&[f64]], ks: &[usize]) -> Vec<f64> {
        let places = self.places(y.len(), u.len());
        let mut rows = Vec::with_capacity(places.len() * ks.len());
        for place in places {
            let series = if place.output { y[place.signal] } else { u[place.signal] };
            rows.extend(ks.iter().map(|&k| series[k - place.lag]));
        }
        rows
    }

    /// The samples of some segments that have a whole window of finite outputs before them
    /// and at least `ahead` samples from there on, k included.
    pub fn starts(&self, segments: &[Range<usize>], y: &[&[f64]], ahead: usize) -> Vec<usize> {
        let mut starts = vec![];
        for segment in segments {
            // first sample from which all outputs have been finite
            let mut clean = segment.start;
            for k in segment.clone() {
                if k >= clean + self.n_a
                    && k >= segment.start + self.reach()
                    && k + ahead <= segment.end
                {
                    let seen = !self.current_sample || y.iter().all(|y| y[k].is_finite());
                    if seen {
                        starts.push(k);
                    }
                }
                if self.outputs() > 0 && y.iter().any(|y| !y[k].is_finite()) {
                    clean = k + 1;
                }
            }
        }
        starts
    }
}

/// One row of a window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Place {
    pub output: bool,
    pub lag: usize,
    pub signal: usize,
}

#[cfg(test)]
#[allow(clippy::single_range_in_vec_init)] // one segment is one range
mod tests {
    use super::*;

    #[test]
    fn the_newest_sample_is_on_top_and_signals_follow_the_model() {
        let window = Window { n_a: 1, n_b: 2, current_sample: true };
        let y = [[0.0, 1.0, 2.0], [100.0, 101.0, 102.0]];
        let u = [[10.0, 11.0, 12.0]];
        let vector = window.gather(&[&y[0], &y[1]], &[&u[0]], &[2]);
        assert_eq!(vector, [2.0, 102.0, 1.0, 101.0, 12.0, 11.0, 10.0]);
        assert_eq!((window.rows(2, 1), window.reach()), (7, 2));
    }

    #[test]
    fn windows_stay_within_segments_and_off_missing_outputs() {
        let mut y = vec![0.0; 20];
        y[5] = f64::NAN;
        let past = Window::past(2);
        // two samples before each start, three from it on, none of the two missing
        assert_eq!(past.starts(&[0..10, 12..17], &[&y], 3), [2, 3, 4, 5, 14]);
        assert_eq!(past.starts(&[0..10], &[&y], 1), [2, 3, 4, 5, 8, 9]);
        assert_eq!(past.with_current().starts(&[0..10], &[&y], 1), [2, 3, 4, 8, 9]);
        assert!(past.starts(&[0..2], &[&y], 1).is_empty());
    }
}
