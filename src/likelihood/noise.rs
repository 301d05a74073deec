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

use super::path::Path;

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

/// Where the random parts with a value of their own stand in the augmented state: states, slow forces,
/// white forces that an output reads at once, wanders, and the partners of slow forces that turn.
///
/// A white force is held over its sample. Where outputs read rates, y[k] = h(x[k]) + D w[k] and
/// x[k+1] = F(x[k], w[k]) share w[k]: it is then a state of pole 0.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Layout {
    /// States of model and effects.
    pub n: usize,
    /// Channels or inputs with a slow force, then those with a white one that is held.
    pub forces: Vec<usize>,
    /// How many of them are slow.
    slow: usize,
    /// Outputs whose sensor wanders.
    pub wander: Vec<usize>,
    /// Slow forces that turn, by their place in `forces`.
    turning: Vec<usize>,
}

impl Layout {
    /// That of a linearisation.
    pub fn of(path: &Path, noise: &Noise) -> Self {
        Self::new(path.n, path.has_direct(), noise)
    }

    /// For so many states; `direct` says whether an output reads what enters the plant.
    pub fn new(n: usize, direct: bool, noise: &Noise) -> Self {
        let active = |slow: &[Slow]| -> Vec<usize> {
            (0..slow.len()).filter(|&i| slow[i].is_active()).collect()
        };
        let mut forces = active(&noise.slow);
        let slow = forces.len();
        forces.extend((0..noise.white.len()).filter(|&c| direct && noise.white[c] > 0.0));
        let turning = (0..slow).filter(|&l| noise.slow[forces[l]].is_turning()).collect();
        Self { n, forces, slow, wander: active(&noise.wander), turning }
    }

    /// Entries of the augmented state.
    pub fn len(&self) -> usize {
        self.partner(self.turning.len())
    }

    /// Entry of the partner of one of the forces that turn.
    fn partner(&self, i: usize) -> usize {
        self.n + self.forces.len() + self.wander.len() + i
    }

    /// The parts beside the states in their order: entry, and the process.
    pub fn parts<'a>(&'a self, noise: &'a Noise) -> impl Iterator<Item = (usize, Slow)> + 'a {
        let (slow, held) = self.forces.split_at(self.slow);
        let slow = slow.iter().map(|&c| noise.slow[c]);
        let held = held.iter().map(|&c| Slow::fading(noise.white[c], 0.0));
        let wander = self.wander.iter().map(|&o| noise.wander[o]);
        let partners = self.turning.iter().map(|&l| noise.slow[self.forces[l]]);
        let all = slow.chain(held).chain(wander).chain(partners);
        all.enumerate().map(|(i, part)| (self.n + i, part))
    }

    /// Entries of the forces that turn and of their partners, with what goes over from one to the other.
    #[inline(always)]
    pub fn turns<'a>(&'a self, noise: &'a Noise) -> impl Iterator<Item = (usize, usize, f64)> + 'a {
        self.turning.iter().enumerate().map(|(i, &l)| {
            let over = noise.slow[self.forces[l]].carried().1;
            (self.n + l, self.partner(i), over)
        })
    }

    /// The parts beside the states one sample later, from `x` to `to`, both augmented states.
    #[inline(always)]
    pub fn carry(&self, noise: &Noise, x: &[f64], to: &mut [f64]) {
        for (i, part) in self.parts(noise) {
            to[i] = part.carried().0 * x[i];
        }
        for (i, j, over) in self.turns(noise) {
            to[i] += over * x[j];
            to[j] -= over * x[i];
        }
    }

    /// Entries of a component that its increments enter.
    pub fn entries(&self, of: Component) -> impl Iterator<Item = usize> + '_ {
        let own = self.entry(of);
        let is_own = move |l: &usize| own == Some(self.n + l);
        let partner = self.turning.iter().position(is_own).map(|i| self.partner(i));
        own.into_iter().chain(partner)
    }

    /// Entry of a component, where it has one.
    pub fn entry(&self, of: Component) -> Option<usize> {
        let (slow, held) = self.forces.split_at(self.slow);
        match of {
            Component::Measurement(_) => None,
            Component::Slow(c) => Some(self.n + slow.iter().position(|&s| s == c)?),
            Component::White(c) => Some(self.n + self.slow + held.iter().position(|&s| s == c)?),
            Component::Wander(o) => {
                let at = self.wander.iter().position(|&w| w == o)?;
                Some(self.n + self.forces.len() + at)
            }
        }
    }

    /// Whether white forces enter between samples without a state of their own.
    pub fn lets_white_in(&self) -> bool {
        self.slow == self.forces.len()
    }

    /// The row of an output: its derivatives along the states and, where they enter it at once (`d`, empty
    /// where none does), along the forces, and its wander.
    pub fn row(&self, (c, d): (&[f64], &[f64]), output: usize, to: &mut [f64]) {
        to.fill(0.0);
        to[..self.n].copy_from_slice(c);
        if !d.is_empty() {
            for (to, &force) in to[self.n..].iter_mut().zip(&self.forces) {
                *to = d[force];
            }
        }
        if let Some(at) = self.entry(Component::Wander(output)) {
            to[at] = 1.0;
        }
    }
}
