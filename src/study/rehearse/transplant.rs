//! A look-alike in the place of a cause, as large as the data would have it.
//!
//! Its law is the cause's own, where that is what differs in place alone, else what a diagnosis that
//! knows no other law finds without the cause. At another place its size follows from least squares
//! of the outputs: c = r'r0 / r'r, with what it does, r, and what the cause does, r0; twice, as r need
//! not be proportional to its size.

use super::scene::{Stage, name, name_of, named, position, sets};
use crate::StudyError;
use crate::diagnose::{Alternative, Cause, Diagnosis};
use crate::exam::Concealed;
use crate::statistics::dot;
use crate::system::{Placed, System};

/// Rounds of least squares.
const ROUNDS: usize = 2;

/// What outputs of all records differ by, one after another.
fn differences(a: &[Vec<Vec<f64>>], b: &[Vec<Vec<f64>>]) -> Vec<f64> {
    let pairs = a.iter().flatten().flatten().zip(b.iter().flatten().flatten());
    pairs.map(|(a, b)| a - b).map(|d| if d.is_finite() { d } else { 0.0 }).collect()
}

impl Stage<'_> {
    /// The found system with another explanation in the place of a cause; `None` where it cannot be
    /// fitted there.
    pub(super) fn in_place(
        &self,
        cause: &Cause,
        found: &System,
        without: &System,
        other: &Alternative,
    ) -> Result<Option<System>, StudyError> {
        let wanted = name(&other.effect, &other.into, other.of.as_deref());
        let mut law = position(found, &name_of(cause)).map(|at| found.effects[at].clone());
        if other.effect != cause.effect {
            let only = Diagnosis::of(without).only(std::slice::from_ref(&other.effect));
            // a name that is no effect of the library cannot be asked for
            let Ok(fitted) = only.max_causes(1).run(&self.records, None, &()) else {
                return Ok(None);
            };
            let names = named(&fitted);
            if names.first() == Some(&wanted) {
                return Ok(Some(fitted.extended));
            }
            let is_runner_up =
                sets(fitted.in_the_machine()).first().is_some_and(|set| set.contains(&wanted));
            let at =
                names.first().filter(|_| is_runner_up).and_then(|n| position(&fitted.extended, n));
            law = at.map(|at| fitted.extended.effects[at].clone());
        }
        match law {
            Some(law) if law.effect.typetag_name() == other.effect => {
                let (into, of) = (other.into.clone(), other.of.clone());
                self.scaled(Placed { into, of, ..law }, found, without)
            }
            _ => Ok(None),
        }
    }

    /// A system with an effect that does, as nearly as it can, what is between two others.
    fn scaled(
        &self,
        placed: Placed,
        found: &System,
        without: &System,
    ) -> Result<Option<System>, StudyError> {
        let (Some(full), Some(quiet)) = (self.clean(found)?, self.clean(without)?) else {
            return Ok(None);
        };
        let wanted = differences(&full, &quiet);
        let mut now = placed;
        for round in 0..=ROUNDS {
            let mut system = without.clone();
            system.effects.push(now.clone());
            if round == ROUNDS {
                return Ok(Some(system));
            }
            // a place that the model does not have, or a run that diverges, is no look-alike
            let Ok(Some(moved)) = self.clean(&system) else { return Ok(None) };
            let does = differences(&moved, &quiet);
            let factor = dot(&does, &wanted) / dot(&does, &does);
            if !factor.is_finite() || factor == 0.0 {
                return Ok(None);
            }
            let concealed = Concealed { placed: now, size: vec![] };
            let Ok(Some(grown)) = concealed.grown(factor, without) else { return Ok(None) };
            now = grown;
        }
        Ok(None)
    }
}
