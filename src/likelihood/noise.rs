//! Noise of a state-space model: what is random at the sensors and inside the plant.
//!
//! y = h(x, u) + d + v, v white (variance r), d[k+1] = pole d[k] + increments (sensor wander);
//! x[k+1] = F(x, u, w + m), w white through the model's channels and inputs (variance q per sample,
//! held over the sample), m[k+1] = pole m[k] + increments (slow force). A pole of 1 is a random walk
//! that starts at 0; a smaller one is a stationary process of first order (Ornstein-Uhlenbeck). A force of a narrow
//! band, as waves or a road make, is the first of two numbers that turn, a stochastic cycle:
//!
//! ```text
//! [m; m*][k+1] = pole [cos(turn), sin(turn); -sin(turn), cos(turn)] [m; m*][k] + increments of both
//! ```
//!
//! Sources: Ljung, "System Identification", 2nd ed., sections 4.2 and 4.3; Harvey, "Forecasting, Structural Time Series
//! Models and the Kalman Filter", 1989, section 2.3.4.

/// A process of first order, increments of a variance and a pole; or a stochastic cycle, which turns, too.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slow {
    /// Variance of the increments from sample to sample, in the square of the signal's unit;
    /// 0: there is none.
    pub variance: f64,
    /// Share that is left after one sample, between 0 (white) and 1 (a random walk).
    pub pole: f64,
    /// Angle by which it turns from sample to sample, in rad; 0: it does not.
    pub turn: f64,
}

impl Slow {
    /// None.
    pub const NONE: Self = Self { variance: 0.0, pole: 1.0, turn: 0.0 };

    /// A process of first order.
    pub fn fading(variance: f64, pole: f64) -> Self {
        Self { variance, pole, turn: 0.0 }
    }

    /// A random walk with this variance of increments.
    pub fn walk(variance: f64) -> Self {
        Self::fading(variance, 1.0)
    }

    /// Whether there is any.
    pub fn is_active(&self) -> bool {
        self.variance > 0.0
    }

    /// Whether it is a cycle, of two numbers.
    pub fn is_turning(&self) -> bool {
        self.turn != 0.0
    }

    /// Variance of it in any sample, where it is stationary.
    pub fn stationary(&self) -> f64 {
        self.variance * self.start()
    }

    /// What of a number is left in itself after one sample, and what comes from its partner.
    #[inline(always)]
    pub(crate) fn carried(&self) -> (f64, f64) {
        (self.pole * self.turn.cos(), self.pole * self.turn.sin())
    }

    /// The same after some samples.
    pub(crate) fn after(&self, samples: i32) -> (f64, f64) {
        let (left, angle) = (self.pole.powi(samples), self.turn * f64::from(samples));
        (left * angle.cos(), left * angle.sin())
    }

    /// Variance at the first sample over that of the increments: one increment for a walk, which
    /// starts at 0 (a wide start would be an offset that costs nothing), else the stationary one.
    pub(crate) fn start(&self) -> f64 {
        if self.pole >= 1.0 { 1.0 } else { 1.0 / (1.0 - self.pole * self.pole) }
    }
}

/// Variances of all noise of a model.
///
/// # Example
///
/// ```
/// use lacuna::likelihood::{Noise, Slow};
///
/// // one output with a sensor noise of 0.1, two channels, the first with a white force of 2
/// let mut noise = Noise::measurement(vec![0.01], 2);
/// noise.white[0] = 4.0;
/// noise.wander[0] = Slow::walk(1e-6);
/// assert_eq!(noise.count(), 3);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Noise {
    /// White measurement noise per output.
    pub measurement: Vec<f64>,
    /// White force per own channel, then per input; 0: none.
    pub white: Vec<f64>,
    /// Slow force per own channel, then per input.
    pub slow: Vec<Slow>,
    /// Wander of the sensor per output.
    pub wander: Vec<Slow>,
}

impl Noise {
    /// Measurement noise alone, for a model with this many channels and inputs together.
    pub fn measurement(variances: Vec<f64>, forces: usize) -> Self {
        Self {
            white: vec![0.0; forces],
            slow: vec![Slow::NONE; forces],
            wander: vec![Slow::NONE; variances.len()],
            measurement: variances,
        }
    }

    /// How many numbers it has: variances that are not 0, poles below 1, and angles.
    pub fn count(&self) -> usize {
        let slow = self.slow.iter().chain(&self.wander).filter(|slow| slow.is_active());
        self.measurement.len()
            + self.white.iter().filter(|&&q| q > 0.0).count()
            + slow
                .map(|slow| 1 + usize::from(slow.pole < 1.0) + usize::from(slow.is_turning()))
                .sum::<usize>()
    }

    /// Whether anything random enters the plant or wanders.
    pub fn has_process(&self) -> bool {
        self.count() > self.measurement.len()
    }

    /// The components that are there, measurement noise first.
    pub fn components(&self) -> Vec<Component> {
        let mut found: Vec<_> = (0..self.measurement.len()).map(Component::Measurement).collect();
        let active = |slow: &[Slow]| -> Vec<usize> {
            (0..slow.len()).filter(|&i| slow[i].is_active()).collect()
        };
        found.extend((0..self.white.len()).filter(|&c| self.white[c] > 0.0).map(Component::White));
        found.extend(active(&self.slow).into_iter().map(Component::Slow));
        found.extend(active(&self.wander).into_iter().map(Component::Wander));
        found
    }

    /// The variance of a component.
    pub fn variance(&self, of: Component) -> f64 {
        match of {
            Component::Measurement(o) => self.measurement[o],
            Component::White(c) => self.white[c],
            Component::Slow(c) => self.slow[c].variance,
            Component::Wander(o) => self.wander[o].variance,
        }
    }

    /// Sets the variance of a component.
    pub fn set(&mut self, of: Component, variance: f64) {
        match of {
            Component::Measurement(o) => self.measurement[o] = variance,
            Component::White(c) => self.white[c] = variance,
            Component::Slow(c) => self.slow[c].variance = variance,
            Component::Wander(o) => self.wander[o].variance = variance,
        }
    }

    /// The same with all variances multiplied.
    #[must_use]
    pub(crate) fn times(mut self, factor: f64) -> Self {
        for component in self.components() {
            self.set(component, self.variance(component) * factor);
        }
        self
    }
}

/// One part of the noise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Component {
    /// White measurement noise of an output.
    Measurement(usize),
    /// White force on a channel or input.
    White(usize),
    /// Slow force on a channel or input.
    Slow(usize),
    /// Wander of an output's sensor.
    Wander(usize),
}
