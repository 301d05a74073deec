//! Causes that are given: where a search for all causes begins, when some are known from elsewhere.
//!
//! The hypothesis {given causes} in the place of {} is the first one, fitted with the noise that it calls for, and
//! each given cause has to prove itself as all others do. Some are found so only: a filter that takes a rectified
//! sensor for a plain one follows the wrong branch of |z|, so that its innovations tell nothing of that sensor,
//! while a free run tells it at once.
//! Source: Miller, "Subset Selection in Regression", 2nd ed., 2002, section 3.4 (a search from any subset).

use super::error::LikelihoodError;
use super::found::{Found, joined};
use super::hypothesis::{Hypothesis, Part};
use super::laws::Law;
use super::noise::Noise;
use super::predictor::Predictor;
use super::tangent::Site;
use crate::register;
use crate::system::Placed;

/// Causes to begin a search with.
#[derive(Debug, Clone, Default)]
pub struct Given {
    /// Laws, as entries of a model file.
    pub laws: Vec<Placed>,
    /// Parameters that have moved, by number, and their values.
    pub parameters: Vec<(usize, f64)>,
    /// [`Explanation::merit`](super::Explanation) of another search, which this one competes with.
    pub rival: Option<f64>,
}

impl Given {
    /// These laws, and the parameters whose values `after` are not those `before`.
    pub fn new(laws: Vec<Placed>, before: &[f64], after: &[f64]) -> Self {
        let both = before.iter().zip(after).enumerate();
        let parameters = both.filter(|(_, (a, b))| a != b).map(|(p, (_, b))| (p, *b)).collect();
        Self { laws, parameters, rival: None }
    }

    /// How many causes it has.
    pub fn count(&self) -> usize {
        self.laws.len() + self.parameters.len()
    }
}

/// Where a search begins.
pub(crate) struct Begun {
    /// Nothing missing, its noise its own where it can be run.
    pub null: Hypothesis,
    /// Given causes, and the model with them.
    pub found: Vec<Found>,
    pub now: Hypothesis,
}

impl Predictor {
    /// The first hypothesis of a search, states of the segments settled beside it; `noise` is its noise
    /// where that is known.
    pub(crate) fn first_hypothesis(
        &mut self,
        given: &Given,
        noise: Option<&Noise>,
    ) -> Result<Begun, LikelihoodError> {
        let mut found: Vec<Found> = given.laws.iter().filter_map(|law| self.given(law)).collect();
        let mut theta = self.model.theta.clone();
        for &(p, value) in &given.parameters {
            theta[p] = value;
            let parts = vec![Part::Parameter(p)];
            found.push(Found { parts, ..self.as_cause((Site::Parameter(p), None)) });
        }
        let mut now = Hypothesis {
            parts: joined(&found),
            theta,
            noise: self.white(vec![]),
            log_likelihood: f64::NEG_INFINITY,
            occam: 0.0,
        };
        let model = self.extended(&now.parts, &now.theta)?;
        let first = match noise {
            Some(noise) => self.renewed(&model, noise, 2)?,
            None => self.choose(&model)?,
        };
        self.settle(&first.run.path, &first.noise);
        let first = self.renewed(&model, &first.noise, 2)?;
        (now.noise, now.log_likelihood) = (first.noise, first.log_likelihood);
        now = self.costed(now);
        let null = match found.is_empty() {
            true => now.clone(),
            false => self.without_causes(&now),
        };
        Ok(Begun { null, found, now })
    }

    /// The model without causes under a noise that is fitted to it; of no likelihood where it cannot be run.
    fn without_causes(&self, of: &Hypothesis) -> Hypothesis {
        let own = self.renewed(&self.model, &of.noise, 2);
        let (noise, log_likelihood) = own
            .map_or((of.noise.clone(), f64::NEG_INFINITY), |own| (own.noise, own.log_likelihood));
        let theta = self.model.theta.clone();
        Hypothesis { parts: vec![], theta, noise, log_likelihood, occam: 0.0 }
    }

    /// A law of a model file as a cause; `None` where it reads or enters several places, or none of this model.
    fn given(&self, placed: &Placed) -> Option<Found> {
        let is_there = |(name, _): &(String, String)| *name == placed.into;
        let force = self.forces().iter().position(is_there).map(Site::Force);
        let site = self.outputs().iter().position(is_there).map(Site::Output).or(force)?;
        let source = match &placed.of {
            Some(of) => Some(self.model.plan.sources.find(of)?),
            None => None,
        };
        let mut card = placed.effect.card();
        if !placed.also_of.is_empty() || !placed.also_into.is_empty() {
            return None;
        }
        let laws = register::effects();
        let own = laws.iter().position(|(card, _)| card.name == placed.effect.typetag_name())?;
        let values = card.values();
        if let Some(width) = card.position(card.properties.smoothing_width) {
            // no steeper than the simulation that it comes from followed
            card.parameters[width].min = card.parameters[width].min.max(values[width]);
        }
        let is_free = |&i: &usize| card.parameters[i].role.is_fitted() && values[i].is_finite();
        let free = (0..values.len()).filter(is_free).collect();
        let law = Law {
            name: laws[own].0.name,
            effect: placed.effect.clone(),
            free,
            load: None,
            card,
            values,
        };
        // one law among all
        let choice = (self.places_count() as f64).ln() + (laws.len() as f64).ln();
        let parts = vec![Part::Law { site, source, law: Box::new(law) }];
        // the place may have another law, or more of them, than is given
        Some(Found {
            parts,
            choice,
            among: laws.len() as f64,
            chosen_again: false,
            given: true,
            ..self.as_cause((site, source))
        })
    }
}
