//! What a little of anything that enters does to a sum of outputs: the adjoint of the simulation.
//!
//! With x[k+1] = F(x[k], u[k], w[k]; theta), y[k] = h(x[k], u[k]; theta) and A = dF/dx, G = dF/dw,
//! C = dh/dx along the course of a model, and D = dh/dw where an output reads rates, for all w at once and any
//! weights rho:
//!
//! ```text
//! sum_k rho[k]' dy[k] = sum_k g[k]' dw[k]
//! g[k] = G[k]' lambda[k+1] + D[k]' rho[k],   lambda[k] = A[k]' lambda[k+1] + C[k]' rho[k],   lambda[end] = 0
//! ```
//!
//! What a sensor adds to y has rho[k] + R[k]' lambda[k+1] in the place of g[k], with R = dF/dy where the model
//! reads its outputs back.
//!
//! (adjoint-state method: Plessix, Geophysical Journal International 167, 2006; Giles and Pierce, Flow,
//! Turbulence and Combustion 65, 2000). What laws explain by such sums is in `explained`.

use std::ops::Range;

use rayon::prelude::*;

use super::course::{AT_ONCE, Course, Slopes};
use crate::data::Random;
use crate::fit::problem::{Grain, Model, Part, Problem};
use crate::statistics::{dot, project};
use crate::system::{Jacobian, Lane, Plan, Transition};
use crate::watch::Watch;

/// Samples that one thread follows along parameters.
const BLOCK: usize = 256;

/// What is known about a model that laws are asked about.
pub(crate) struct About<'a> {
    pub model: &'a Model,
    pub residual: &'a [f64],
    /// What its own numbers can imitate, orthonormal.
    pub basis: &'a [Vec<f64>],
}

/// How an adjoint is made.
#[derive(Clone, Copy)]
pub(crate) struct Extent {
    /// Sums with random signs.
    pub signs: usize,
    /// Whether parameters are asked for too.
    pub parameters: bool,
    /// Bytes that derivatives may take.
    pub room: usize,
}

/// The course of a model over the samples that are fitted, and its adjoint.
pub(crate) struct Adjoint {
    /// Every entry of the source table at every sample.
    pub seen: Vec<Vec<f64>>,
    /// The samples, and where segments begin among them.
    pub(super) samples: Vec<usize>,
    pub begins: Vec<usize>,
    /// Own channels and inputs: outputs come after them.
    pub(super) forces: usize,
    /// Sums of outputs that are followed back: that with the residual, then those with signs.
    pub(super) sums: usize,
    /// Per place the weights of what enters there: samples one after the other, sum by sum.
    pub(super) weights: Vec<Vec<f64>>,
    /// What a unit of every parameter does to the sums, and of its growth per second.
    pub(super) parameters: Option<[Vec<f64>; 2]>,
    /// Sum of squares of what is to be explained.
    pub(super) total: f64,
}

impl Adjoint {
    /// The adjoint about a model; `None` where derivatives take more than there is room for, the model
    /// cannot be followed, or somebody asks to stop.
    pub fn new(
        problem: &Problem<'_>,
        about: &About<'_>,
        of: Extent,
        watch: &dyn Watch,
    ) -> Option<Self> {
        let job = problem.job(about.model, Grain::Coarse)?;
        let mut course = Course::of(problem, (&job.plan, &job.lane), of.room, watch)?;
        let mut own = Self {
            seen: std::mem::take(&mut course.seen),
            samples: problem.simulated(),
            begins: std::mem::take(&mut course.begins),
            forces: job.plan.sizes.w + job.plan.sizes.u,
            sums: of.signs + 1,
            weights: vec![],
            parameters: None,
            total: 0.0,
        };
        let rho = own.weighted(problem, about);
        let lambda = own.backward(problem, &course, &rho, watch)?;
        if of.parameters {
            let model = (&*job.plan, &job.lane);
            own.parameters =
                Some(own.along_parameters(problem, model, (&course, &lambda, &rho), watch)?);
        }
        Some(own)
    }

    /// Weights rho of all sums, sample by sample: outputs, and for each the sums.
    fn weighted(&mut self, problem: &Problem<'_>, about: &About<'_>) -> Vec<Vec<f64>> {
        let mut left = about.residual.to_vec();
        project(about.basis, &mut left);
        self.total = dot(&left, &left);
        let mut random = Random::new(1);
        let mut all = vec![left];
        all.extend((1..self.sums).map(|_| {
            let sign = |_: &f64| if random.below(2) == 0 { -1.0 } else { 1.0 };
            let mut signs: Vec<f64> = about.residual.iter().map(sign).collect();
            project(about.basis, &mut signs);
            signs
        }));
        let ny = problem.y.len();
        let count = about.residual.len() / ny.max(1);
        let mut counted = problem.samples(Part::Fit).enumerate().peekable();
        let sums = self.sums;
        let mut rho = vec![vec![0.0; ny * sums]; self.samples.len()];
        for (rho, &k) in rho.iter_mut().zip(&self.samples) {
            let Some((at, _)) = counted.next_if(|(_, counted)| *counted == k) else { continue };
            for o in 0..ny {
                let over = problem.weight[o][k] / problem.scale[o];
                (0..sums).for_each(|f| rho[o * sums + f] = over * all[f][o * count + at]);
            }
        }
        rho
    }

