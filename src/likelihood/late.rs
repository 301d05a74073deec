//! What is otherwise within the samples that are held back.
//!
//! A load that is put on there, or a noise that begins there, is known to nothing that is fitted: held samples
//! speak against all of it, since the machine is another one there. Whether it is, their density says,
//!
//! ```text
//! max ln p(held | causes, noise) - ln p(held | causes, noise of the other samples) > (variances) / 2 ln(held)
//! ```
//!
//! Where it is, noise is chosen anew in all samples, without a law that begins at a moment and beside one; compared as
//! all others are.
//! Sources: Willsky and Jones, IEEE Trans. Automatic Control 21, 1976 (generalised likelihood ratio of a jump); Schwarz,
//! Annals of Statistics 6, 1978.

use std::ops::Range;

use super::found::Found;
use super::given::Given;
use super::hypothesis::Hypothesis;
use super::noise::Noise;
use super::predictor::Predictor;
use super::ranked::MISSING;
use super::tangent::Site;
use super::weigh::plainest;

/// Causes, as they are fitted.
type Fitted = (Vec<Found>, Hypothesis);

impl Predictor {
    /// Whether samples that are held back have another noise than the other samples of this model.
    pub fn is_otherwise_in(&self, held: &[Range<usize>]) -> bool {
        let mut fit = self.blinded(held);
        let Ok(begun) = fit.first_hypothesis(&Given::default(), None) else { return false };
        let all = Self { start: fit.start.clone(), ..self.clone() };
        all.is_another_noise(&begun.null, held).unwrap_or(false)
    }

    /// The causes with what begins in held samples, where these are otherwise.
    pub(super) fn otherwise(
        &self,
        (found, now): (&[Found], &Hypothesis),
        held: &[Range<usize>],
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Option<Fitted> {
        if !self.is_another_noise(now, held)? {
            return None;
        }
        let model = self.extended(&now.parts, &now.theta).ok()?;
        let noise = self.choose(&model).ok()?.noise;
        let fitted = |noise: &Noise| {
            let mut causes = found.to_vec();
            let fitted = self.fit_all(&mut causes, &now.theta, noise)?;
            Some((causes, fitted))
        };
        let merit = |(causes, fitted): &Fitted| self.merit(fitted, causes);
        let anew = fitted(&noise)?;
        let own = fitted(&now.noise).filter(|own| merit(own) > merit(&anew));
        let least = own.as_ref().map_or(merit(&anew), merit);
        let begun = self.with_a_beginning((found, now), &noise, stop);
        match begun.filter(|begun| merit(begun) > least + MISSING) {
            Some((mut causes, fitted)) => {
                let gain = self.merit(&fitted, &causes) - least;
                let last = causes.last_mut()?;
                last.log_odds = gain;
                last.weighed_against_one(gain);
                Some((causes, fitted))
            }
            None => own.is_none().then_some(anew),
        }
    }

    /// The causes beside the best law that begins at a moment.
    fn with_a_beginning(
        &self,
        (found, now): (&[Found], &Hypothesis),
        noise: &Noise,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Option<Fitted> {
        let here = self.holding(now).ok()?;
        let time = Some(self.model.plan.sources.time());
        let one = |site: Site| {
            let place = (site, time);
            if stop() || found.iter().any(|cause| cause.place == place) {
                return None;
            }
            let survey = here.survey(noise, Some(place), stop).ok()?;
            let set = plainest(&survey.sets)?;
            let choice = (self.places_count() as f64).ln();
            let mut all = found.to_vec();
            all.push(Found { choice, ..self.of(&survey, set) });
            let start = &set.hypothesis;
            let fitted = self.fit_all(&mut all, &start.theta, &start.noise)?;
            Some((all, fitted))
        };
        let forces = (0..self.model.plan.sizes.w + self.model.plan.sizes.u).map(Site::Force);
        let all = forces.chain((0..self.spread.len()).map(Site::Output)).filter_map(one);
        all.max_by(|a, b| self.merit(&a.1, &a.0).total_cmp(&self.merit(&b.1, &b.0)))
    }
}
