//! Well-posed by construction: every algebraic loop of networks has a gain below 1.
//!
//! ```text
//! z = D w + c,  w = phi(z):   rho(G) < 1,  G_ij = L_i ||D_ij||
//! ```
//!
//! is enough for one solution z, whatever c, and for an I - D dphi/dz that is never singular (small
//! gains: Desoer and Vidyasagar, *Feedback Systems*, 1975, ch. III; for augmented models arXiv
//! 2604.11421). L_i bounds network i from what stands in the loop to what does, in scaled signals.
//! The model's weights are a function of free ones v:
//!
//! ```text
//! w = v s for what the bound is proportional to, else v;   s = min(1, g / rho(G(v)))
//! ```
//!
//! so that rho(G(w)) <= g for every v, and gradients go through s. The same with x_a -> x_a+ in the
//! place of the loop makes the augmented states a contraction.

mod contracting;
mod loops;
#[cfg(test)]
mod tests;

use nalgebra::DMatrix;

use super::interconnection::Interconnection;
use super::norm::{Bound, spectral};
use super::order::{Graph, Part};
use super::{Block, LfrError};
use contracting::contraction;
use loops::around;

/// A number that joins two parts: a constant, times entries of the vector of parameters.
#[derive(Debug, Clone)]
struct Factor {
    row: usize,
    col: usize,
    constant: f64,
    learned: Vec<usize>,
}

/// How what one part gives reaches what another sees.
#[derive(Debug, Clone)]
struct Join {
    to: usize,
    from: usize,
    rows: usize,
    cols: usize,
    factors: Vec<Factor>,
}

/// A gain that stays below a limit.
#[derive(Debug, Clone)]
struct Limit {
    bounds: Vec<Bound>,
    joins: Vec<Join>,
    most: f64,
}

/// From free numbers to parameters of a model under which all its limits hold.
#[derive(Debug, Clone, Default)]
pub(crate) struct Posed {
    limits: Vec<Limit>,
}

impl Posed {
    /// With `gain` around every algebraic loop at most (infinite: no limit), and `contracting` from
    /// augmented states to the next.
    pub fn of(
        model: &Interconnection,
        gain: f64,
        contracting: Option<f64>,
    ) -> Result<Self, LfrError> {
        let mut limits = vec![];
        if let Some(most) = contracting {
            limits.extend(contraction(model, most));
        }
        if gain.is_finite() {
            let graph = Graph::new(model);
            for group in graph.order() {
                if graph.is_loop(&group) {
                    let parts: Vec<&Part> = group.iter().map(|&p| &graph.parts[p]).collect();
                    let unbounded = || LfrError::Unbounded { path: graph.path(&group) };
                    limits.push(around(model, &parts, gain).ok_or_else(unbounded)?);
                }
            }
        }
        Ok(Self { limits })
    }

    /// Free numbers to parameters.
    pub fn enter(&self, values: &mut [f64]) {
        for limit in &self.limits {
            let share = limit.share(values);
            limit.scaled().for_each(|at| values[at] *= share);
        }
    }

    /// A gradient along parameters to one along the free numbers `values`.
    pub fn back(&self, values: &[f64], gradient: &mut [f64]) {
        let mut before = vec![];
        let mut now = values.to_vec();
        for limit in &self.limits {
            before.push(now.clone());
            let share = limit.share(&now);
            limit.scaled().for_each(|at| now[at] *= share);
        }
        for (limit, values) in self.limits.iter().zip(before).rev() {
            let (gain, slopes) = limit.gain(&values);
            if !(gain > limit.most) {
                continue;
            }
            let share = limit.most / gain;
            let along: f64 = limit.scaled().map(|at| gradient[at] * values[at]).sum();
            limit.scaled().for_each(|at| gradient[at] *= share);
            slopes.into_iter().for_each(|(at, slope)| gradient[at] -= along * share / gain * slope);
        }
    }

