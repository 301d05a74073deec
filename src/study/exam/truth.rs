//! What is hidden in a case: the sealed side of an exam.

use serde::{Deserialize, Serialize};

use super::machine::Made;
use super::{Case, Machine, Number};
use crate::StudyError;

/// One hidden effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hidden {
    /// Effect.
    pub effect: String,
    /// Where it enters.
    pub into: String,
    /// What it depends on.
    pub of: Option<String>,
    /// Its true numbers.
    pub parameters: Vec<Number>,
}

/// The exam that a case belongs to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Whole {
    /// Tells exams apart.
    pub fingerprint: u64,
    /// Cases.
    pub of: usize,
    /// Seed.
    pub seed: u64,
}

/// Everything that is marked against.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CaseTruth {
    /// Version of this form.
    pub schema: u32,
    /// Tells exams apart.
    pub fingerprint: u64,
    /// Cases of the whole exam.
    pub of: usize,
    /// Seed of the exam.
    pub seed: u64,
    /// The question.
    pub case: Case,
    /// Name of the machine.
    pub system: String,
    /// What is hidden.
    pub hidden: Vec<Hidden>,
}

impl Hidden {
    /// `effect>place<coordinate`.
    pub fn name(&self) -> String {
        super::answer::short(&self.effect, &self.into, self.of.as_deref())
    }
}

impl CaseTruth {
    /// What was hidden in a case that was made.
    pub(super) fn of(
        case: &Case,
        machine: &Machine,
        made: &Made,
        Whole { fingerprint, of, seed }: Whole,
    ) -> Result<Self, StudyError> {
        let effects = &made.machine.effects[made.machine.effects.len() - case.hidden.len()..];
        let hidden = effects.iter().map(|placed| {
            let card = placed.effect.card();
            let number = |(parameter, value): (&crate::effect::EffectParameter, f64)| Number {
                name: parameter.name.to_string(),
                value,
                std_error: None,
            };
            Hidden {
                effect: placed.effect.typetag_name().into(),
                into: placed.into.clone(),
                of: placed.of.clone(),
                parameters: card
                    .parameters
                    .iter()
                    .zip(card.values())
                    .filter(|(_, value)| value.is_finite())
                    .map(number)
                    .collect(),
            }
        });
        let (hidden, system) = (hidden.collect(), machine.name());
        Ok(Self { schema: 1, fingerprint, of, seed, case: case.clone(), system, hidden })
    }

    /// What a tool may not use in answering it: what is hidden, where that is not to be found.
    pub fn excluded(&self) -> Vec<String> {
        match self.case.kind {
            super::Kind::Missing => self.hidden.iter().map(|h| h.effect.clone()).collect(),
            _ => vec![],
        }
    }
}
