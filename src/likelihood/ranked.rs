//! What a record says about what is missing: places and sets of laws, in order.

use super::noise::Noise;
use crate::system::{Placed, System};

/// Log odds from which something is missing rather than nothing: 5, as in 150 to 1 (Kass and Raftery,
/// JASA 90, 1995: very strong).
pub(crate) const MISSING: f64 = 5.0;

/// Where something may be missing.
#[derive(Debug, Clone)]
pub struct RankedPlace {
    /// Channel, input, output or parameter.
    pub into: String,
    /// Coordinate, absent where it depends on nothing.
    pub of: Option<String>,
    /// Log Bayes factor of something there, its curve free and the noise its own, against nothing; or
    /// the log odds of its best laws, fitted exactly, where these are larger.
    pub log_evidence: f64,
    /// The most probable free curve: coordinate and force; empty where there is none.
    pub curve: Vec<(f64, f64)>,
}

/// Laws that were fitted exactly, together.
#[derive(Debug, Clone)]
pub struct FittedLaws {
    /// Laws, as entries of a model file.
    pub laws: Vec<Placed>,
    /// Name and value of every parameter that moved.
    pub parameters: Vec<(String, f64)>,
    /// The noise that is left.
    pub noise: Noise,
    /// Exact log likelihood of the innovations.
    pub log_likelihood: f64,
    /// By how much its criterion exceeds that of nothing missing.
    pub log_odds: f64,
    /// Its probability among all sets that were fitted, and nothing.
    pub probability: f64,
}

/// What a record says about what is missing, and where.
#[derive(Debug, Clone)]
pub struct RankedPlaces {
    /// The noise of the model as it is.
    pub noise: Noise,
    /// Its log likelihood.
    pub log_likelihood: f64,
    /// Places, the most evident first.
    pub places: Vec<RankedPlace>,
    /// Sets of laws, the most probable first.
    pub sets: Vec<FittedLaws>,
}

impl RankedPlaces {
    /// The most probable set of laws, if it is far more probable than nothing.
    pub fn best(&self) -> Option<&FittedLaws> {
        self.sets.first().filter(|set| set.log_odds > MISSING)
    }
}

impl FittedLaws {
    /// Whether the set is one of a place: its first law is there (an offset beside it comes last), or
    /// that parameter moved.
    pub(crate) fn is_at(&self, into: &str, of: Option<&str>) -> bool {
        let there = |law: &Placed| law.into == into && law.of.as_deref() == of;
        let moved = |(name, _): &(String, f64)| of.is_none() && name == into;
        self.laws.first().is_some_and(there) || self.parameters.iter().any(moved)
    }

    /// The system with these laws behind its own effects, moved parameters apart.
    pub fn extends(&self, system: &System) -> System {
        let mut extended = system.clone();
        extended.effects.extend(self.laws.iter().cloned());
        extended
    }
}
