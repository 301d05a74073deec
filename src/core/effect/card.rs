//! What an effect says about itself.

use std::borrow::Cow;

use super::properties::Properties;
use super::role::Role;
use super::unit::UnitRule;
use crate::model::Quantity;

/// One parameter of an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectParameter {
    /// Name: the key in model files and the field of the effect's struct (`values.3` is the
    /// fourth of a list).
    pub name: Cow<'static, str>,
    /// Present value; infinite where an optional bound is absent.
    pub value: f64,
    /// Value at which the effect vanishes whatever the other parameters say, if there is one.
    pub neutral: Option<f64>,
    /// What it does.
    pub role: Role,
    /// Its unit.
    pub unit: UnitRule,
    /// Smallest value allowed.
    pub min: f64,
    /// Largest value allowed.
    pub max: f64,
}

impl EffectParameter {
    /// A coefficient: the effect is proportional to it.
    pub fn coefficient(name: impl Into<Cow<'static, str>>, value: f64, unit: UnitRule) -> Self {
        Self {
            name: name.into(),
            value,
            neutral: Some(0.0),
            role: Role::Coefficient,
            unit,
            min: f64::NEG_INFINITY,
            max: f64::INFINITY,
        }
    }

    /// A shape parameter, positive.
    pub fn shape(name: impl Into<Cow<'static, str>>, value: f64, unit: UnitRule) -> Self {
        Self { neutral: None, role: Role::Shape, min: 0.0, ..Self::coefficient(name, value, unit) }
    }

    /// An origin of the coordinate.
    pub fn origin(name: impl Into<Cow<'static, str>>, value: f64) -> Self {
        let any = (f64::NEG_INFINITY, f64::INFINITY);
        let shape = Self::shape(name, value, UnitRule::Coordinate).within(any.0, any.1);
        Self { role: Role::Origin, ..shape }
    }

    /// A positive number that no fit moves.
    pub fn held(name: impl Into<Cow<'static, str>>, value: f64, unit: UnitRule) -> Self {
        Self { role: Role::Held, ..Self::shape(name, value, unit) }
    }

    /// The same parameter with its allowed range.
    #[must_use]
    pub fn within(mut self, min: f64, max: f64) -> Self {
        self.min = min;
        self.max = max;
        self
    }

    /// The same parameter with the value at which the effect vanishes.
    #[must_use]
    pub fn neutral_at(mut self, neutral: f64) -> Self {
        self.neutral = Some(neutral);
        self
    }
}

/// Which sign physics allows a coefficient.
///
/// With D the rate at which the channel changes the coordinate (D = dz/dx B_w), friction
/// has the sign of -D and a reaction mass the sign of +D. D may be negative, where a
/// coordinate is written the other way round, so the rule is never "negative".
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SignRule {
    /// Both signs.
    Any,
    /// Opposes the motion: sign of -D, times `polarity` (-1 where the law has a minus in it).
    Opposing {
        /// -1 where the law itself carries a minus sign.
        polarity: i8,
    },
    /// Moves with the coordinate: sign of D.
    Along,
    /// Never negative.
    Positive,
}

/// What an effect may depend on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Needs {
    /// Nothing.
    Nothing,
    /// Any coordinate.
    Coordinate,
    /// A velocity that changes sign along the record.
    Velocity,
    /// A velocity that changes sign along the record, and a force as a second coordinate: the load that is
    /// transmitted. A search tries what has the channel's unit.
    VelocityUnderLoad,
    /// Any coordinate that is no velocity: gaps and end stops are of places, levels, forces. Flat around
    /// zero of a velocity is friction without its name.
    NoVelocity,
    /// A coordinate whose rate of change is among the model's signals.
    CoordinateWithRate,
    /// A position (whose velocity is known), a velocity, or a force: what can shake an
    /// oscillator.
    Motion,
    /// An angle, or time.
    AngleOrTime,
    /// Time.
    Time,
}

/// How the system carries an effect out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mechanism {
    /// By its law: w = law(z), perhaps with states of its own.
    Law,
    /// First-order filter of the path it sits in, solved exactly.
    Lag,
    /// Transport delay of the path it sits in.
    Delay,
    /// Play of the path it sits in.
    Play,
    /// Another value of a parameter of the model.
    Parameter,
    /// Nothing in the model: the data are at fault.
    Data,
}

/// Where candidates of an effect are put when causes are searched for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Places {
    /// Into the model's own channels.
    pub channel: bool,
    /// Into an input, of the input itself (or of nothing, or of time).
    pub input: bool,
    /// Into an output, of the output itself (or of nothing, or of time).
    pub output: bool,
    /// Into a parameter.
    pub parameter: bool,
    /// Into an output, of an input (a path beside the model).
    pub feedthrough: bool,
}

