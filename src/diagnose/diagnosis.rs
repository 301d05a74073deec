//! What is asked of a diagnosis.

use std::borrow::Cow;

use super::candidates::library::Allowed;
use crate::data::Record;
use crate::evaluate::Init;
use crate::memory::Memory;
use crate::system::System;

/// Share of the estimation data that is fitted; the rest chooses.
pub(super) const FIT: f64 = 0.7;
/// Shares when the estimation data must serve as test data too.
const FIT_OF_ALL: f64 = 0.6;
const TEST_OF_ALL: f64 = 0.2;
/// Share of what then is no test data that is fitted.
pub(super) const FIT_OF_REST: f64 = FIT_OF_ALL / (1.0 - TEST_OF_ALL);

/// First sample of the part of a record that is kept for the test where there is no other.
pub(super) fn kept_from(record: &Record) -> usize {
    ((1.0 - TEST_OF_ALL) * record.len() as f64) as usize
}

/// The part of records that may be searched: all where there is a test record, else all but what is kept for
/// the test.
pub(super) fn searchable<'r>(records: &'r [Record], test: Option<&Record>) -> Cow<'r, [Record]> {
    match test {
        Some(_) => records.into(),
        None => records.iter().map(|record| record.slice(0..kept_from(record))).collect(),
    }
}

/// Finds what a model's simulation gets wrong on a record, and names it.
///
/// # Example
///
/// ```no_run
/// use lacuna::data::Record;
/// use lacuna::diagnose::Diagnosis;
///
/// let system = lacuna::file::load("press.toml".as_ref())?;
/// let record = Record::csv("press.csv")?.pick(&["force"], &["position"])?;
/// let finding = Diagnosis::of(&system).run(&[record], None, &())?;
/// println!("{}", lacuna::report::sentences::summary(&finding));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Diagnosis<'a> {
    pub(super) system: &'a System,
    pub(super) allowed: Allowed,
    pub(super) max_causes: usize,
    pub(super) init: Init,
    pub(super) memory: Memory,
}

impl<'a> Diagnosis<'a> {
    /// The system that is diagnosed.
    pub fn system(&self) -> &'a System {
        self.system
    }

    /// A diagnosis of a system with the whole library and at most five causes.
    pub fn of(system: &'a System) -> Self {
        Self {
            system,
            allowed: Allowed::default(),
            max_causes: 5,
            init: Init::default(),
            memory: Memory::default(),
        }
    }

    /// Looks only for these effects.
    #[must_use]
    pub fn only(mut self, effects: &[String]) -> Self {
        self.allowed.only = effects.to_vec();
        self
    }

    /// Does not look for these effects.
    #[must_use]
    pub fn without(mut self, effects: &[String]) -> Self {
        self.allowed.without = effects.to_vec();
        self
    }

    /// Holds these parameters.
    #[must_use]
    pub fn fix(mut self, parameters: &[String]) -> Self {
        self.allowed.fixed = parameters.to_vec();
        self
    }

    /// Stops after this many causes.
    #[must_use]
    pub fn max_causes(mut self, count: usize) -> Self {
        self.max_causes = count;
        self
    }

    /// How initial states of test records are found, and what their figures leave out.
    #[must_use]
    pub fn init(mut self, init: Init) -> Self {
        self.init = init;
        self
    }

    /// Takes no more memory than about this, the records themselves included; half of the machine's
    /// without it. What does not fit is left out by rule, and the finding has a note of it: laws that
    /// explain least of what is left, the middle of stretches of a record of millions of samples.
    #[must_use]
    pub fn memory(mut self, memory: Memory) -> Self {
        self.memory = memory;
        self
    }

    /// Supposes that all noise sits at the sensors. Without this, noise models compete where a free
    /// run leaves coloured noise: where noise inside the plant (process noise, noisy inputs, wandering
    /// sensors) is clearly more probable, causes are searched by the innovations of an extended Kalman
    /// filter (Kristensen, Madsen and Jorgensen, Automatica 40, 2004), which takes longer.
    #[must_use]
    pub fn sensor_noise_only(mut self, yes: bool) -> Self {
        self.allowed.sensor_noise = yes;
        self
    }
}
