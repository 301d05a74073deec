//! Penalties under which a learned part becomes no larger than it has to be.

use serde::{Deserialize, Serialize};

use super::groups::GroupKind;

/// Width in which a magnitude is smooth at 0, in the weights' own unit.
pub(super) const SMOOTH: f64 = 1e-4;

/// Weights of a group lasso over signals, and of a re-weighted l1 norm over the learned entries
/// of S:
///
/// ```text
/// sum over groups g of lambda_g sqrt(n_g) ||theta_g||_2 c / (rms(theta_g') + eps)
///                                              + lambda_s sum_i |s_i| / (|s_i'| + eps)
/// ```
///
/// with theta' and s' the values some epochs before, and c such that a group of weights of 0.1 is
/// drawn as before the first re-weighting: what is large is then hardly drawn any more, so that it
/// is not made smaller than the data have it (Yuan and Lin, J. R. Stat. Soc. B 68, 2006; Wang and
/// Leng, Comput. Stat. Data Anal. 52, 2008; Candes, Wakin, Boyd, J. Fourier Anal. Appl. 14, 2008;
/// for augmented models arXiv 2604.11421). The
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
    /// Epochs between two re-weightings.
    pub reweight: usize,
    /// Whether signals that turn out not to be needed on the validation records are taken out
    /// after training.
    pub prune: bool,
    /// Steps of L-BFGS on all sections, without the penalties, after which a model without a
    /// signal of a kind that they drew to 0 is judged; 0: it is judged as it is.
    pub refit: usize,
}

impl Default for Sparse {
    fn default() -> Self {
        Self {
            states: 0.0,
            inputs: 0.0,
            outputs: 0.0,
            s: 0.0,
            reweight: 50,
            prune: false,
            refit: 50,
        }
    }
}

impl Sparse {
    /// Whether anything is drawn to 0.
    pub(super) fn draws(&self) -> bool {
        [self.states, self.inputs, self.outputs, self.s].iter().any(|weight| *weight > 0.0)
    }

    /// The weight on groups of a kind.
    pub(super) fn on(&self, kind: GroupKind) -> f64 {
        match kind {
            GroupKind::State => self.states,
            GroupKind::Input => self.inputs,
            GroupKind::Output => self.outputs,
        }
    }
}
