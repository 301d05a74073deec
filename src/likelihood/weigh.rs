//! Sets of laws against nothing, and their probabilities.
//!
//! ln odds = log L - (numbers) / 2 ln(samples) - ln(places) - ln(sets of that size), less that of nothing, and
//! with the prior of a parameter (`prior.rs`);
//! P(set) = odds / (1 + sum of all odds).
//! Sources: Schwarz, Annals of Statistics 6, 1978; Chen and Chen, Biometrika 95, 2008.

use super::evidence::log_sum;
use super::hypothesis::{Hypothesis, Part};
use super::predictor::Predictor;
use super::ranked::FittedLaws;
use super::screen::Spotted;
use super::tangent::Site;

/// How much less probable than the best a plainer set may be and still be the one that is named, as a
/// natural logarithm of odds: hardly worth mentioning (Kass and Raftery, JASA 90, 1995).
pub(super) const AS_GOOD: f64 = 1.5;

/// The plainest of the sets that are as probable as the first: fewest numbers, then plainest laws.
pub(crate) fn plainest(sets: &[Weighed]) -> Option<&Weighed> {
    let top = sets.first()?.log_odds;
    let rank = |part: &Part| match part {
        Part::Parameter(_) => 0,
        Part::Law { law, .. } => u32::from(law.card.rank),
    };
    let order = |set: &&Weighed| {
        let ranks: u32 = set.hypothesis.parts.iter().map(rank).sum();
        (set.hypothesis.numbers(), ranks)
    };
    sets.iter().filter(|set| set.log_odds > top - AS_GOOD).min_by_key(order)
}

/// A fitted set of laws of one place, weighed.
#[derive(Debug, Clone)]
pub(crate) struct Weighed {
    pub hypothesis: Hypothesis,
    /// Site and entry of the table of sources.
    pub place: (Site, Option<usize>),
    /// ln of the places and sets that it was chosen from.
    pub choice: f64,
    /// Laws that its place may have.
    pub among: f64,
    pub log_odds: f64,
    pub probability: f64,
}

impl Predictor {
    /// All fitted sets by their odds against nothing, with probabilities.
    pub(crate) fn weighed(
        &self,
        nothing: &Hypothesis,
        fitted: Vec<(Hypothesis, usize)>,
        spots: &[Spotted],
    ) -> Vec<Weighed> {
        let samples = self.observed();
        let base = nothing.criterion(samples);
        let count = |spot: &Spotted| {
            let all = spot.laws.iter().chain(&spot.remembering);
            let mut names: Vec<&str> = all.map(|law| law.name).collect();
            names.dedup();
            names.len() as f64
        };
        // a place among all places, then a set among all sets of its size
        let mut found: Vec<Weighed> = fitted
            .into_iter()
            .map(|(hypothesis, spot)| {
                let spot = &spots[spot];
                let among = count(spot).max(1.0);
                let place = spot.place();
                let sets = log_sets(&hypothesis.parts, place.1, among);
                let choice = (spots.len() as f64).ln() + sets;
                let prior = self.log_prior(&hypothesis);
                let log_odds = hypothesis.criterion(samples) + prior - base - choice;
                Weighed { hypothesis, place, choice, among, log_odds, probability: 0.0 }
            })
            .collect();
        with_probabilities(&mut found);
        found
    }

    /// A set as entries of a model file.
    pub(crate) fn fitted_laws(&self, set: Weighed) -> FittedLaws {
        let Weighed { hypothesis, log_odds, probability, .. } = set;
        let moved = |part: &Part| match part {
            Part::Parameter(p) => Some((self.name(Site::Parameter(*p)), hypothesis.theta[*p])),
            Part::Law { .. } => None,
        };
        FittedLaws {
            laws: self.placed(&hypothesis.parts),
            parameters: hypothesis.parts.iter().filter_map(moved).collect(),
            log_likelihood: hypothesis.log_likelihood,
            noise: hypothesis.noise,
            probability,
            log_odds,
        }
    }
}

/// Orders sets by their odds, and gives each its probability.
pub(super) fn with_probabilities(sets: &mut [Weighed]) {
    sets.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
    let odds: Vec<f64> = sets.iter().map(|set| set.log_odds).chain([0.0]).collect();
    let all = log_sum(&odds);
    for set in sets {
        set.probability = (set.log_odds - all).exp();
    }
}

/// ln of the number of sets of as many laws of a place with coordinate `of`, where it may have `n`: all of that size, an
/// offset of its channel beside them or none.
pub(super) fn log_sets(parts: &[Part], of: Option<usize>, n: f64) -> f64 {
    let is_own = |part: &&Part| !matches!(part, Part::Law { source, .. } if *source != of);
    let k = parts.iter().filter(is_own).count();
    let offset = if k < parts.len() { 2.0_f64.ln() } else { 0.0 };
    let k = k.min(n as usize);
    offset + (0..k).map(|i| ((n - i as f64) / (i as f64 + 1.0)).ln()).sum::<f64>()
}
