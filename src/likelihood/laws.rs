//! Laws that a place may have: every registered effect without a memory, on a grid of shapes.
//!
//! A law is linear in its coefficients, so that at every point of the grid each coefficient has one
//! column, w at coefficient 1 along the filtered coordinate; a law without a coefficient (on its own
//! path) is a column itself. What remembers is judged by runs of the filter (`memory.rs`: lag, delay, play), or left to
//! a search (hysteresis).

use crate::effect::{
    CandidateEffect, EffectBlock, EffectCall, EffectCard, Mechanism, Needs, Role, Search, SignRule,
    View,
};
use crate::real::{F64x8, Real};
use crate::register;

/// A law at one point of its grid.
#[derive(Debug, Clone)]
pub(crate) struct Law {
    pub name: &'static str,
    pub effect: Box<dyn CandidateEffect>,
    pub card: EffectCard,
    /// Entry of the table of sources of a second coordinate: the load of a friction.
    pub load: Option<usize>,
    /// Values of the parameters.
    pub values: Vec<f64>,
    /// Parameters that may be fitted.
    pub free: Vec<usize>,
}

/// Where a law would be put.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Spot {
    /// A channel of the model, of a coordinate; whether that is a velocity, or an angle.
    Channel { velocity: bool, angle: bool },
    /// An input or output, of itself.
    OwnPath { input: bool },
    /// A channel or an output, of time.
    Time { output: bool },
}

/// The laws of a coordinate at a spot, each at every point of its grid, those of a load with each that
/// is offered.
pub(crate) fn laws(spot: Spot, view: &View, loads: &[usize]) -> Vec<Law> {
    let mut found = vec![];
    for (own, effect) in register::effects() {
        let card = effect.card();
        let fits = match (spot, card.needs) {
            (Spot::Time { .. }, needs) => needs == Needs::Time,
            (_, Needs::Coordinate) => true,
            (Spot::Channel { velocity, .. }, Needs::NoVelocity) => !velocity,
            (Spot::OwnPath { .. }, Needs::NoVelocity) => true,
            (Spot::Channel { velocity, .. }, Needs::Velocity) => velocity && view.changes_sign(),
            (Spot::Channel { angle, .. }, Needs::AngleOrTime) => angle,
            (Spot::OwnPath { .. }, Needs::Velocity) => false,
            _ => false,
        };
        let under_load = card.needs == Needs::VelocityUnderLoad
            && matches!(spot, Spot::Channel { velocity: true, .. })
            && view.changes_sign();
        if under_load {
            for &load in loads {
                let all = points(own.name, effect.as_ref(), &card, spot, view).into_iter();
                found.extend(all.map(|law| Law { load: Some(load), ..law }));
            }
            continue;
        }
        let allowed = match spot {
            Spot::Channel { .. } | Spot::Time { output: false } => card.places.channel,
            Spot::OwnPath { input: true } => card.places.input,
            Spot::OwnPath { input: false } | Spot::Time { output: true } => card.places.output,
        };
        let plain = card.mechanism == Mechanism::Law && card.states == 0 && card.made_for.is_none();
        if fits && allowed && plain && !card.parameters.is_empty() {
            let points = points(own.name, effect.as_ref(), &card, spot, view);
            match spot {
                Spot::Time { .. } => {
                    found.extend(points.first().iter().flat_map(|law| law.moments(view)))
                }
                _ => found.extend(points),
            }
        }
    }
    found
}

/// The laws that depend on nothing: an offset.
pub(crate) fn offsets() -> Vec<Law> {
    let all = register::effects().into_iter().filter_map(|(own, effect)| {
        let card = effect.card();
        let plain = card.mechanism == Mechanism::Law && card.states == 0;
        (plain && card.needs == Needs::Nothing).then(|| {
            let values = card.values();
            let free = (0..values.len()).collect();
            Law { name: own.name, effect, card, load: None, values, free }
        })
    });
    all.collect()
}

/// The points of one law's grid; a parameter that picks a variant takes each of its ends.
fn points(
    name: &'static str,
    effect: &dyn CandidateEffect,
    card: &EffectCard,
    spot: Spot,
    view: &View,
) -> Vec<Law> {
    let search = effect.search(view);
    let own_path = matches!(spot, Spot::OwnPath { .. });
    let fixed = |i: usize| card.on_own_path(&card.parameters[i].name).filter(|_| own_path);
    let choices: Vec<usize> =
        (0..card.parameters.len()).filter(|&i| card.parameters[i].role == Role::Choice).collect();
    let mut found = vec![];
    for start in &search.starts {
        for variant in 0..1_usize << choices.len().min(3) {
            let mut values = start.clone();
            for (bit, &i) in choices.iter().enumerate() {
                let parameter = &card.parameters[i];
                values[i] = if variant >> bit & 1 == 0 { parameter.max } else { parameter.min };
            }
            (0..values.len()).for_each(|i| values[i] = fixed(i).unwrap_or(values[i]));
            let free: Vec<usize> = (0..values.len())
                .filter(|&i| fixed(i).is_none() && card.parameters[i].role.is_fitted())
                .filter(|&i| values[i].is_finite())
                .collect();
            let effect = effect.boxed();
            let card = within(card, &search, &free);
            found.push(Law { name, effect, card, load: None, values, free });
        }
    }
    found
}

/// A card whose free thresholds and widths stay where the coordinate tells them from none: beyond its
/// range a law becomes another, plainer one, of sizes without a bound.
fn within(card: &EffectCard, search: &Search, free: &[usize]) -> EffectCard {
    let mut card = card.clone();
    for &i in free {
        let parameter = &mut card.parameters[i];
        let (low, high) = (parameter.min.max(search.min[i]), parameter.max.min(search.max[i]));
        if parameter.role != Role::Coefficient && low <= high {
            (parameter.min, parameter.max) = (low, high);
        }
    }
    card
}

