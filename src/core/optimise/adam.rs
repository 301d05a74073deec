//! Adam (Kingma and Ba, arXiv 1412.6980, algorithm 1), with decoupled weight decay
//! (Loshchilov and Hutter, arXiv 1711.05101) and clipping of the gradient's norm
//! (Pascanu, Mikolov and Bengio, arXiv 1211.5063).

use serde::{Deserialize, Serialize};

use super::stop::{not_negative, positive};
use super::{Objective, Observer, OptimiseError, Optimiser, Outcome, Schedule, Stop, Watch};

/// Steps taken back in a row after which it is over.
const PATIENCE: usize = 20;

/// First-order steps that every entry's recent slopes scale.
///
/// [`Optimiser::minimise`] runs it on a whole objective. A trainer that draws batches
/// drives it by hand: one [`AdamState`], which can be saved, and one [`Adam::step`] per
/// batch.
///
/// # Example
///
/// ```
/// use lacuna::optimise::{Adam, AdamState};
///
/// let adam = Adam { rate: 0.1, ..Adam::default() };
/// let mut theta = [2.0, -3.0];
/// let mut state = AdamState::new(2);
/// for _ in 0..500 {
///     let gradient = theta.map(|t| 2.0 * t);
///     adam.step(&mut state, &mut theta, &gradient)?;
/// }
/// assert!(theta.iter().all(|t| t.abs() < 1e-3));
/// # Ok::<(), lacuna::optimise::OptimiseError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Adam {
    /// Step size of an entry whose slope never changes, in that entry's unit.
    pub rate: f64,
    /// Memory of the mean slope, from 0 up to below 1.
    pub beta1: f64,
    /// Memory of the mean squared slope, from 0 up to below 1.
    pub beta2: f64,
    /// Added to the root of the mean squared slope.
    pub epsilon: f64,
    /// Factor on the rate.
    pub schedule: Schedule,
    /// Share of every entry that is removed per step, times the rate.
    pub weight_decay: f64,
    /// Longest gradient (2-norm); longer ones are shortened to it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clip: Option<f64>,
    /// When [`Optimiser::minimise`] stops.
    pub stop: Stop,
}

impl Default for Adam {
    fn default() -> Self {
        Self {
            rate: 1e-3,
            beta1: 0.9,
            beta2: 0.999,
            epsilon: 1e-8,
            schedule: Schedule::Constant,
            weight_decay: 0.0,
            clip: None,
            stop: Stop::default(),
        }
    }
}

/// What Adam remembers between steps.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AdamState {
    /// Steps taken.
    pub step: u64,
    /// Mean slopes.
    pub first: Vec<f64>,
    /// Mean squared slopes.
    pub second: Vec<f64>,
    /// Factor on the rate, below 1 after steps that had to be taken back.
    pub slowed: f64,
}

impl AdamState {
    /// Before the first step, for a vector of `len` entries.
    pub fn new(len: usize) -> Self {
        Self { step: 0, first: vec![0.0; len], second: vec![0.0; len], slowed: 1.0 }
    }

    /// Halves all further steps and forgets the slopes: what to do after a step that led
    /// to no finite value, once the vector is back where it was.
    pub fn roll_back(&mut self) {
        self.slowed *= 0.5;
        self.step = 0;
        self.first.fill(0.0);
        self.second.fill(0.0);
    }
}

/// What one step did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AdamStep {
    /// The gradient's 2-norm, before clipping.
    pub norm: f64,
    /// The rate used.
    pub rate: f64,
    /// Whether the gradient was shortened.
    pub clipped: bool,
}

impl Adam {
    /// Checks all settings.
    ///
    /// # Errors
    ///
    /// The first one out of range.
    pub fn check(&self) -> Result<(), OptimiseError> {
        positive("rate", self.rate)?;
        positive("epsilon", self.epsilon)?;
        not_negative("weight_decay", self.weight_decay)?;
        if let Some(clip) = self.clip {
            positive("clip", clip)?;
        }
        for (name, value) in [("beta1", self.beta1), ("beta2", self.beta2)] {
            if !(0.0..1.0).contains(&value) {
                let expected = "from 0 up to below 1";
                return Err(OptimiseError::Setting { name, value, expected });
            }
        }
        self.schedule.check()?;
        self.stop.check()
    }

