//! The course of a model with its derivatives, sample by sample: what an adjoint is followed back along.
//!
//! A = dF/dx, G = dF/dw, C = dh/dx and, where an output reads rates, D = dh/dw, where outputs are read
//! back, R = dF/dy, by forward differentiation
//! (Griewank and Walther, "Evaluating derivatives", 2nd ed., 2008, ch. 3).

use crate::fit::problem::Problem;
use crate::system::{Lane, Plan, Transition};
use crate::watch::Watch;

/// Samples after which it is asked whether to stop.
pub(super) const AT_ONCE: usize = 128;

/// Derivatives of one sample, row by row.
#[derive(PartialEq)]
pub(super) struct Slopes {
    pub a: Vec<f64>,
    pub g: Vec<f64>,
    /// Empty where outputs are not read back.
    pub read: Vec<f64>,
    pub c: Vec<f64>,
    /// Empty where no output reads rates.
    pub d: Vec<f64>,
}

/// A model's course with its derivatives, over the samples that are fitted.
pub(super) struct Course {
    pub slopes: Vec<Slopes>,
    /// Which of them holds at each sample.
    pub at: Vec<usize>,
    pub states: Vec<Vec<f64>>,
    pub n: usize,
    /// Every entry of the source table at every sample.
    pub seen: Vec<Vec<f64>>,
    /// Where segments begin among the samples.
    pub begins: Vec<usize>,
}

impl Course {
    /// Follows a model; `None` where derivatives take more than `room` bytes, it leaves the finite numbers, or
    /// somebody asks to stop.
    pub fn of(
        problem: &Problem<'_>,
        (plan, lane): (&Plan, &Lane),
        room: usize,
        watch: &dyn Watch,
    ) -> Option<Self> {
        let drive = problem.fit_drive();
        let given = (&lane.theta[..], &lane.effect_values[..]);
        let mut along = Transition::new(problem.system, plan, drive, given, false)?;
        let (n, ny) = (along.states(), problem.y.len());
        let mut to = along.jacobian();
        let (mut c, mut y) = (vec![0.0; ny * n], vec![0.0; ny]);
        let direct = problem.base.output_equations.reads_rates();
        let (forces, sources) = (along.forces(), plan.sources.entries.len());
        let mut d = vec![0.0; if direct { ny * forces } else { 0 }];
        let (still, mut seen) = (vec![0.0; forces], vec![0.0; sources]);
        let mut course = Self {
            slopes: vec![],
            at: vec![],
            states: vec![],
            n,
            seen: vec![vec![]; sources],
            begins: vec![],
        };
        let bytes = 8 * (to.a.len() + to.g.len() + to.read.len() + c.len() + d.len());
        for (number, segment) in drive.segments.iter().enumerate() {
            course.begins.push(course.at.len());
            along.start(number);
            let mut x = lane.starts.get(number).or(lane.starts.last())?.clone();
            x.resize(n, 0.0);
            for k in segment.clone() {
                if k % AT_ONCE == 0 && watch.stopped() {
                    return None;
                }
                course.states.push(x.clone());
                along.place(&x);
                along.observe(k, &mut y, &mut c, &mut []);
                if direct {
                    along.direct(&mut d);
                }
                along.see(&mut seen);
                course.seen.iter_mut().zip(&seen).for_each(|(to, v)| to.push(*v));
                along.advance(k, &still, &mut x, &mut to);
                let (a, g, read) = (to.a.clone(), to.g.clone(), to.read.clone());
                let now = Slopes { a, g, read, c: c.clone(), d: d.clone() };
                // those of a linear model are the same all along
                if course.slopes.last() != Some(&now) {
                    course.slopes.push(now);
                }
                course.at.push(course.slopes.len() - 1);
                if course.slopes.len() * bytes > room || !x.iter().all(|x| x.is_finite()) {
                    return None;
                }
            }
        }
        Some(course)
    }
}
