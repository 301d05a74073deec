//! What laws explain of a residual to first order, from sums that an [`Adjoint`] follows back.
//!
//! One law explains (r'dy)^2 / dy'dy: the sums are with the residual r and with m random signs z, as
//! E (z'dy)^2 = dy'dy (Hutchinson, Communications in Statistics 19, 1990). p laws together,
//! dy = sum_j v_j dy_j, explain the score statistic (Rao, Proceedings of the Cambridge Philosophical
//! Society 44, 1948)
//!
//! ```text
//! max over v of 2 v's - v'Gv = s' G^-1 s,   s_j = r'dy_j,   G_ij = dy_i'dy_j = E (z'dy_i)(z'dy_j)
//! ```
//!
//! of which m signs give (m - p - 1)/m s' G^-1 s without a bias (inverse Wishart: Muirhead, "Aspects of
//! Multivariate Statistical Theory", 1982, section 3.2.3).

use nalgebra::{DMatrix, DVector};

use super::adjoint::{Adjoint, add};
use crate::fit::problem::Problem;
use crate::prepare::operating_range::Nominal;
use crate::statistics::dot;
use crate::system::Origin;

/// Damping of a matrix that is inverted, as a share of its diagonal.
const DAMPING: f64 = 1e-6;

/// What a unit of something does to first order.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Effect {
    /// (r'dy)^2 / dy'dy: the sum of squares that it explains in the size that suits best.
    pub explained: f64,
    /// dy'dy, about.
    pub squares: f64,
}

/// Where something enters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Place {
    /// Own channels, then inputs.
    Force(usize),
    Output(usize),
}

impl Place {
    /// Where an entry of the target table is; `is_path`: at an input before all that follows it. `None`
    /// where such an input goes straight to an output, beside the states.
    pub fn of(
        (problem, nominal): (&Problem<'_>, &Nominal),
        target: usize,
        is_path: bool,
    ) -> Option<Self> {
        let base = &problem.base;
        match base.targets.entries[target].1 {
            Origin::Own(channel) => Some(Self::Force(channel)),
            Origin::Input(i) if is_path && nominal.is_direct(problem, i) => None,
            Origin::Input(i) => Some(Self::Force(base.sizes.w + i)),
            Origin::Output(o) => Some(Self::Output(o)),
            _ => None,
        }
    }
}

impl Adjoint {
    /// What something does to first order: `w` enters at a place, sample by sample.
    pub fn explains(&self, place: Place, w: &[f64]) -> Effect {
        let mut sums = vec![0.0; self.sums];
        for (own, w) in self.at(place).zip(w) {
            add(&mut sums, own, *w);
        }
        self.explained(&sums)
    }

    /// What `count` laws explain together that enter at a place: of every sample those that are not 0,
    /// with their values.
    pub fn joint_score(&self, place: Place, count: usize, laws: &[Vec<(usize, f64)>]) -> f64 {
        let sums = self.sums;
        let mut all = vec![0.0; count * sums];
        for (own, laws) in self.at(place).zip(laws) {
            laws.iter().for_each(|&(j, w)| add(&mut all[j * sums..][..sums], own, w));
        }
        let signs = sums - 1;
        if signs < count + 2 {
            return 0.0;
        }
        let signed = DMatrix::from_fn(signs, count, |f, j| all[j * sums + 1 + f]);
        let score = DVector::from_fn(count, |j, _| all[j * sums]);
        let size = signed.transpose() * &signed / signs as f64;
        let damping = DAMPING * size.trace() / count as f64;
        let size = (size + DMatrix::identity(count, count) * damping).cholesky();
        let explained = size.map_or(0.0, |size| score.dot(&size.solve(&score)));
        let explained = explained * (signs - count - 1) as f64 / signs as f64;
        if explained.is_finite() { explained.clamp(0.0, self.total) } else { 0.0 }
    }

    /// The weights of a place, sample by sample.
    fn at(&self, place: Place) -> impl Iterator<Item = &[f64]> {
        let place = match place {
            Place::Force(force) => force,
            Place::Output(output) => self.forces + output,
        };
        self.weights[place].chunks_exact(self.sums)
    }

    /// The same of another value of a parameter, or of one that grows.
    pub fn parameter_explains(&self, parameter: usize, grows: bool) -> Effect {
        let own = |all: &[Vec<f64>; 2]| {
            self.explained(&all[usize::from(grows)][parameter * self.sums..][..self.sums])
        };
        self.parameters.as_ref().map_or(Effect::default(), own)
    }

    /// (r'dy)^2 / dy'dy, from the sum with r and those with random signs.
    fn explained(&self, sums: &[f64]) -> Effect {
        let squares = dot(&sums[1..], &sums[1..]) / (self.sums - 1) as f64;
        let explained = sums[0] * sums[0] / squares;
        let explained = if explained.is_finite() { explained.min(self.total) } else { 0.0 };
        Effect { explained, squares }
    }
}

#[cfg(test)]
#[path = "explained_tests.rs"]
mod tests;
