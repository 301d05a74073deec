//! Levenberg-Marquardt for sums of squares, as an optimiser.

use serde::{Deserialize, Serialize};

use super::stop::positive;
use super::{
    LeastSquares, Levenberg, Objective, Observer, OptimiseError, Optimiser, Outcome, Settings,
    Stop, Stopped, Unknown, Watch,
};

/// Damped Gauss-Newton steps (Levenberg 1944; Marquardt, SIAM J. Appl. Math. 11, 1963).
///
/// Several dampings are tried side by side ([`Levenberg`] does the work); bounds are kept
/// by projection. Steps count Jacobians.
///
/// # Example
///
/// ```
/// use lacuna::optimise::{LevenbergMarquardt, Stopped, shelf};
///
/// let problem = shelf::rosenbrock(2);
/// let mut theta = problem.start.clone();
/// let outcome = LevenbergMarquardt::default().fit(&problem, &mut theta, &mut ())?;
/// assert!(outcome.loss < 1e-16 && outcome.steps < 40);
/// # Ok::<(), lacuna::optimise::OptimiseError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LevenbergMarquardt {
    /// Difference step of the Jacobian in units of each entry's scale, where the problem
    /// has no columns of its own.
    pub difference: f64,
    /// When it stops; `decrease` is that of one step.
    pub stop: Stop,
}

impl Default for LevenbergMarquardt {
    fn default() -> Self {
        let stop = Stop { steps: 100, decrease: 1e-12, patience: 1, ..Stop::default() };
        Self { difference: 1e-6, stop }
    }
}

impl LevenbergMarquardt {
    /// Lowers half the sum of squares of a problem.
    ///
    /// # Errors
    ///
    /// As [`Optimiser::minimise`].
    pub fn fit(
        &self,
        problem: &dyn LeastSquares,
        theta: &mut [f64],
        observer: &mut dyn Observer,
    ) -> Result<Outcome, OptimiseError> {
        positive("difference", self.difference)?;
        self.stop.check()?;
        let n = problem.len();
        let scales = problem.scales();
        for (what, found) in [("vector to move", theta.len()), ("list of scales", scales.len())] {
            if found != n {
                return Err(OptimiseError::Length { what, expected: n, found });
            }
        }
        let mut unknowns: Vec<Unknown> =
            theta.iter().zip(&scales).map(|(&t, &scale)| Unknown::new(t, scale)).collect();
        if let Some(bounds) = problem.bounds() {
            bounds.check(n)?;
            for (i, unknown) in unknowns.iter_mut().enumerate() {
                *unknown = unknown.within(bounds.lower[i], bounds.upper[i]);
            }
        }
        let settings = Settings {
            iterations: self.stop.steps,
            // the rules of `stop` decide, and the method itself where nothing is gained
            tolerance: 0.0,
            difference: self.difference,
        };
        let mut fit = Levenberg::new(unknowns, settings);
        let mut watch = Watch::of(self.stop, theta);
        let mut ended = None;
        let mut seen = f64::INFINITY;
        while !fit.is_done() && ended.is_none() {
            if fit.wants_columns() {
                // a step ends where the next slopes are wanted
                if let Some(columns) = problem.columns(&fit.point) {
                    watch.evaluations += 1;
                    fit.absorb_columns(columns);
                    continue;
                }
            }
            let points = fit.propose();
            watch.evaluations += points.len();
            let finite = |r: Vec<f64>| r.iter().all(|v| v.is_finite()).then_some(r);
            let answers: Vec<_> =
                problem.residuals(&points).into_iter().map(|r| r.and_then(finite)).collect();
            let starting = seen == f64::INFINITY;
            if starting && answers.first().is_none_or(Option::is_none) {
                return Err(OptimiseError::NotFiniteStart { loss: f64::NAN });
            }
            watch.rollbacks += answers.iter().filter(|a| a.is_none()).count();
            fit.absorb(answers);
            let loss = 0.5 * fit.squares;
            if loss < seen {
                seen = loss;
                let slope = slope(&fit, &scales);
                watch.note(&fit.point, loss, &slope);
                ended = if starting { watch.ended() } else { watch.step(loss, false, observer) };
            }
        }
        let used_up = fit.iterations >= self.stop.steps;
        let stopped = ended.unwrap_or(if used_up { Stopped::Budget } else { Stopped::Converged });
        Ok(watch.end(stopped, theta))
    }
}

/// The slope along every entry, from the columns last known; not a number before.
fn slope(fit: &Levenberg, scales: &[f64]) -> Vec<f64> {
    if fit.columns.is_empty() {
        return vec![f64::NAN; scales.len()];
    }
    let along = |column: &Vec<f64>| column.iter().zip(&fit.residuals).map(|(a, b)| a * b).sum();
    fit.columns.iter().map(along).collect()
}

#[typetag::serde(name = "levenberg_marquardt")]
impl Optimiser for LevenbergMarquardt {
    fn minimise(
        &self,
        objective: &dyn Objective,
        theta: &mut [f64],
        observer: &mut dyn Observer,
    ) -> Result<Outcome, OptimiseError> {
        let optimiser = "levenberg_marquardt";
        let problem =
            objective.least_squares().ok_or(OptimiseError::NotLeastSquares { optimiser })?;
        self.fit(problem, theta, observer)
    }
}
