//! What a candidate is called where it stands, and which way its signs point.

use crate::candidates::candidate::{Candidate, Preference, Wire};
use crate::effect::{Mechanism, Named, Needs, Role};
use crate::findings::cause::{Alternative, LawPart, Onset, Site, Unweighed, Value, Wording};
use crate::register;

impl Candidate {
    /// What kind of place it enters.
    pub fn site(&self) -> Site {
        match (&self.wire, self.place) {
            (Wire::Parameter(_), _) => Site::Parameter,
            (Wire::Drift(_), _) => Site::Drift,
            (_, Preference::Input) => Site::Input,
            (_, Preference::Output) => Site::Output,
            _ => Site::Channel,
        }
    }

    /// What sentences about it need; `nominal` is the value of a parameter in the model.
    pub fn wording(&self, nominal: Option<f64>) -> Wording {
        let first =
            self.linear.first().filter(|&&i| self.card.parameters[i].role == Role::Coefficient);
        let origin = self.card.parameters.iter().find(|own| own.role == Role::Origin);
        Wording {
            title: self.shape.title(&self.named),
            senses: self.shape.senses(&self.named),
            push: self.push,
            one_sign: self.sign != 0.0,
            size: self.card.properties.size,
            first: first.map(|&i| self.card.parameters[i].name.to_string()),
            gap: self.card.properties.flat_inside.map(String::from),
            is_limit: self.card.properties.limits_output,
            origin: origin.map(|own| own.name.to_string()),
            site: self.site(),
            is_constant: self.card.needs == Needs::Nothing && self.card.mechanism == Mechanism::Law,
            is_friction: self.card.properties.is_friction
                && !self.named.bare
                && self.place != Preference::Balance,
            nominal,
            units: self.units.clone(),
            ..Wording::default()
        }
    }

    /// Effect, place and coordinate of a cause that it heads: a law since a moment goes by that law, and has an onset.
    pub fn heading(&self) -> (String, String, Option<String>) {
        match self.card.properties.begins {
            Some(begins) => (begins.law.into(), self.into.clone(), None),
            None => self.name(),
        }
    }

    /// The parameter that is the moment at which it begins.
    pub fn moment(&self) -> Option<usize> {
        self.card.position(self.card.properties.begins.map(|begins| begins.from))
    }

    /// When it begins, of its numbers.
    pub fn onset(&self, values: &[Value]) -> Option<Onset> {
        let begins = self.card.properties.begins?;
        let from = values.iter().find(|own| own.name == begins.from)?;
        Some(Onset { time: from.value, std_error: from.std_error })
    }

    /// It as another explanation, with the share of the removable error that it removes; not weighed
    /// yet.
    pub fn alternative(&self, error_removed: f64) -> Alternative {
        Alternative {
            effect: self.effect.into(),
            into: self.into.clone(),
            of: self.of.clone(),
            error_removed,
            probability: None,
            unweighed: Some(Unweighed::NotCompared),
            title: self.shape.title(&self.named),
            site: self.site(),
        }
    }

    /// The fault of its column that is the same model, where there is one.
    pub fn fault_of_column(&self, error_removed: f64) -> Option<Alternative> {
        let fault = self.card.properties.recorded_as.filter(|_| self.wire == Wire::Path)?;
        Some(Alternative {
            effect: fault.into(),
            of: None,
            unweighed: Some(Unweighed::SameModel),
            title: title_of(fault),
            site: Site::Column,
            ..self.alternative(error_removed)
        })
    }

    /// It as a part of a cause.
    pub fn as_part(&self, parameters: &[Value]) -> LawPart {
        let wording = self.wording(None);
        LawPart { effect: self.effect.into(), parameters: parameters.to_vec(), wording }
    }
}

/// What a registered effect calls itself; its name where there is none.
pub(crate) fn title_of(effect: &str) -> String {
    let own = register::effects().into_iter().find(|(card, _)| card.name == effect);
    own.map_or_else(|| effect.replace('_', " "), |(_, shape)| shape.title(&Named::default()))
}

/// The registered effect that is another value of a parameter.
pub(crate) fn parameter_effect() -> &'static str {
    let own = register::effects().into_iter();
    let own = own.map(|(card, effect)| (card.name, effect.card().mechanism));
    own.into_iter().find(|(_, by)| *by == Mechanism::Parameter).map_or("", |(name, _)| name)
}
