//! Grids of starting values: what an effect of a coordinate is tried with, whatever it enters.
//!
//! They follow from the course of the coordinate alone, so that each is made once for all channels.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::effect::{CandidateEffect, EffectCard, Role, View, curve};

/// Starting values that share which bounds are absent and which variants are chosen.
#[derive(Debug, Clone)]
pub(crate) struct Pattern {
    pub starts: Arc<Vec<Vec<f64>>>,
    /// Parameters that the effect is proportional to, and those of its shape that are free.
    pub linear: Vec<usize>,
    pub refine: Vec<usize>,
    /// Root mean square of w along the baseline for a coefficient of 1.
    pub size: f64,
}

/// All starting values of an effect of one coordinate, and their ranges.
#[derive(Debug)]
pub(crate) struct Grid {
    pub patterns: Vec<Pattern>,
    pub min: Vec<f64>,
    pub max: Vec<f64>,
    pub thresholds: bool,
}

/// Grids by effect, source, and whether it acts on its own path.
pub(crate) type Grids = BTreeMap<(&'static str, usize, bool), Arc<Grid>>;

impl Grid {
    /// The grid of an effect of a coordinate that took these values, as `view` sees them.
    pub fn new(
        shape: &dyn CandidateEffect,
        card: &EffectCard,
        (series, view): (&[f64], &View),
    ) -> Self {
        let search = shape.search(view);
        let fixed = |parameter: &str| card.on_own_path(parameter).filter(|_| view.own_path);
        let mut patterns: Vec<(Vec<i64>, Vec<Vec<f64>>)> = vec![];
        for mut start in search.starts {
            for (value, parameter) in start.iter_mut().zip(&card.parameters) {
                *value = fixed(&parameter.name).unwrap_or(*value);
            }
            let pattern: Vec<i64> = start
                .iter()
                .zip(&card.parameters)
                .map(|(value, parameter)| match parameter.role {
                    _ if value.is_infinite() => i64::MAX,
                    Role::Choice | Role::Origin => value.round() as i64,
                    _ => 0,
                })
                .collect();
            match patterns.iter_mut().find(|(known, _)| *known == pattern) {
                Some((_, starts)) => starts.push(start),
                None => patterns.push((pattern, vec![start])),
            }
        }
        let of = |(_, starts): (Vec<i64>, Vec<Vec<f64>>)| {
            let role = |i: &usize| card.parameters[*i].role;
            let free = |i: &usize| fixed(&card.parameters[*i].name).is_none();
            let finite = |i: &usize| starts[0][*i].is_finite();
            let parameters = 0..card.parameters.len();
            let linear: Vec<usize> =
                parameters.clone().filter(|i| role(i) == Role::Coefficient && free(i)).collect();
            let refine: Vec<usize> =
                parameters.filter(|i| role(i) == Role::Shape && free(i) && finite(i)).collect();
            let size = shape_size(shape, card, (&starts[0], &linear), (series, view));
            Pattern { starts: Arc::new(starts), linear, refine, size }
        };
        let patterns = patterns.into_iter().map(of).collect();
        Self { patterns, min: search.min, max: search.max, thresholds: search.thresholds }
    }
}

/// Root mean square of w along the baseline for a coefficient of 1.
fn shape_size(
    shape: &dyn CandidateEffect,
    card: &EffectCard,
    (start, linear): (&[f64], &[usize]),
    (series, view): (&[f64], &View),
) -> f64 {
    let Some(&first) = linear.first() else { return 1.0 };
    let fallback = if view.rms > 0.0 { view.rms } else { 1.0 };
    if card.states > 0 {
        // an oscillator shaken at its own frequency
        let rate = card.position(card.properties.resonance).map_or(1.0, |i| start[i]);
        return fallback * rate;
    }
    let mut parameters = start.to_vec();
    parameters[first] = 1.0;
    let size = crate::statistics::rms(&curve(shape, &parameters, series));
    if size > 0.0 && size.is_finite() { size } else { fallback }
}
