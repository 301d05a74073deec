//! Direct feedthrough: whether an output at a sample follows the inputs of the same sample, `dh/du != 0` in
//! `y[k] = h(x[k], u[k])`.
//!
//! Where none does, a controller that reads the output makes the input of a sample follow its noise, and
//! that input tells nothing of the model (Ljung, "System Identification", 2nd ed., section 13.4).

use super::run::Run;
use crate::statistics::deviation;
use crate::system::{Drive, Hold};

/// Samples at which the inputs are changed: a law may read them in some states only.
const AT: [usize; 4] = [1, 8, 32, 63];

impl Run<'_> {
    /// The sample from which on inputs may tell of what a model leaves: the same one (0) where a change of the
    /// inputs there changes an output, else the one before (1).
    pub fn first_lag(&self) -> usize {
        if self.system.sampling.hold != Hold::Zero {
            return 0;
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
        let is_direct = |k: usize| k < self.drive.len() && last(k, 0.0) != last(k, 1.0);
        usize::from(!AT.into_iter().any(is_direct))
    }
}