    /// One step against a gradient: `theta`, `gradient` and the state have the same length.
    ///
    /// # Errors
    ///
    /// Another length, or a slope that is not finite; nothing is moved then.
    pub fn step(
        &self,
        state: &mut AdamState,
        theta: &mut [f64],
        gradient: &[f64],
    ) -> Result<AdamStep, OptimiseError> {
        let expected = theta.len();
        for (what, found) in
            [("gradient", gradient.len()), ("optimiser's state", state.first.len())]
        {
            if found != expected {
                return Err(OptimiseError::Length { what, expected, found });
            }
        }
        let norm = gradient.iter().map(|g| g * g).sum::<f64>().sqrt();
        if !norm.is_finite()
            && let Some(entry) = gradient.iter().position(|g| !g.is_finite())
        {
            let (step, slope) = (state.step + 1, gradient[entry]);
            return Err(OptimiseError::Gradient { step, entry, slope });
        }
        let clipped = self.clip.is_some_and(|clip| norm > clip);
        let share = if clipped { self.clip.unwrap_or(norm) / norm } else { 1.0 };
        state.step += 1;
        let rate = self.rate * self.schedule.factor(state.step) * state.slowed;
        let power = state.step.min(i32::MAX as u64) as i32;
        // the means start at 0: divide by the weight that they have gathered
        let (over1, over2) =
            (1.0 / (1.0 - self.beta1.powi(power)), 1.0 / (1.0 - self.beta2.powi(power)));
        let decay = 1.0 - rate * self.weight_decay;
        let moments = state.first.iter_mut().zip(&mut state.second);
        for ((t, &g), (m, v)) in theta.iter_mut().zip(gradient).zip(moments) {
            let g = g * share;
            *m = self.beta1 * *m + (1.0 - self.beta1) * g;
            *v = self.beta2 * *v + (1.0 - self.beta2) * g * g;
            *t = decay * *t - rate * (*m * over1) / ((*v * over2).sqrt() + self.epsilon);
        }
        Ok(AdamStep { norm, rate, clipped })
    }
}

#[typetag::serde(name = "adam")]
impl Optimiser for Adam {
    fn minimise(
        &self,
        objective: &dyn Objective,
        theta: &mut [f64],
        observer: &mut dyn Observer,
    ) -> Result<Outcome, OptimiseError> {
        self.check()?;
        let mut watch = Watch::new(self.stop, objective, theta)?;
        if let Some(bounds) = objective.bounds() {
            bounds.project(theta);
            watch.best_at.copy_from_slice(theta);
        }
        let mut state = AdamState::new(theta.len());
        let mut gradient = vec![0.0; theta.len()];
        let mut loss = objective.value_and_gradient(theta, &mut gradient);
        watch.evaluations = 1;
        if !(loss.is_finite() && gradient.iter().all(|g| g.is_finite())) {
            return Err(OptimiseError::NotFiniteStart { loss });
        }
        watch.note(theta, loss, &gradient);
        let mut ended = watch.ended();
        let mut in_a_row = 0;
        while ended.is_none() {
            self.step(&mut state, theta, &gradient)?;
            if let Some(bounds) = objective.bounds() {
                bounds.project(theta);
            }
            loss = objective.value_and_gradient(theta, &mut gradient);
            watch.evaluations += 1;
            if loss.is_finite() && gradient.iter().all(|g| g.is_finite()) {
                in_a_row = 0;
                watch.note(theta, loss, &gradient);
                ended = watch.step(loss, false, observer);
                continue;
            }
            in_a_row += 1;
            watch.rollbacks += 1;
            theta.copy_from_slice(&watch.best_at);
            if in_a_row > PATIENCE {
                let (step, best) = (watch.steps + 1, watch.best);
                return Err(OptimiseError::NotFinite { step, loss, rollbacks: in_a_row, best });
            }
            state.roll_back();
            ended = watch.step(loss, true, observer);
            objective.value_and_gradient(theta, &mut gradient);
            watch.evaluations += 1;
        }
        let stopped = ended.unwrap_or(super::Stopped::Budget);
        Ok(watch.end(stopped, theta))
    }

    fn validate(&self) -> Result<(), OptimiseError> {
        self.check()
    }

    fn steps_by_batch(&self) -> bool {
        true
    }

    fn batch_step(
        &self,
        state: &mut AdamState,
        theta: &mut [f64],
        gradient: &[f64],
    ) -> Result<f64, OptimiseError> {
        self.step(state, theta, gradient).map(|step| step.rate)
    }

    fn batch_rate(&self, state: &AdamState) -> f64 {
        self.rate * self.schedule.factor(state.step.max(1)) * state.slowed
    }
}
