//! Places first, then laws: where something is missing, and what it may be.
//!
//! 1. All places are screened by closed-form evidence under the noise of "nothing missing", and, where
//!    that noise has slow parts, under white noise alone too: a slow force explains a slow cause away.
//! 2. The leading places get their free curve, and the noise anew under it: the noise of "nothing" has
//!    eaten the cause. Their evidence counts from there.
//! 3. At the leading place single laws, pairs and triples are chosen by their Gram matrix and fitted
//!    exactly, the noise anew under each; single laws are left out again as long as the criterion rises.
//!    Everything is compared by log L - (numbers) / 2 ln(samples) - ln(sets of that size).
//!
//! Sources: Schwarz, Annals of Statistics 6, 1978; Chen and Chen, Biometrika 95, 2008 (sets of a size);
//! Ljung, "System Identification", 2nd ed., section 16.4.

use rayon::prelude::*;

use super::error::LikelihoodError;
use super::follow::Wanted;
use super::hypothesis::{Hypothesis, Part, names};
use super::intensities::most_likely;
use super::noise::{Noise, Slow};
use super::path::Path;
use super::predictor::Predictor;
use super::racing::{DECIDED, RACED, going_on};
use super::ranked::{FittedLaws, RankedPlace, RankedPlaces};
use super::replay::Pass;
use super::screen::Spotted;
use super::screened::Screened;
use super::select::Chosen;
use super::sets::sets;
use super::tangent::Site;
use super::weigh::Weighed;
use crate::data::Record;
use crate::system::System;

/// Places that get a noise of their own, and of which the laws are fitted.
const LEADING: usize = 6;
const FITTED: usize = 2;

/// Ranks places and laws of what a system lacks on records of it.
///
/// # Errors
///
/// As [`Predictor::new`] and [`Predictor::fit_noise`].
pub fn places(system: &System, records: &[Record]) -> Result<RankedPlaces, LikelihoodError> {
    let mut predictor = Predictor::new(system, records)?;
    let first = predictor.choose(&predictor.model)?;
    predictor.settle(&first.run.path, &first.noise);
    predictor.places(&first.noise)
}

/// What one more cause may be.
pub(crate) struct Survey {
    /// Without it.
    pub null: Chosen,
    /// Places, the most evident first.
    pub places: Vec<RankedPlace>,
    /// Sets of laws, the most probable first.
    pub sets: Vec<Weighed>,
}

/// A place under its own noise.
struct Led {
    spot: usize,
    value: f64,
    noise: Noise,
    screened: Screened,
}

impl Predictor {
    fn places(&self, noise: &Noise) -> Result<RankedPlaces, LikelihoodError> {
        let Survey { null, mut places, sets } = self.survey(noise, None, &|| false)?;
        let sets: Vec<FittedLaws> = sets.into_iter().map(|set| self.fitted_laws(set)).collect();
        // an exact fit knows better than a curve on the old path
        for place in &mut places {
            let own = sets.iter().filter(|set| set.is_at(&place.into, place.of.as_deref()));
            let exact = own.map(|set| set.log_odds).fold(f64::NEG_INFINITY, f64::max);
            place.log_evidence = place.log_evidence.max(exact);
        }
        places.sort_by(|a, b| b.log_evidence.total_cmp(&a.log_evidence));
        Ok(RankedPlaces { noise: null.noise, log_likelihood: null.log_likelihood, places, sets })
    }

