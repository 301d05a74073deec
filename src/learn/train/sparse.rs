//! Penalties under which a learned part becomes no larger than it has to be.

use serde::{Deserialize, Serialize};

/// Width in which a magnitude is smooth at 0, in the weights' own unit.
pub(super) const SMOOTH: f64 = 1e-4;

/// Weights of a group lasso over signals, and of a re-weighted l1 norm over the learned entries
/// of S:
///
/// ```text
/// sum over groups g of lambda_g sqrt(n_g) ||theta_g||_2 + lambda_s sum_i |s_i| / (|s_i'| + eps)
/// ```
///
/// with s' the values some epochs before (Yuan and Lin, J. R. Stat. Soc. B 68, 2006; Candes,
/// Wakin, Boyd, J. Fourier Anal. Appl. 14, 2008; for augmented models arXiv 2604.11421). The
/// magnitudes are smooth at 0, sqrt(x^2 + 1e-8) - 1e-4, so that every optimiser can follow.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Sparse {
    /// On everything into and out of each augmented state.
    pub states: f64,
    /// On what sees each signal z.
    pub inputs: f64,
    /// On what gives each signal w.
    pub outputs: f64,
    /// On the learned entries of S.
    pub s: f64,
    /// Epochs between two re-weightings of S.
    pub reweight: usize,
    /// Whether signals that turn out not to be needed on the validation records are taken out
    /// after training.
    pub prune: bool,
}

impl Default for Sparse {
    fn default() -> Self {
        Self { states: 0.0, inputs: 0.0, outputs: 0.0, s: 0.0, reweight: 50, prune: false }
    }
}
