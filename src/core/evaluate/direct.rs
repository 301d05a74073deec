//! Direct feedthrough: whether an output at a sample follows the inputs of the same sample, `dh/du != 0` in
//! `y[k] = h(x[k], u[k])`.
//!
//! Where an output does not, a controller that reads it makes the input of a sample follow its noise, and
//! that input tells nothing of what the model leaves of it (Ljung, "System Identification", 2nd ed., section 13.4).

use super::run::Run;
use crate::statistics::deviation;
use crate::system::{Drive, Hold};

/// Samples at which the inputs are changed: a law may read them in some states only.
const AT: [usize; 4] = [1, 8, 32, 63];

impl Run<'_> {
    /// Per output: the sample from which on inputs may tell of what a model leaves of it, the same one (0) where
    /// a change of the inputs there changes it, else the one before (1).
    pub fn first_lags(&self) -> Vec<usize> {
        let outputs = self.plan.sizes.y;
        if self.system.sampling.hold != Hold::Zero {
            return vec![0; outputs];
        }
        let last = |k: usize, by: f64| {
            let of = |u: &Vec<f64>| {
                let mut changed = u[..=k].to_vec();
                changed[k] += by * deviation(u);
                changed
            };
            let inputs = self.drive.inputs.iter().map(of).collect();
            let drive =
                Drive { inputs, segments: std::iter::once(0..k + 1).collect(), clocks: vec![0.0] };
            let lane = self.lane(vec![self.plan.signals.initial()]);
            let track = self.system.run(&self.plan, &drive, &[lane]).swap_remove(0);
            track.y.iter().map(|y| y[k].to_bits()).collect::<Vec<u64>>()
        };
        let both: Vec<[Vec<u64>; 2]> = AT
            .into_iter()
            .filter(|k| *k < self.drive.len())
            .map(|k| [0.0, 1.0].map(|by| last(k, by)))
            .collect();
        let is_direct = |o: usize| both.iter().any(|[same, other]| same[o] != other[o]);
        (0..outputs).map(|o| usize::from(!is_direct(o))).collect()
    }
}
