//! What a search and a report may rely on of an effect, declared by the effect itself.
//!
//! A method that asks for an effect's name knows the effects it was written for and no others; one
//! that asks for a property treats an effect from another crate as it treats its own.

/// How the size of an effect is stated in a sentence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Size {
    /// By its first coefficient; by every parameter where it has none.
    #[default]
    First,
    /// As a sin(n z) + b cos(n z): by amplitude sqrt(a^2 + b^2), order n and phase atan2(b, a).
    Wave {
        /// Name of n.
        order: &'static str,
        /// Name of a.
        sine: &'static str,
        /// Name of b.
        cosine: &'static str,
    },
    /// As the factor 1 + this parameter.
    Factor(&'static str),
    /// As a size by itself, and what is added per unit of the second coordinate.
    Growing {
        /// Name of the coefficient without it.
        unloaded: &'static str,
        /// Name of the coefficient per unit of it.
        by: &'static str,
    },
    /// By the sum of two coefficients, where a record tells the sum better than either.
    Total([&'static str; 2]),
}

/// Properties of an effect beyond its parameters and places; none of them holds by default.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Properties {
    /// It cannot leave a range on its own path: what it does to an output can be read off a record
    /// as readings that stand at their largest or smallest value.
    pub limits_output: bool,
    /// Of time it is periodic: a hum, found as a line of the residual's spectrum.
    pub periodic_in_time: bool,
    /// Straight pieces joined at bends: on one side of all bends it is a line.
    pub piecewise_linear: bool,
    /// The parameter that is half the width of the range around 0 in which it is flat or silent.
    pub flat_inside: Option<&'static str>,
    /// The parameter that only makes a step smooth enough to be integrated.
    pub smoothing_width: Option<&'static str>,
    /// The parameter that is the frequency of its own oscillation.
    pub resonance: Option<&'static str>,
    /// One number on the path of a signal, as an instrument may have wrong: of equal explanations it
    /// is preferred to laws at channels.
    pub of_an_instrument: bool,
    /// The fault of a column that is the same model, where it acts on the path of a signal: it was not the
    /// machine but its record.
    pub recorded_as: Option<&'static str>,
    /// It begins within a record: the parameter that is the moment, and the law that it is from then on.
    pub begins: Option<Begins>,
    /// It opposes a motion with a size of its own, so that its name says what it depends on.
    pub is_friction: bool,
    /// Its curve is free, or learned: it is found by other means than a law of the library.
    pub shape: ShapeOf,
    /// How its size is stated.
    pub size: Size,
}

/// What begins within a record, and when; written by [`EffectCard::begins`](super::EffectCard::begins).
#[doc(hidden)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Begins {
    /// The parameter that is the moment.
    pub from: &'static str,
    /// Name of the law that acts from then on.
    pub law: &'static str,
}

/// Where the shape of an effect is from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ShapeOf {
    /// A law with a name.
    #[default]
    Law,
    /// Values at knots.
    FreeCurve,
    /// A trained function of one or several coordinates.
    Learned,
}
