//! Laws that remember, of all instruments: which are worth a fit, and their fits.
//!
//! A point p of a grid is judged by its secant, d = z(p) - z of the standardised innovations z:
//!
//! ```text
//! gain of log L: 1/2 (d'z)^2 / d'd   where d'z < 0
//! ```
//!
//! the most that a multiple of d gains. Source: Miller, "Subset Selection in Regression", 2nd ed., 2002, ch. 3.

use rayon::prelude::*;

use super::hypothesis::{Hypothesis, Part, names};
use super::noise::Noise;
use super::predictor::Predictor;
use super::racing::RACED;
use super::screen::Spotted;

/// Laws of one survey that go into a race, the most gaining first.
const RACING: usize = 2;

impl Predictor {
    /// The laws that remember which gain the most on standardised innovations `z`, each with its place among
    /// `spots`; fitted to the end where they are near `best`, the criterion of the best of all others.
    pub(super) fn remembering(
        &self,
        (z, noise): (&[f64], &Noise),
        spots: &[Spotted],
        best: f64,
    ) -> Vec<(Hypothesis, usize)> {
        let theta = &self.model.theta;
        let points = spots.iter().enumerate().flat_map(|(at, spot)| {
            spot.remembering.iter().map(move |law| {
                let law = Box::new(law.clone());
                (at, vec![Part::Law { site: spot.site, source: spot.source, law }])
            })
        });
        let points: Vec<(usize, Vec<Part>)> = points.collect();
        let gained = |(at, parts): (usize, Vec<Part>)| {
            let there = self.standardised(&parts, theta, noise)?;
            Some((secant_gain(z, &there), at, parts))
        };
        let mut judged: Vec<(f64, usize, Vec<Part>)> =
            points.into_par_iter().filter_map(gained).collect();
        judged.sort_by(|a, b| b.0.total_cmp(&a.0));
        let price = 0.5 * self.observed().ln() + (spots.len() as f64).ln();
        let mut raced: Vec<(usize, Vec<Part>)> = vec![];
        for (gain, at, parts) in judged {
            let own = names(&parts);
            let is_new = !raced.iter().any(|(_, other)| names(other) == own);
            if gain > price && is_new && raced.len() < RACING {
                raced.push((at, parts));
            }
        }
        let fit = |(at, parts): (usize, Vec<Part>)| {
            let raced = self.raced(parts, theta, noise)?;
            let fitted = match raced.criterion(self.observed()) > best - RACED {
                true => self.refit(self.fit(raced.parts, &raced.theta, noise)?)?,
                false => raced,
            };
            Some((fitted, at))
        };
        raced.into_par_iter().filter_map(fit).collect()
    }
}

/// What a multiple of the way from innovations `z` to those at a point of a grid gains at most.
fn secant_gain(z: &[f64], there: &[f64]) -> f64 {
    let both = z.iter().zip(there).filter(|(z, there)| z.is_finite() && there.is_finite());
    let (along, size) = both.fold((0.0, 0.0), |(along, size), (z, there)| {
        let d = there - z;
        (along + d * z, size + d * d)
    });
    if along < 0.0 { 0.5 * along * along / size } else { 0.0 }
}