    /// Places and sets of laws of one cause, at one place only where that is given; no more places are fitted
    /// once `stop` says so.
    pub(crate) fn survey(
        &self,
        noise: &Noise,
        at: Option<(Site, Option<usize>)>,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Result<Survey, LikelihoodError> {
        let null = self.renewed(&self.model, noise, 2)?;
        let wanted = Wanted { theta: true, seen: true, gate: Some(self.gate()) };
        let run = self.run(&self.model, &null.noise, wanted)?;
        let (path, value) = (run.path, run.log_likelihood);
        let all = self.spots(&path)?;
        let spots: Vec<Spotted> = match at {
            None => all,
            // the offset of its site is part of a place
            Some((site, of)) => {
                let own = |s: &Spotted| s.site == site && (s.source == of || s.source.is_none());
                all.into_iter().filter(own).collect()
            }
        };
        let pass = Pass::of(&path, &null.noise, false);
        let base = pass.log_likelihood;
        let mut noises = vec![null.noise.clone()];
        noises.extend(self.whitened(&path, &null.noise));
        let mut led: Vec<Led> =
            noises.iter().flat_map(|noise| self.led(&path, noise, &spots, base)).collect();
        if let Some(place) = at {
            led.retain(|led| spots[led.spot].place() == place);
        }
        led.sort_by(|a, b| b.value.total_cmp(&a.value));
        let places = self.ranked(&spots, &led);
        let nothing = Hypothesis {
            parts: vec![],
            theta: self.model.theta.clone(),
            noise: null.noise.clone(),
            log_likelihood: null.log_likelihood,
            occam: 0.0,
        };
        let mut fitted: Vec<(Hypothesis, usize)> = vec![];
        let (mut done, mut quick): (Vec<usize>, Option<Self>) = (vec![], None);
        for place in led.iter().filter(|led| led.value > 0.0) {
            if done.iter().filter(|&&s| s != place.spot).count() >= FITTED || stop() {
                break;
            }
            done.push(place.spot);
            let quick = quick.get_or_insert_with(|| self.quick(&null.noise, value));
            fitted.extend(self.fitted((quick, &path), &spots, place, stop));
        }
        let merits = fitted.iter().map(|(h, _)| h.criterion(self.observed()));
        let best = merits.fold(nothing.criterion(self.observed()), f64::max);
        if !stop() {
            fitted.extend(self.remembering((&pass.z, &null.noise), &spots, best));
        }
        let sets = self.weighed(&nothing, fitted, &spots);
        Ok(Survey { null, places, sets })
    }

    /// The noise without its slow parts, a white force on the channel in their place.
    fn whitened(&self, path: &Path, noise: &Noise) -> Option<Noise> {
        let any = noise.slow.iter().chain(&noise.wander).any(Slow::is_active);
        if !any {
            return None;
        }
        let mut white = noise.clone();
        for (c, scale) in path.force_scales().into_iter().enumerate() {
            if white.slow[c].is_active() && white.white[c] == 0.0 {
                white.white[c] = 0.01 * scale * scale;
            }
        }
        white.slow.fill(Slow::NONE);
        white.wander.fill(Slow::NONE);
        Some(most_likely(path, &white, &white.components()).0)
    }

    /// The leading places of a screen, each with the noise that is left beside it; `base` is the log
    /// likelihood of nothing missing.
    fn led(&self, path: &Path, noise: &Noise, spots: &[Spotted], base: f64) -> Vec<Led> {
        let screened = self.screen(path, noise, spots);
        let own = Pass::of(path, noise, false).log_likelihood;
        let mut order: Vec<usize> = (0..spots.len()).collect();
        order.sort_by(|&a, &b| screened[b].value().total_cmp(&screened[a].value()));
        order.truncate(LEADING);
        let one = |&spot: &usize| {
            let (mut screened, mut noise) = (screened[spot].clone(), noise.clone());
            let mut value = own - base + screened.value();
            let site = spots[spot].site;
            if let (Some(curve), Site::Force(c)) = (&screened.curve, site) {
                let mut without = path.clone();
                let values: Vec<f64> = curve.amplitudes.iter().copied().collect();
                let forces = path.forces;
                for (k, w) in spots[spot].curve(&values).into_iter().enumerate() {
                    without.force[k * forces + c] -= w;
                }
                let (anew, _) = most_likely(&without, &noise, &noise.components());
                let again = self.screen(path, &anew, &spots[spot..=spot]).swap_remove(0);
                let level = Pass::of(path, &anew, false).log_likelihood;
                if level - base + again.value() > value {
                    value = level - base + again.value();
                    (screened, noise) = (again, anew);
                }
            }
            Led { spot, value, noise, screened }
        };
        order.par_iter().map(one).collect()
    }

    fn ranked(&self, spots: &[Spotted], led: &[Led]) -> Vec<RankedPlace> {
        let mut seen = vec![];
        let mut found = vec![];
        for place in led {
            if seen.contains(&place.spot) {
                continue;
            }
            seen.push(place.spot);
            let spot = &spots[place.spot];
            let source = spot.source.map(|e| self.model.plan.sources.entries[e].0.name.clone());
            let curve = place.screened.curve.as_ref();
            let values = curve.map(|curve| curve.amplitudes.iter().copied());
            let points = values.map(|values| spot.knots.iter().copied().zip(values).collect());
            found.push(RankedPlace {
                into: self.name(spot.site),
                of: source,
                log_evidence: place.value,
                curve: points.unwrap_or_default(),
            });
        }
        found
    }

    /// Sets of laws of a place, fitted exactly after a race; with each the number of laws that it was
    /// chosen from.
    fn fitted(
        &self,
        (quick, path): (&Self, &Path),
        spots: &[Spotted],
        place: &Led,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Vec<(Hypothesis, usize)> {
        let spot = &spots[place.spot];
        let theta = &self.model.theta;
        let starts: Vec<Vec<Part>> = match spot.site {
            Site::Parameter(p) => vec![vec![Part::Parameter(p)]],
            _ => {
                let offset = spots.iter().find(|s| s.site == spot.site && s.source.is_none());
                sets(path, &place.noise, spot, offset)
            }
        };
        let samples = self.observed();
        let merit = |h: &Hypothesis| h.criterion(samples);
        let order = |all: &mut Vec<Hypothesis>| all.sort_by(|a, b| merit(b).total_cmp(&merit(a)));
        // what is found after a stop is not looked at
        let race = |parts: Vec<Part>| match stop() {
            true => None,
            false => quick.raced(parts, theta, &place.noise),
        };
        let mut raced: Vec<Hypothesis> = starts.into_par_iter().filter_map(race).collect();
        order(&mut raced);
        // the noise anew only for those that it could still bring to the front
        raced.truncate(going_on(&raced, RACED, merit));
        let again = |h: Hypothesis| if stop() { None } else { quick.refit(h) };
        let mut found: Vec<Hypothesis> = raced.into_par_iter().filter_map(again).collect();
        order(&mut found);
        // the integrator's own steps for what is not far behind after that
        let far = found.split_off(going_on(&found, DECIDED, merit));
        let fit = |h: Hypothesis| match stop() {
            true => None,
            false => self.refit(self.fit(h.parts, &h.theta, &h.noise)?),
        };
        let mut found: Vec<Hypothesis> = found.into_par_iter().filter_map(fit).collect();
        found.extend(far);
        order(&mut found);
        // single laws are left out again as long as that is better
        while !stop()
            && let Some(best) = found.first().filter(|best| best.parts.len() > 1).cloned()
        {
            let mut fewer: Vec<Vec<Part>> = vec![];
            for i in 0..best.parts.len() {
                let mut parts = best.parts.clone();
                parts.remove(i);
                if !found.iter().any(|h| h.names() == names(&parts)) {
                    fewer.push(parts);
                }
            }
            let without = |parts| self.refit(self.fit(parts, &best.theta, &best.noise)?);
            let less: Vec<Hypothesis> = fewer.into_par_iter().filter_map(without).collect();
            let better = less.iter().any(|h| merit(h) > merit(&best));
            found.extend(less);
            order(&mut found);
            if !better {
                break;
            }
        }
        found.into_iter().map(|h| (h, place.spot)).collect()
    }
}
