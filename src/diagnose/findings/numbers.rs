//! The numbers of a named cause, with their standard errors.

use crate::candidates::candidate::Wire;
use crate::effect::{EffectParameter, Role, Size};
use crate::findings::cause::Value;
use crate::findings::context::Context;
use crate::fit::finished::Finished;
use crate::fit::nuisance::Key;
use crate::fit::problem::{Added, Grain};
use crate::fit::profile_likelihood;

/// Unit of a rate of change of what has this unit.
pub(super) fn per_second(unit: &str) -> String {
    if unit.is_empty() { "1/s".into() } else { format!("{unit}/s") }
}

impl Context<'_, '_> {
    /// Numbers of a cause: values of a parameter are the new value, not its change.
    pub fn values(&self, chosen: &Finished, index: usize) -> Vec<Value> {
        let added = &chosen.fitted.model.added[index];
        let cause = &added.cause;
        let errors = profile_likelihood::errors(self.problem, chosen, index);
        let error = |i: usize| errors[i];
        let theta = chosen.fitted.model.parameters();
        if let Wire::Parameter(p) = cause.wire {
            return vec![Value {
                name: "value".into(),
                value: theta[p],
                std_error: chosen.error_of(&cause.into, error(0)),
                unit: cause.units.0.clone(),
            }];
        }
        let step = self.problem.step(Grain::Fine);
        let parameters = cause.clipped(&added.parameters, step, &theta);
        let parameters = cause.card.parameters.iter().zip(parameters).enumerate();
        // where the values of a free curve stand is part of what was found
        let at = crate::candidates::free_curve::knots_of(cause).into_iter().enumerate().map(
            |(i, knot)| Value {
                name: format!("knots.{i}"),
                value: knot,
                std_error: None,
                unit: cause.units.1.clone(),
            },
        );
        let is_said = |(parameter, value): &(&EffectParameter, f64)| {
            value.is_finite()
                && parameter.role != Role::Held
                && (parameter.role != Role::Origin || *value != 0.0)
        };
        let values =
            parameters.filter(|(_, both)| is_said(both)).map(|(i, (parameter, value))| Value {
                name: parameter.name.to_string(),
                value,
                std_error: error(i),
                unit: match cause.wire {
                    Wire::Drift(_) if parameter.role == Role::Coefficient => {
                        per_second(&cause.units.0)
                    }
                    _ => parameter.unit.text(&cause.units.0, &cause.units.1),
                },
            });
        values.chain(at).collect()
    }

    /// The sum of two coefficients by which a law is stated: its variance is that of both and twice
    /// their covariance.
    pub fn total(&self, chosen: &Finished, index: usize) -> Option<Value> {
        let Added { cause, parameters } = &chosen.fitted.model.added[index];
        let Size::Total(names) = cause.card.properties.size else { return None };
        let at =
            |name: &str| cause.card.parameters.iter().position(|parameter| parameter.name == name);
        let own = [at(names[0])?, at(names[1])?];
        let keys = own.map(|i| Key::EffectParameter(index, i));
        let between = chosen.precision.as_ref().and_then(|precision| precision.between(&keys));
        let variance = between.map(|between| between.sum());
        let parameter = &cause.card.parameters[own[0]];
        Some(Value {
            name: parameter.name.to_string(),
            value: own.iter().map(|&i| parameters[i]).sum(),
            std_error: variance.filter(|v| *v > 0.0 && v.is_finite()).map(f64::sqrt),
            unit: parameter.unit.text(&cause.units.0, &cause.units.1),
        })
    }
}