impl Law {
    /// Keeps its first coefficient to the sign that physics allows it; `direction` is how the channel
    /// moves the coordinate, where it does.
    pub fn signed(mut self, direction: Option<f64>) -> Self {
        let sign = match (self.card.sign, direction) {
            (SignRule::Opposing { polarity }, Some(d)) => -d * f64::from(polarity),
            (SignRule::Along, Some(d)) => d,
            (SignRule::Positive, _) => 1.0,
            _ => 0.0,
        };
        let first = self.coefficients().first().copied();
        if let Some(parameter) = first.map(|i| &mut self.card.parameters[i]) {
            match sign {
                s if s > 0.0 => parameter.min = parameter.min.max(0.0),
                s if s < 0.0 => parameter.max = parameter.max.min(0.0),
                _ => {}
            }
        }
        self
    }

    /// Coefficients that may be fitted.
    pub fn coefficients(&self) -> Vec<usize> {
        let linear = |&&i: &&usize| self.card.parameters[i].role == Role::Coefficient;
        self.free.iter().filter(linear).copied().collect()
    }

    /// One column per coefficient; a law without one is a column itself. `load` is the course of the second
    /// coordinate, empty where there is none.
    pub fn columns(&self, z: &[f64], load: &[f64]) -> Vec<Vec<f64>> {
        let coefficients = self.coefficients();
        if coefficients.is_empty() {
            return vec![self.course(&self.values, z, load)];
        }
        coefficients
            .iter()
            .map(|&one| {
                let mut values = self.values.clone();
                coefficients.iter().for_each(|&i| values[i] = f64::from(u8::from(i == one)));
                self.course(&values, z, load)
            })
            .collect()
    }

    /// w along a course of the coordinates; what is not finite is 0.
    fn course(&self, values: &[f64], z: &[f64], load: &[f64]) -> Vec<f64> {
        let lanes = 8;
        let packs = z.len().div_ceil(lanes);
        let parameters: Vec<F64x8> =
            (0..packs).flat_map(|_| values.iter().map(|&value| F64x8::constant(value))).collect();
        let series: Vec<&[f64]> = std::iter::once(z).chain(self.load.map(|_| load)).collect();
        let coordinates: Vec<F64x8> = (0..packs)
            .flat_map(|pack| series.iter().map(move |series| (pack, series)))
            .map(|(pack, series)| {
                let mut at = F64x8::constant(0.0);
                let from = (pack * lanes).min(series.len());
                for (lane, z) in series[from..].iter().take(lanes).enumerate() {
                    at.0[lane] = *z;
                }
                at
            })
            .collect();
        let rate = vec![F64x8::constant(0.0); packs];
        let block = EffectBlock {
            packs,
            parameters: &parameters,
            coordinates: &coordinates,
            rate: &rate,
            has_rate: false,
            states: &[],
        };
        let mut w = rate.clone();
        self.effect.answer(EffectCall::F64(&block, &mut w, &mut []));
        let finite = |v: f64| if v.is_finite() { v } else { 0.0 };
        (0..z.len()).map(|k| finite(w[k / lanes].0[k % lanes])).collect()
    }

    /// Slopes of w along every free parameter, by central differences: parameters are few, and an effect's law
    /// is a formula.
    pub fn slopes(&self, z: &[f64], load: &[f64]) -> Vec<Vec<f64>> {
        let coefficients = self.coefficients();
        self.free
            .iter()
            .map(|&i| {
                let parameter = self.values[i];
                let linear = coefficients.contains(&i);
                let h = if linear {
                    1e-4 * parameter.abs().max(1e-4)
                } else {
                    self.resolution(i).unwrap_or_else(|| 1e-4 * parameter.abs().max(1e-9))
                };
                let at = |sign: f64| {
                    let mut values = self.values.clone();
                    values[i] += sign * h;
                    self.course(&values, z, load)
                };
                let (up, down) = (at(1.0), at(-1.0));
                up.iter().zip(&down).map(|(a, b)| (a - b) / (2.0 * h)).collect()
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thresholds_and_widths_stay_in_the_range_of_their_coordinate() {
        let z: Vec<f64> = (0..2000).map(|k| 3.0 * (0.01 * f64::from(k)).sin()).collect();
        let all = laws(Spot::Channel { velocity: true, angle: false }, &View::new(&z, 0.01), &[3]);
        assert!(all.iter().any(|law| law.name == "stribeck_friction"));
        let loaded = all.iter().find(|law| law.load == Some(3)).unwrap();
        let columns = loaded.columns(&[-9.0, 9.0], &[2.0, -4.0]);
        assert!((columns[0][0] + 1.0).abs() < 1e-6 && (columns[1][0] + 2.0).abs() < 1e-6);
        assert!((columns[0][1] - 1.0).abs() < 1e-6 && (columns[1][1] - 4.0).abs() < 1e-6);
        for law in &all {
            for &i in law.free.iter().filter(|&&i| {
                let parameter = &law.card.parameters[i];
                parameter.role != Role::Coefficient && parameter.unit.text("N", "m/s") == "m/s"
            }) {
                let parameter = &law.card.parameters[i];
                assert!(
                    parameter.max <= 10.0,
                    "{} of {}: {}",
                    parameter.name,
                    law.name,
                    parameter.max
                );
                let inside = parameter.min <= law.values[i] && law.values[i] <= parameter.max;
                assert!(inside, "{} of {}: {}", parameter.name, law.name, law.values[i]);
            }
        }
    }
}
