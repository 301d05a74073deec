//! An optimiser: steps of fixed size along the sign of a momentum.

use lacuna::optimise::{
    AdamState, Objective, Observer, OptimiseError, Optimiser, Outcome, Progress, Stopped,
};
use serde::{Deserialize, Serialize};

/// Chen et al., Symbolic discovery of optimization algorithms, 2023, algorithm 2, with a rate
/// that falls to 0 along the run.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lion {
    /// Size of the first step along each entry.
    pub rate: f64,
    /// Steps to take.
    pub steps: usize,
}

#[typetag::serde(name = "lion")]
impl Optimiser for Lion {
    fn minimise(
        &self,
        objective: &dyn Objective,
        theta: &mut [f64],
        observer: &mut dyn Observer,
    ) -> Result<Outcome, OptimiseError> {
        let (mut momentum, mut slope) = (vec![0.0; theta.len()], vec![0.0; theta.len()]);
        let mut loss = objective.value_and_gradient(theta, &mut slope);
        if !loss.is_finite() {
            return Err(OptimiseError::NotFiniteStart { loss });
        }
        let (mut best, mut best_loss) = (theta.to_vec(), loss);
        let (mut stopped, mut taken) = (Stopped::Budget, 0);
        for step in 1..=self.steps {
            let rate = self.rate * (1.0 - (step - 1) as f64 / self.steps as f64);
            for ((t, m), g) in theta.iter_mut().zip(&mut momentum).zip(&slope) {
                *t -= rate * (0.9 * *m + 0.1 * g).signum();
                *m = 0.99 * *m + 0.01 * g;
            }
            loss = objective.value_and_gradient(theta, &mut slope);
            if !loss.is_finite() {
                stopped = Stopped::Stuck;
                break;
            }
            if loss < best_loss {
                best.copy_from_slice(theta);
                best_loss = loss;
            }
            taken = step;
            let gradient = slope.iter().fold(0.0_f64, |m, g| m.max(g.abs()));
            let evaluations = step + 1;
            let progress =
                Progress { step, loss, best: best_loss, gradient, evaluations, rolled_back: false };
            if observer.on_step(&progress).is_break() {
                stopped = Stopped::Asked;
                break;
            }
        }
        theta.copy_from_slice(&best);
        let gradient = slope.iter().fold(0.0_f64, |m, g| m.max(g.abs()));
        let evaluations = taken + 1;
        Ok(Outcome { stopped, steps: taken, loss: best_loss, gradient, evaluations, rollbacks: 0 })
    }

    /// Training moves after every batch; the momentum is the state's first vector.
    fn steps_by_batch(&self) -> bool {
        true
    }

    fn batch_step(
        &self,
        state: &mut AdamState,
        theta: &mut [f64],
        gradient: &[f64],
    ) -> Result<f64, OptimiseError> {
        let rate = self.batch_rate(state);
        state.step += 1;
        for ((t, m), g) in theta.iter_mut().zip(&mut state.first).zip(gradient) {
            *t -= rate * (0.9 * *m + 0.1 * g).signum();
            *m = 0.99 * *m + 0.01 * g;
        }
        Ok(rate)
    }

    fn batch_rate(&self, state: &AdamState) -> f64 {
        let done = (state.step as f64 / self.steps.max(1) as f64).min(1.0);
        self.rate * (1.0 - done) * state.slowed
    }
}
