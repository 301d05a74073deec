//! One supposed cause: an effect at a place, with what is free in it.

use std::sync::Arc;

use crate::candidates::stiffness::Stiffness;
use crate::effect::{CandidateEffect, EffectCard, Mechanism, Named, Needs, Role, ShapeOf};
use crate::system::{AlsoInto, Placed, Route};

/// Natural logarithm of the number of values that a record tells apart within the range of a number.
pub(crate) const NUMBER: f64 = 4.0;

/// How a candidate is wired into a simulation.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Wire {
    /// Changes a parameter of the model by its own first parameter.
    Parameter(usize),
    /// Makes a parameter drift.
    Drift(usize),
    /// Acts at the stages, along this route.
    Stage(Route),
    /// Sits in the path of an input or output.
    Path,
}

/// Where it acts, in the order in which equal explanations are preferred.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Preference {
    Parameter,
    /// gain, bias, delay, lag.
    Simple,
    DeclaredChannel,
    /// An output that is a balance of its own, as the channel of a missing law.
    Balance,
    Input,
    Output,
    DefaultChannel,
}

/// A supposed cause.
#[derive(Debug, Clone)]
pub(crate) struct Candidate {
    /// Registered name.
    pub effect: &'static str,
    pub shape: Box<dyn CandidateEffect>,
    pub card: Arc<EffectCard>,
    pub into: String,
    pub of: Option<String>,
    pub also_into: Vec<AlsoInto>,
    /// Further coordinates, of a learned law.
    pub also_of: Vec<String>,
    pub wire: Wire,
    pub preference: Preference,
    /// The place alone, for ties.
    pub place: Preference,
    /// Parameters that the effect is proportional to; empty where it is blended in instead.
    pub linear: Vec<usize>,
    /// Shape parameters that are refined.
    pub refine: Vec<usize>,
    /// Grid of starting values of all parameters.
    pub starts: Arc<Vec<Vec<f64>>>,
    pub min: Vec<f64>,
    pub max: Vec<f64>,
    /// Whether thresholds are tried on a finer grid before refining.
    pub thresholds: bool,
    /// Required sign of the first coefficient; 0 where both are allowed.
    pub sign: f64,
    /// First probe size of the coefficient.
    pub probe: f64,
    /// Rate at which w changes the coordinate: how stiff a steep friction law is.
    pub stiffness: Stiffness,
    /// Largest magnitude along the record of the further coordinate that coefficients beyond the first go
    /// with; 1 where there is none.
    pub load: f64,
    /// Rate at which the channel changes the coordinate, D; 0 where it is not known.
    pub push: f64,
    pub named: Named,
    /// Units of into and of.
    pub units: (String, String),
    /// Exact twins: other places that give the same simulation.
    pub twins: Vec<(String, Option<String>, f64)>,
}

impl Candidate {
    /// What identifies a cause.
    pub fn triple(&self) -> (&'static str, &str, Option<&str>) {
        (self.effect, &self.into, self.of.as_deref())
    }

    /// The same, to keep.
    pub fn name(&self) -> (String, String, Option<String>) {
        (self.effect.into(), self.into.clone(), self.of.clone())
    }

    /// Whether two candidates carry the same name.
    pub fn same_cause(&self, other: &Self) -> bool {
        self.triple() == other.triple() && self.also_of == other.also_of
    }

    /// Whether two candidates stand at the same place: the same channels and coordinate, both laws of
    /// what is there at that instant.
    pub fn same_place(&self, other: &Self) -> bool {
        let is_law =
            |c: &Self| c.card.mechanism == Mechanism::Law && c.of.is_some() && !c.is_known_limit();
        is_law(self) && is_law(other) && self.is_at(other)
    }

    /// Whether two candidates have the same channels and coordinate.
    pub fn is_at(&self, other: &Self) -> bool {
        let channels = |c: &Self| -> Vec<String> {
            c.also_into.iter().map(|also| also.channel().to_string()).collect()
        };
        self.into == other.into
            && self.coordinates() == other.coordinates()
            && channels(self) == channels(other)
    }