    /// Follows the sums back; gives lambda after every sample.
    fn backward(
        &mut self,
        problem: &Problem<'_>,
        course: &Course,
        rho: &[Vec<f64>],
        watch: &dyn Watch,
    ) -> Option<Vec<Vec<f64>>> {
        let (n, forces, ny, count) = (course.n, self.forces, problem.y.len(), rho.len());
        let sums = self.sums;
        self.weights = vec![vec![0.0; sums * count]; forces + ny];
        let mut lambda = vec![0.0; n * sums];
        let mut all = vec![vec![]; count];
        for at in (0..count).rev() {
            if at % AT_ONCE == 0 && watch.stopped() {
                return None;
            }
            if self.begins.binary_search(&(at + 1)).is_ok() {
                lambda.fill(0.0);
            }
            let Slopes { a, g, read, c, d } = &course.slopes[course.at[at]];
            let (mut into, mut before) = (vec![0.0; forces * sums], vec![0.0; n * sums]);
            let mut seen = rho[at].clone();
            for i in 0..n {
                let own = &lambda[i * sums..][..sums];
                spread(&mut into, &g[i * forces..][..forces], own);
                spread(&mut before, &a[i * n..][..n], own);
                if !read.is_empty() {
                    spread(&mut seen, &read[i * ny..][..ny], own);
                }
            }
            for o in 0..ny {
                let own = &rho[at][o * sums..][..sums];
                spread(&mut before, &c[o * n..][..n], own);
                if !d.is_empty() {
                    spread(&mut into, &d[o * forces..][..forces], own);
                }
            }
            for (place, weights) in self.weights.iter_mut().enumerate() {
                let from = match place < forces {
                    true => &into[place * sums..][..sums],
                    false => &seen[(place - forces) * sums..][..sums],
                };
                weights[at * sums..][..sums].copy_from_slice(from);
            }
            all[at] = std::mem::replace(&mut lambda, before);
        }
        Some(all)
    }

    /// What a unit of every parameter, and of its growth per second, does to the sums; samples are dealt
    /// out to all threads, and their shares added in order.
    fn along_parameters(
        &self,
        problem: &Problem<'_>,
        (plan, lane): (&Plan, &Lane),
        (course, lambda, rho): (&Course, &[Vec<f64>], &[Vec<f64>]),
        watch: &dyn Watch,
    ) -> Option<[Vec<f64>; 2]> {
        let drive = problem.fit_drive();
        let given = (&lane.theta[..], &lane.effect_values[..]);
        let (n, ny, nt, each) = (course.n, problem.y.len(), lane.theta.len(), self.sums);
        let (mut pieces, mut first) = (vec![], 0);
        for (number, segment) in drive.segments.iter().enumerate() {
            for from in segment.clone().step_by(BLOCK) {
                let to = segment.end.min(from + BLOCK);
                pieces.push((number, from..to, first));
                first += to - from;
            }
        }
        let share = |(number, samples, mut at): (usize, Range<usize>, usize)| {
            let mut along = Transition::new(problem.system, plan, drive, given, true)?;
            let mut to: Jacobian = along.jacobian();
            let (mut c, mut y, mut h) = (vec![0.0; ny * n], vec![0.0; ny], vec![0.0; ny * nt]);
            let (still, mut x) = (vec![0.0; self.forces], vec![0.0; n]);
            let mut sums = [vec![0.0; nt * each], vec![0.0; nt * each]];
            along.start(number);
            let clock = drive.clocks.get(number).copied().unwrap_or(0.0);
            for k in samples {
                if watch.stopped() {
                    return None;
                }
                along.place(&course.states[at]);
                along.observe(k, &mut y, &mut c, &mut h);
                along.advance(k, &still, &mut x, &mut to);
                let mut now = vec![0.0; nt * each];
                for i in 0..n {
                    spread(&mut now, &to.theta[i * nt..][..nt], &lambda[at][i * each..][..each]);
                }
                for o in 0..ny {
                    spread(&mut now, &h[o * nt..][..nt], &rho[at][o * each..][..each]);
                }
                let time = clock + k as f64 * problem.base.sampling_time;
                add(&mut sums[0], &now, 1.0);
                add(&mut sums[1], &now, time);
                at += 1;
            }
            Some(sums)
        };
        let shares: Vec<Option<[Vec<f64>; 2]>> = pieces.into_par_iter().map(share).collect();
        let mut sums = [vec![0.0; nt * each], vec![0.0; nt * each]];
        for share in shares {
            sums.iter_mut().zip(share?).for_each(|(sums, share)| add(sums, &share, 1.0));
        }
        Some(sums)
    }
}

/// to[j] += row[j] * own, for all sums at once; most of a row is often 0.
fn spread(to: &mut [f64], row: &[f64], own: &[f64]) {
    for (to, &slope) in to.chunks_exact_mut(own.len()).zip(row) {
        if slope != 0.0 {
            add(to, own, slope);
        }
    }
}

/// to += by * own.
pub(super) fn add(to: &mut [f64], own: &[f64], by: f64) {
    to.iter_mut().zip(own).for_each(|(to, own)| *to += by * own);
}
