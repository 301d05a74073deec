//! Levenberg-Marquardt with bounds and priors, driven from outside.
//!
//! The method proposes points and takes in their residuals, many at a time, so that the
//! caller can simulate them side by side: all columns of a Jacobian at once, then a whole
//! ladder of damping values at once, the undamped step of Gauss and Newton among them (Levenberg 1944;
//! Marquardt, SIAM J. Appl. Math. 11, 1963).

use nalgebra::{DMatrix, DVector};

use super::normal::{MANY, dot, hold, products, squares};
pub use super::unknown::{Settings, Unknown};

/// Damping values tried at once, as powers of this.
const LADDER: f64 = 6.0;
const RUNGS: i32 = 7;

#[derive(Debug, Clone, PartialEq)]
enum Phase {
    /// Waits for the residuals at the start.
    Start,
    /// Waits for one point per unknown; holds the steps taken.
    Jacobian(Vec<f64>),
    /// Waits for the ladder; holds its points and dampings.
    Ladder(Vec<Vec<f64>>, Vec<f64>),
    Done,
}

/// One run of the method.
#[derive(Debug, Clone)]
pub struct Levenberg {
    unknowns: Vec<Unknown>,
    settings: Settings,
    /// Present best point.
    pub point: Vec<f64>,
    /// Residuals there.
    pub residuals: Vec<f64>,
    /// Sum of squared residuals there, without priors.
    pub squares: f64,
    /// Derivatives of the residuals, one column per unknown, at the last linearisation.
    pub columns: Vec<Vec<f64>>,
    /// Jacobians made so far.
    pub iterations: usize,
    damping: f64,
    phase: Phase,
    /// Residual variance that priors are weighed against.
    variance: f64,
    /// The ladder was raised once without success.
    raised: bool,
}

impl Levenberg {
    /// A run from the unknowns' starting values.
    pub fn new(unknowns: Vec<Unknown>, settings: Settings) -> Self {
        Self {
            point: unknowns.iter().map(|u| u.start).collect(),
            unknowns,
            settings,
            residuals: vec![],
            squares: f64::INFINITY,
            columns: vec![],
            iterations: 0,
            damping: 1e-3,
            phase: Phase::Start,
            variance: 0.0,
            raised: false,
        }
    }

    /// The points whose residuals are wanted next; none when it is over.
    pub fn propose(&mut self) -> Vec<Vec<f64>> {
        match &self.phase {
            Phase::Start => vec![self.point.clone()],
            Phase::Jacobian(steps) => self.displaced(steps),
            Phase::Ladder(points, _) => points.clone(),
            Phase::Done => vec![],
        }
    }

    /// The points that will be asked for once the residuals at the start are known: both can be
    /// worked out side by side. None where the start is known, or nothing will be asked for.
    pub fn next_but_one(&self) -> Vec<Vec<f64>> {
        if !self.is_starting() || self.iterations >= self.settings.iterations {
            return vec![];
        }
        self.displaced(&self.differences())
    }

    /// Whether the residuals at the start are wanted next.
    pub fn is_starting(&self) -> bool {
        self.phase == Phase::Start
    }

    /// One point per unknown, moved by its step.
    fn displaced(&self, steps: &[f64]) -> Vec<Vec<f64>> {
        let moved = |(j, step): (usize, &f64)| {
            let mut point = self.point.clone();
            point[j] += step;
            point
        };
        steps.iter().enumerate().map(moved).collect()
    }

    /// Steps of a Jacobian by differences.
    fn differences(&self) -> Vec<f64> {
        let step = |(u, &value): (&Unknown, &f64)| {
            let step = self.settings.difference * u.scale;
            // stay inside the bounds
            if value + step > u.bounds.1 { -step } else { step }
        };
        self.unknowns.iter().zip(&self.point).map(step).collect()
    }

    /// Whether nothing more is wanted.
    pub fn is_done(&self) -> bool {
        self.phase == Phase::Done
    }

    /// Takes in the residuals at the proposed points, `None` where there are none (the
    /// simulation diverged).
    pub fn absorb(&mut self, answers: Vec<Option<Vec<f64>>>) {
        match std::mem::replace(&mut self.phase, Phase::Done) {
            Phase::Start => {
                if let Some(Some(residuals)) = answers.into_iter().next() {
                    self.squares = squares(&residuals);
                    self.residuals = residuals;
                    if self.squares.is_finite() {
                        self.linearise();
                    }
                }
            }
            Phase::Jacobian(steps) => {
                self.columns = answers
                    .into_iter()
                    .zip(&steps)
                    .map(|(answer, step)| match answer {
                        Some(r) => {
                            r.iter().zip(&self.residuals).map(|(a, b)| (a - b) / step).collect()
                        }
                        // a direction that cannot be looked along is not moved along
                        None => vec![0.0; self.residuals.len()],
                    })
                    .collect();
                self.iterations += 1;
                self.raised = false;
                self.climb();
            }
            Phase::Ladder(points, dampings) => self.choose(points, &dampings, answers),
            Phase::Done => {}
        }
    }

    /// Whether the derivatives of the residuals are wanted next.
    pub fn wants_columns(&self) -> bool {
        matches!(self.phase, Phase::Jacobian(_))
    }

