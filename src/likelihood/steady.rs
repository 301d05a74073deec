//! A constant beside a slow force, whose pole is chosen anew.
//!
//! The noise is chosen before any cause is known, when friction and offsets make the slow force fade slowly or not at
//! all. A process of long memory goes to any level and stays there, so that a constant beside it gains nothing. Once
//! causes are named, the hypotheses of what is left of a force are
//!
//! ```text
//! m[k+1] = pole m[k] + increments     for each of some poles, without a constant and beside one
//! ```
//!
//! which are compared as all others are. Source: Ljung, "System Identification", 2nd ed., section 4.2
//! (disturbances), 16.4 (choice of a structure).

use rayon::prelude::*;

use super::found::{Found, dealt, joined, laws};
use super::hypothesis::{Hypothesis, Part};
use super::laws::offsets;
use super::noise::Noise;
use super::poles::POLES;
use super::predictor::Predictor;
use super::tangent::Site;

/// Of all poles and constants, those that are fitted to the end.
const FITTED: usize = 3;

impl Predictor {
    /// The causes with the best other pole of a slow force, with or without a constant at its channel; whether
    /// there was a better one.
    pub(crate) fn steadied(
        &self,
        (found, now): (&mut Vec<Found>, &mut Hypothesis),
        most: usize,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> bool {
        // a constant alone was asked for under the noise of nothing
        let channels = 0..if found.is_empty() { 0 } else { now.noise.slow.len() };
        let poles = || POLES.into_iter().chain([1.0]);
        let tried: Vec<(Vec<Found>, Noise)> = channels
            .filter(|&c| now.noise.slow[c].is_active() && !now.noise.slow[c].is_turning())
            .flat_map(|c| poles().map(move |pole| (c, pole)))
            .flat_map(|(c, pole)| {
                let mut noise = now.noise.clone();
                noise.slow[c].pole = pole;
                let plain = (pole != now.noise.slow[c].pole).then(|| found.clone());
                let constants = self.constants(found, Site::Force(c), most).into_iter();
                constants.chain(plain).map(move |causes| (causes, noise.clone()))
            })
            .collect();
        let tried = self.leading_of(tried, now, stop);
        let before = self.merit(now, found);
        let fitted = |(mut causes, noise): (Vec<Found>, Noise)| {
            if stop() {
                return None;
            }
            let fit = self.fit_all(&mut causes, &now.theta, &noise)?;
            let gain = self.merit(&fit, &causes) - before;
            Some((gain, causes, fit))
        };
        let all: Vec<_> = tried.into_par_iter().filter_map(fitted).collect();
        let better = all.into_iter().filter(|(gain, ..)| *gain > 0.0);
        let Some((gain, mut causes, fit)) = better.max_by(|a, b| a.0.total_cmp(&b.0)) else {
            return false;
        };
        if causes.len() > found.len()
            && let Some(last) = causes.last_mut()
        {
            // against the force that stood for it
            last.log_odds = gain;
            last.weighed_against_one(gain);
        }
        (*found, *now) = (causes, fit);
        true
    }

    /// The most probable of some causes and noises after a step of each: noise, then numbers.
    fn leading_of(
        &self,
        tried: Vec<(Vec<Found>, Noise)>,
        now: &Hypothesis,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Vec<(Vec<Found>, Noise)> {
        let raced = |(mut causes, noise): (Vec<Found>, Noise)| {
            let parts = joined(&causes);
            let model = self.extended(&parts, &now.theta).ok().filter(|_| !stop())?;
            let noise = self.renewed(&model, &noise, 1).ok()?.noise;
            let fitted = self.fit_in(1, parts, &now.theta, &noise)?;
            dealt(&mut causes, &fitted);
            Some((self.merit(&fitted, &causes), causes, fitted.noise))
        };
        let mut all: Vec<_> = tried.into_par_iter().filter_map(raced).collect();
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        all.into_iter().take(FITTED).map(|(_, causes, noise)| (causes, noise)).collect()
    }

    /// The causes with a constant at a site beside them, for each law of a constant; none where there is
    /// one, or no room for one more.
    pub(super) fn constants(&self, found: &[Found], site: Site, most: usize) -> Vec<Vec<Found>> {
        let is_constant =
            |part: &Part| matches!(part, Part::Law { site: at, source: None, .. } if *at == site);
        if laws(found) >= most || found.iter().flat_map(|cause| &cause.parts).any(is_constant) {
            return vec![];
        }
        let laws = offsets().into_iter().filter(|law| self.scope.effect(law.name));
        let one = |law| {
            let cause = Found {
                parts: vec![Part::Law { site, source: None, law: Box::new(law) }],
                ..self.as_cause((site, None))
            };
            [found, &[cause]].concat()
        };
        laws.map(one).collect()
    }
}
