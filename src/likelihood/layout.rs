//! The augmented state of a model with noise: what is random beside the states, entry by entry.
//!
//! Source: Ljung, "System Identification", 2nd ed., section 4.3; Anderson and Moore, "Optimal Filtering", 1979, section 11.4
//! (coloured noise).

use super::noise::{Component, Noise, Slow};
use super::path::Path;

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
