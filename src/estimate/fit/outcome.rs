//! What a fit found, in the model's own terms.

use super::{Estimate, Estimated, Fit, Key};
use crate::evaluate::EvaluateError;
use crate::model::with_parameters;
use crate::optimise::Levenberg;
use crate::rank::unseen;
use crate::statistics::covariance;
use crate::system::{Placed, System};

/// Response of the outputs, over their spread, to a change of a parameter by a tenth of its value
/// below which the record does not show the parameter at all.
const INSENSITIVE: f64 = 1e-10;

impl Fit<'_> {
    /// What came out, with intervals.
    pub(super) fn outcome(&self, done: &Levenberg, before: f64) -> Result<Estimate, EvaluateError> {
        let count = done.residuals.len().max(1) as f64;
        let scaled: Vec<Vec<f64>> = done
            .columns
            .iter()
            .zip(&self.unknowns)
            .map(|(column, u)| column.iter().map(|v| v * u.scale).collect())
            .collect();
        let variance = done.squares / count;
        let ridge: Vec<f64> = self
            .unknowns
            .iter()
            .map(|u| u.prior.map_or(0.0, |(_, d)| variance * (u.scale / d).powi(2)))
            .collect();
        let covariance = covariance(&scaled, &done.residuals, 1, &ridge);
        let names: Vec<String> = self.names.iter().map(|(name, _)| name.clone()).collect();
        // initial states may explain part of a change: what is left counts
        let mut basis = vec![];
        for column in scaled.iter().skip(self.names.len()) {
            crate::statistics::add_to_basis(&mut basis, column.clone());
        }
        let relative: Vec<Vec<f64>> = done
            .columns
            .iter()
            .zip(&done.point)
            .take(self.names.len())
            .map(|(column, &value)| {
                let factor = if value == 0.0 { 1.0 } else { value.abs() };
                let mut column: Vec<f64> = column.iter().map(|v| v * factor).collect();
                crate::statistics::project(&basis, &mut column);
                column
            })
            .collect();
        let undetermined =
            if done.columns.len() == self.keys.len() { unseen(&names, &relative) } else { vec![] };
        // a parameter that others make up for is known by no error, however flat the rest
        let moves_freely = |name: &str| {
            let mut changes = undetermined.iter().flat_map(|combination| &combination.changes);
            changes.any(|(free, _)| free == name)
        };
        let effect_values = self.effect_values(&done.point);
        let mut parameters = vec![];
        for (i, (name, unit)) in self.names.iter().enumerate() {
            let u = &self.unknowns[i];
            let value = match self.keys[i] {
                Key::EffectParameter(k) => effect_values[k],
                Key::Theta(_) | Key::Start(..) => done.point[i],
            };
            let is_too_steep = done.point[i] < value;
            let at_bound = value <= u.bounds.0 || value >= u.bounds.1 || is_too_steep;
            let error = covariance.as_ref().map(|c| c[(i, i)].sqrt() * u.scale);
            // a change as large as the value that moves nothing leaves nothing to know it by
            let size = crate::statistics::rms(&scaled[i]);
            let error = error.filter(|e| *e > 0.0 && size > INSENSITIVE);
            let error =
                error.filter(|e| e.is_finite() && *e < 1e3 * value.abs().max(u.scale) && !at_bound);
            let error = error.filter(|_| !moves_freely(name));
            parameters.push(Estimated {
                name: name.clone(),
                from: u.start,
                value,
                std_error: error,
                interval95: error.map(|e| [value - 1.96 * e, value + 1.96 * e]),
                unit: unit.clone(),
                at_bound,
            });
        }
        Ok(Estimate {
            system: self.with_values(&done.point, &effect_values)?,
            parameters,
            undetermined,
            nrmse: (before.sqrt(), variance.sqrt()),
            iterations: done.iterations,
            interrupted: self.watch.stopped(),
            stretch: self.stretch,
        })
    }

    /// The system with the values at a point.
    fn with_values(&self, point: &[f64], effect_values: &[f64]) -> Result<System, EvaluateError> {
        let first = &self.runs[0];
        let change = |(&key, &value): (&Key, &f64)| match key {
            Key::Theta(p) => Some((first.plan.signals.parameters[p].name.clone(), value)),
            Key::EffectParameter(_) | Key::Start(..) => None,
        };
        let changes: Vec<(String, f64)> = self.keys.iter().zip(point).filter_map(change).collect();
        let written =
            |error: serde_json::Error| EvaluateError::NotWritten { reason: error.to_string() };
        let mut system = self.system.clone();
        if !changes.is_empty() {
            system.model =
                with_parameters(self.system.model.as_ref(), &changes).map_err(written)?;
        }
        let mut slots = first.plan.slots.iter();
        let mut effects: Vec<Placed> = vec![];
        for placed in &self.system.effects {
            let mut placed = placed.clone();
            let is_data = placed.effect.card().mechanism == crate::effect::Mechanism::Data;
            if let Some(slot) = (!is_data).then(|| slots.next()).flatten() {
                let own = &effect_values[slot.first_parameter..][..slot.card.parameters.len()];
                placed.effect = placed.effect.with_values(own).map_err(written)?;
            }
            effects.push(placed);
        }
        system.effects = effects;
        Ok(system)
    }
}