/// Everything an effect declares.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectCard {
    /// Its parameters, in the order of the law's slice.
    pub parameters: Vec<EffectParameter>,
    /// States of its own.
    pub states: usize,
    /// How it is carried out.
    pub mechanism: Mechanism,
    /// What it may depend on.
    pub needs: Needs,
    /// Where it is looked for.
    pub places: Places,
    /// Sign of its first coefficient.
    pub sign: SignRule,
    /// How simple it is: the lower of two equal explanations is the headline.
    pub rank: u8,
    /// Parameters that have a fixed value where the effect acts on its own path.
    pub own_path: &'static [(&'static str, f64)],
    /// Names and units of the coordinates that it was made for, in order, an empty text standing
    /// for any; absent where it looks at the first one, whatever that is.
    pub made_for: Option<Vec<(String, String)>>,
    /// What a search and a report may rely on.
    pub properties: Properties,
}

impl EffectCard {
    /// A law with these parameters, of any coordinate into any channel.
    pub fn law(parameters: Vec<EffectParameter>) -> Self {
        Self {
            parameters,
            states: 0,
            mechanism: Mechanism::Law,
            needs: Needs::Coordinate,
            places: Places { channel: true, ..Places::default() },
            sign: SignRule::Any,
            rank: 3,
            own_path: &[],
            made_for: None,
            properties: Properties::default(),
        }
    }

    /// The same, depending on something else.
    #[must_use]
    pub fn needs(mut self, needs: Needs) -> Self {
        self.needs = needs;
        self
    }

    /// The same, looked for at other places.
    #[must_use]
    pub fn places(mut self, places: Places) -> Self {
        self.places = places;
        self
    }

    /// The same with a sign rule.
    #[must_use]
    pub fn sign(mut self, sign: SignRule) -> Self {
        self.sign = sign;
        self
    }

    /// The same for these coordinates, by name and unit, and no others; an empty text stands for
    /// any.
    #[must_use]
    pub fn made_for(mut self, coordinates: Vec<(String, String)>) -> Self {
        self.made_for = Some(coordinates);
        self
    }

    /// The same with another rank.
    #[must_use]
    pub fn rank(mut self, rank: u8) -> Self {
        self.rank = rank;
        self
    }

    /// The same with states of its own.
    #[must_use]
    pub fn states(mut self, states: usize) -> Self {
        self.states = states;
        self
    }

    /// The same, carried out by another mechanism.
    #[must_use]
    pub fn by(mut self, mechanism: Mechanism) -> Self {
        self.mechanism = mechanism;
        self
    }

    /// Value at which a parameter stands where the effect acts on its own path, if it is one of these.
    pub fn on_own_path(&self, parameter: &str) -> Option<f64> {
        self.own_path.iter().find(|(name, _)| *name == parameter).map(|(_, value)| *value)
    }

    /// Present values of the parameters.
    pub fn values(&self) -> Vec<f64> {
        self.parameters.iter().map(|parameter| parameter.value).collect()
    }

    /// Whether the values make the effect vanish.
    pub fn is_neutral(&self, values: &[f64]) -> bool {
        let coefficients =
            self.parameters.iter().zip(values).filter(|(k, _)| k.role == Role::Coefficient);
        let mut any = false;
        let mut all_zero = true;
        for (_, value) in coefficients {
            any = true;
            all_zero &= *value == 0.0;
        }
        if any && all_zero {
            return true;
        }
        let shapes = || self.parameters.iter().zip(values).filter(|(k, _)| k.role == Role::Shape);
        let with_neutral = shapes().filter(|(k, _)| k.neutral.is_some()).count();
        with_neutral > 0
            && shapes().all(|(k, value)| k.neutral.is_none_or(|neutral| neutral == *value))
    }
}

/// What the named coordinate of a cause is, for the sentence.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Named {
    /// Quantity of the coordinate, if known.
    pub quantity: Option<Quantity>,
    /// Whether the effect acts on its own path (an actuator, a sensor).
    pub own_path: bool,
    /// Whether nothing says what the coordinate is: it has no unit and no quantity, as a state of a
    /// model made from records. Words of physics would not be true of it.
    pub bare: bool,
}

impl Named {
    /// Whether the coordinate is a velocity.
    pub fn is_velocity(&self) -> bool {
        self.quantity.as_ref().is_some_and(Quantity::is_velocity)
    }
}