    /// Whether it is a function of its coordinate alone, which a curve can be read as.
    pub fn is_curve(&self) -> bool {
        let of_rate = matches!(self.card.needs, Needs::CoordinateWithRate | Needs::Motion);
        self.same_place(self) && self.also_of.is_empty() && self.card.states == 0 && !of_rate
    }

    /// Whether it is blended in by a factor from 0 to 1, having no coefficient.
    pub fn blended(&self) -> bool {
        self.linear.is_empty()
    }

    /// Whether it is an instrument's limit that was read off the record: nothing is free in it.
    pub fn is_known_limit(&self) -> bool {
        self.card.properties.limits_output && self.unknowns() == 0
    }

    /// How many numbers it has free.
    pub fn unknowns(&self) -> usize {
        self.linear.len() + self.refine.len()
    }

    /// Whether its shape is not one of the library: a free curve or a learned law.
    pub fn is_drawn(&self) -> bool {
        self.card.properties.shape != ShapeOf::Law
    }

    /// Whether it is a learned law.
    pub fn is_learned(&self) -> bool {
        self.card.properties.shape == ShapeOf::Learned
    }

    /// Everything that it depends on, the first coordinate first.
    pub fn coordinates(&self) -> Vec<&str> {
        self.of.iter().chain(&self.also_of).map(String::as_str).collect()
    }

    /// How equal explanations are ordered: the least comes first.
    pub fn order(&self) -> (Preference, usize, u8, Preference) {
        (self.preference, self.unknowns(), self.card.rank, self.place)
    }

    /// Parameters with these coefficients, as far as their bounds let them be.
    pub fn sized(&self, start: &[f64], coefficients: &[f64]) -> Vec<f64> {
        let mut parameters = start.to_vec();
        for (&i, &value) in self.linear.iter().zip(coefficients) {
            let (min, max) = self.bounds(i);
            parameters[i] = value.clamp(min, max.max(min));
        }
        parameters
    }

    /// Parameters within their ranges, the sign kept, and friction no steeper than `step` (s)
    /// lets the integrator follow in a model of these parameter values.
    pub fn clipped(&self, parameters: &[f64], step: f64, theta: &[f64]) -> Vec<f64> {
        let mut clipped = parameters.to_vec();
        for &i in &self.refine {
            if clipped[i].is_finite() {
                clipped[i] = clipped[i].clamp(self.min[i], self.max[i].max(self.min[i]));
            }
        }
        if let Some(&first) = self.linear.first()
            && self.sign * clipped[first] < 0.0
        {
            clipped[first] = 0.0;
        }
        let width = self.card.position(self.card.properties.smoothing_width);
        if let Some(width) = width {
            let reach = |at: usize| if at == 0 { 1.0 } else { self.load };
            let levels = self.linear.iter().enumerate();
            let level: f64 = levels.map(|(at, &i)| clipped[i].abs() * reach(at)).sum();
            clipped[width] = clipped[width].max(0.5 * level * self.stiffness.at(theta) * step);
        }
        clipped
    }

    /// The entry of a model file with these parameter values. Parameters have none.
    pub fn placed(&self, parameters: &[f64]) -> Option<Placed> {
        if matches!(self.wire, Wire::Parameter(_)) {
            return None;
        }
        let effect = self.shape.with_values(parameters).ok()?;
        Some(Placed {
            into: self.into.clone(),
            of: self.of.clone(),
            also_into: self.also_into.clone(),
            also_of: self.also_of.clone(),
            effect,
        })
    }

    /// Bounds of a parameter in a refit, from its role and the sign rule.
    pub fn bounds(&self, parameter: usize) -> (f64, f64) {
        if self.card.parameters[parameter].role == Role::Coefficient {
            let (min, max) = (self.min[parameter], self.max[parameter]);
            let first = self.linear.first() == Some(&parameter);
            return match self.sign {
                s if first && s > 0.0 => (min.max(0.0), max),
                s if first && s < 0.0 => (min, max.min(0.0)),
                _ => (min, max),
            };
        }
        (self.min[parameter], self.max[parameter].max(self.min[parameter]))
    }
}