    /// The gains at these parameters.
    #[cfg(test)]
    fn gains(&self, values: &[f64]) -> Vec<f64> {
        self.limits.iter().map(|limit| limit.gain(values).0).collect()
    }
}

impl Limit {
    /// Each entry that is scaled, once.
    fn scaled(&self) -> impl Iterator<Item = usize> + '_ {
        self.bounds.iter().flat_map(Bound::scaled)
    }

    fn share(&self, values: &[f64]) -> f64 {
        let (gain, _) = self.gain(values);
        if gain > self.most { self.most / gain } else { 1.0 }
    }

    /// rho(G), and its slopes along entries of the vector of parameters.
    fn gain(&self, values: &[f64]) -> (f64, Vec<(usize, f64)>) {
        let n = self.bounds.len();
        let bounds: Vec<_> = self.bounds.iter().map(|bound| bound.value(values)).collect();
        let mut gains = DMatrix::zeros(n, n);
        let mut norms = vec![];
        for join in &self.joins {
            let (norm, slopes) = join.norm(values);
            gains[(join.to, join.from)] += bounds[join.to].0 * norm;
            norms.push((norm, slopes));
        }
        let (left, right) = (perron(&gains.transpose()), perron(&gains));
        let moved = &gains * &right;
        let rho = left.dot(&moved) / left.dot(&right);
        let mut all = vec![];
        for (join, (norm, slopes)) in self.joins.iter().zip(norms) {
            let share = left[join.to] * right[join.from] / left.dot(&right);
            let (bound, along) = &bounds[join.to];
            all.extend(along.iter().map(|&(at, slope)| (at, share * norm * slope)));
            all.extend(slopes.into_iter().map(|(at, slope)| (at, share * bound * slope)));
        }
        (rho, all)
    }
}

/// The positive vector that a matrix without negative entries turns into a multiple of itself, by
/// iteration of it with a share of the identity, under which none is turned into its opposite.
fn perron(gains: &DMatrix<f64>) -> nalgebra::DVector<f64> {
    let n = gains.nrows();
    let mut x = nalgebra::DVector::from_element(n, 1.0 / n.max(1) as f64);
    if n < 2 {
        return x;
    }
    let lift = gains.amax().max(f64::MIN_POSITIVE);
    let moved = gains / lift + DMatrix::<f64>::identity(n, n);
    for _ in 0..1000 {
        let next = (&moved * &x).normalize();
        let still = (&next - &x).amax() < 1e-14;
        x = next;
        if still {
            break;
        }
    }
    x
}

impl Join {
    fn norm(&self, values: &[f64]) -> (f64, Vec<(usize, f64)>) {
        let mut matrix = DMatrix::zeros(self.rows, self.cols);
        let times = |factor: &Factor, without: Option<usize>| -> f64 {
            let own = factor.learned.iter().enumerate().filter(|(i, _)| Some(*i) != without);
            factor.constant * own.map(|(_, &at)| values[at]).product::<f64>()
        };
        for factor in &self.factors {
            matrix[(factor.row, factor.col)] += times(factor, None);
        }
        let (norm, along) = spectral(&matrix);
        let mut slopes = vec![];
        for factor in &self.factors {
            let slope = along[factor.row * self.cols + factor.col];
            let each = factor.learned.iter().enumerate();
            slopes.extend(each.map(|(i, &at)| (at, slope * times(factor, Some(i)))));
        }
        (norm, slopes)
    }
}

/// Where the parameters of each block begin, and where the learned entries of S do.
fn places(model: &Interconnection) -> (Vec<usize>, usize) {
    let mut at = 0;
    let first = model.blocks.iter().map(|block| {
        let own = at;
        at += match block {
            Block::Network(learned) => learned.net.layout().len(),
            Block::Baseline(baseline) => baseline.free.len(),
        };
        own
    });
    let first = first.collect();
    (first, at)
}