    /// Takes in the derivatives of the residuals at the present point, one column per
    /// unknown, in place of the answers that differences need.
    pub fn absorb_columns(&mut self, columns: Vec<Vec<f64>>) {
        if self.wants_columns() {
            self.columns = columns;
            self.iterations += 1;
            self.raised = false;
            self.climb();
        }
    }

    fn linearise(&mut self) {
        if self.iterations >= self.settings.iterations || self.unknowns.is_empty() {
            return;
        }
        self.variance = self.squares / self.residuals.len().max(1) as f64;
        self.phase = Phase::Jacobian(self.differences());
    }

    /// Proposes steps for a ladder of dampings.
    fn climb(&mut self) {
        let (normal, gradient) = self.normal_equations();
        let n = self.unknowns.len();
        let mut points = vec![];
        let mut dampings = vec![];
        let rungs = (-1..RUNGS - 1).map(|rung| (self.damping * LADDER.powi(rung)).max(1e-12));
        // Gauss and Newton's own step moves along a ridge, which any damping would stand still on: only a prior
        // tells its points apart
        for damping in rungs.chain([0.0]) {
            let (mut damped, mut along) = (normal.clone(), gradient.clone());
            let floor = 1e-12 * normal.trace() / n as f64;
            for j in 0..n {
                damped[(j, j)] += damping * (normal[(j, j)] + floor) + f64::MIN_POSITIVE;
            }
            if damping == 0.0 {
                (0..n)
                    .filter(|&j| self.is_held(j, gradient[j]))
                    .for_each(|j| hold(&mut damped, &mut along, j));
            }
            let Some(factor) = damped.cholesky() else { continue };
            let step = factor.solve(&along);
            if step.iter().any(|s| !s.is_finite()) {
                continue;
            }
            let moved = self.unknowns.iter().zip(&self.point).zip(step.iter());
            points.push(moved.map(|((u, &value), s)| u.moved(value, s * u.scale)).collect());
            dampings.push(damping);
        }
        if !points.is_empty() {
            self.phase = Phase::Ladder(points, dampings);
        }
    }

    /// Whether an unknown stands at a bound that its slope pushes against (Bertsekas, SIAM Journal on Control and
    /// Optimization 20, 1982).
    fn is_held(&self, j: usize, slope: f64) -> bool {
        let (bounds, value) = (self.unknowns[j].bounds, self.point[j]);
        slope < 0.0 && value <= bounds.0 || slope > 0.0 && value >= bounds.1
    }

    /// J'J and -J'r in units of the scales, with the priors' share.
    fn normal_equations(&self) -> (DMatrix<f64>, DVector<f64>) {
        let n = self.unknowns.len();
        let mut normal = DMatrix::zeros(n, n);
        let mut gradient = DVector::zeros(n);
        let many = (n >= MANY).then(|| products(&self.columns, self.residuals.len()));
        let product = |i: usize, j: usize| match &many {
            Some(products) => products[(i, j)],
            None => dot(&self.columns[i], &self.columns[j]),
        };
        for i in 0..n {
            let scale = self.unknowns[i].scale;
            gradient[i] = -dot(&self.columns[i], &self.residuals) * scale;
            for j in 0..=i {
                let value = product(i, j) * scale * self.unknowns[j].scale;
                normal[(i, j)] = value;
                normal[(j, i)] = value;
            }
            if let Some((centre, deviation)) = self.unknowns[i].prior {
                let weight = self.variance * (scale / deviation).powi(2);
                normal[(i, i)] += weight;
                gradient[i] -= weight * (self.point[i] - centre) / scale;
            }
        }
        (normal, gradient)
    }

    /// The priors' share of the cost.
    fn penalty(&self, point: &[f64]) -> f64 {
        let parts = self.unknowns.iter().zip(point).filter_map(|(u, value)| {
            u.prior.map(|(centre, deviation)| ((value - centre) / deviation).powi(2))
        });
        parts.sum::<f64>() * self.variance
    }

    fn choose(&mut self, points: Vec<Vec<f64>>, dampings: &[f64], answers: Vec<Option<Vec<f64>>>) {
        let before = self.squares + self.penalty(&self.point);
        let mut best: Option<(f64, usize, f64)> = None;
        for (i, answer) in answers.iter().enumerate() {
            let Some(residuals) = answer else { continue };
            let sum = squares(residuals);
            let cost = sum + self.penalty(&points[i]);
            if cost < best.map_or(before, |(cost, ..)| cost) {
                best = Some((cost, i, sum));
            }
        }
        match best {
            Some((cost, i, sum)) => {
                let relative = (before - cost) / before;
                // the undamped step is on every ladder: the others stay where they may be needed next
                if dampings[i] > 0.0 {
                    self.damping = (dampings[i] / LADDER).max(1e-9);
                }
                if let Some(residuals) = answers.into_iter().nth(i).flatten() {
                    self.residuals = residuals;
                }
                if let Some(point) = points.into_iter().nth(i) {
                    self.point = point;
                }
                self.squares = sum;
                if relative > self.settings.tolerance {
                    self.linearise();
                }
            }
            None if !self.raised => {
                self.raised = true;
                self.damping *= LADDER.powi(RUNGS);
                self.climb();
            }
            None => {}
        }
    }
}

#[cfg(test)]
#[path = "levenberg_tests.rs"]
mod tests;
