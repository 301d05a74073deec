//! What can be wrong with an effect that a model file declares.

use crate::fault::{Explain, Kind, Place};
use crate::model::equations::{Located, Problem};

/// What is wrong with a declared effect.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DefinitionProblem {
    /// An expression or a name.
    #[error("{0}")]
    Expression(Problem),
    /// A name that an effect of the library has.
    #[error("`{name}` is the name of an effect of the library")]
    Clash {
        /// The name.
        name: String,
    },
    /// A parameter that has nothing to do with the law.
    #[error("the law does not use `{name}`")]
    Unused {
        /// The parameter.
        name: String,
    },
    /// No parameter is a coefficient.
    #[error("the law has no coefficient, so that nothing makes it vanish")]
    NoCoefficient,
    /// A shape without a place to start from.
    #[error("`{name}` shapes the curve and has no `start`")]
    NoStart {
        /// The parameter.
        name: String,
    },
    /// A coefficient with a place to start from.
    #[error("`{name}` is a coefficient, and a search for coefficients starts at 0")]
    StartOfCoefficient {
        /// The parameter.
        name: String,
    },
    /// A range without values, or, for a coefficient, without 0.
    #[error("the range from {min} to {max} leaves `{name}` no value{}", if *.coefficient { " of 0" } else { "" })]
    Bounds {
        /// The parameter.
        name: String,
        /// Smallest value allowed.
        min: f64,
        /// Largest value allowed.
        max: f64,
        /// Whether it is a coefficient.
        coefficient: bool,
    },
    /// A place to start from that is not allowed.
    #[error("the start {value} is outside {min} to {max}")]
    Outside {
        /// The value.
        value: f64,
        /// Smallest value allowed.
        min: f64,
        /// Largest value allowed.
        max: f64,
    },
    /// Too many places to start from.
    #[error("all starts together are {count} combinations, and {most} are possible")]
    Starts {
        /// Combinations there are.
        count: usize,
        /// Combinations that are possible.
        most: usize,
    },
    /// A law that does not vanish.
    #[error("with every coefficient at 0 the law gives {w} at z = {z}, and must give 0")]
    NotNeutral {
        /// Coordinate.
        z: f64,
        /// What the law gives there.
        w: f64,
    },
    /// A law that gives no number.
    #[error("the law gives no number at any of {tried} values of z from -1000 to 1000")]
    NoNumber {
        /// Values tried.
        tried: usize,
    },
    /// A law that bends with its coefficients.
    #[error("the law is not proportional to its {}", if *.several { "coefficients" } else { "coefficient" })]
    NotProportional {
        /// Whether there are several.
        several: bool,
    },
}

/// Something wrong in `[effect.<name>]`.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("`{key}`: {problem}")]
pub struct DefinitionError {
    /// Key path inside the effect's table (`parameters.v0.start`); empty for the whole.
    pub key: String,
    /// First character concerned, from 0, where the fault is inside an expression, and how
    /// many are.
    pub at: Option<(usize, usize)>,
    /// What is wrong.
    pub problem: DefinitionProblem,
}

impl DefinitionError {
    /// A problem at a key.
    pub fn new(key: impl Into<String>, problem: DefinitionProblem) -> Self {
        Self { key: key.into(), at: None, problem }
    }

    pub(super) fn inside(key: &str, located: Located) -> Self {
        let problem = DefinitionProblem::Expression(located.problem);
        Self { key: key.into(), at: Some((located.at, located.length)), problem }
    }
}

impl Explain for DefinitionError {
    fn kind(&self) -> Kind {
        Kind::Input
    }

    fn place(&self) -> Place {
        Place { key: Some(self.key.clone()), ..Place::default() }
    }

    fn hint(&self) -> Option<String> {
        use DefinitionProblem as P;
        let text = match &self.problem {
            P::Expression(Problem::UnknownName { name, .. }) if name == "time" => {
                "a law sees one coordinate, `z`; write `of = \"time\"` where it is placed"
            }
            P::Expression(problem) => return problem.hint(),
            P::Clash { .. } => "choose another name; `lacuna effects` lists those taken",
            P::Unused { .. } => "remove it, or use it in the law",
            P::NoCoefficient => "multiply the law by a parameter without a `start`",
            P::NoStart { .. } => {
                "write the values from which a search begins: `start = [0.1, 1.0]`"
            }
            P::StartOfCoefficient { .. } => "remove `start`, or write `role = \"shape\"`",
            P::Bounds { coefficient: true, .. } => {
                "let the range hold 0, where the effect is absent"
            }
            P::Bounds { .. } => "exchange `min` and `max`",
            P::Outside { .. } => "change the start or the range",
            P::Starts { .. } => "give fewer starts",
            P::NotNeutral { .. } => "multiply every term of the law by a coefficient",
            P::NoNumber { .. } => "take the magnitude of what stands in `sqrt`, `log` or a power",
            P::NotProportional { .. } => {
                "give a parameter that is no factor of the law a `start`: it shapes the curve"
            }
        };
        Some(text.into())
    }
}
