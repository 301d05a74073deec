//! What can be wrong with equations, where, and what to try.

use std::fmt;

use super::token::Token;

/// What a name stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Role {
    /// An input.
    Input,
    /// A state.
    State,
    /// An output.
    Output,
    /// A variable.
    Variable,
    /// A parameter.
    Parameter,
    /// A channel.
    Channel,
    /// A coordinate.
    Coordinate,
}

impl fmt::Display for Role {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Input => "an input",
            Self::State => "a state",
            Self::Output => "an output",
            Self::Variable => "a variable",
            Self::Parameter => "a parameter",
            Self::Channel => "a channel",
            Self::Coordinate => "a coordinate",
        })
    }
}

/// What could have followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Expected {
    /// Something that has a value.
    Operand,
    /// Something between two values, or the end.
    Operator,
    /// Something between two values, or the end of what is in parentheses.
    Close,
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Operand => "a number, a name or `(`",
            Self::Operator => "an operator or the end",
            Self::Close => "an operator or `)`",
        })
    }
}

/// What is wrong. Characters are counted from 1.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Problem {
    /// Nothing but blanks.
    #[error("the expression is empty")]
    Empty,
    /// A character that means nothing.
    #[error("`{found}` has no meaning in an expression")]
    Character {
        /// The character.
        found: char,
    },
    /// Digits that are no number, or one too large for 64 bits.
    #[error("`{found}` is not a number")]
    Number {
        /// The digits.
        found: String,
    },
    /// A word at the wrong place.
    #[error("found {found}, expected {expected}")]
    Unexpected {
        /// The word.
        found: Token,
        /// What could stand there.
        expected: Expected,
    },
    /// A closing parenthesis too many.
    #[error("this `)` closes nothing")]
    Unopened,
    /// A parenthesis that is not closed.
    #[error("found {found}, but the `(` at character {opened} is not closed")]
    Unclosed {
        /// Character of the opening parenthesis, from 1.
        opened: usize,
        /// What stands where it could have been closed.
        found: Token,
    },
    /// A name that is not declared.
    #[error("unknown name `{name}`")]
    UnknownName {
        /// The name.
        name: String,
        /// Names that could stand there.
        known: Vec<String>,
    },
    /// A name that is declared and has no value in expressions.
    #[error("`{name}` is {role}, whose value expressions cannot use")]
    NotUsable {
        /// The name.
        name: String,
        /// What it is.
        role: Role,
    },
    /// A variable used before it is declared, or by itself.
    #[error("the variable `{name}` is used before it is declared")]
    TooEarly {
        /// The variable.
        name: String,
    },
    /// A name with parentheses that is no function.
    #[error("unknown function `{name}`")]
    UnknownFunction {
        /// The name.
        name: String,
    },
    /// A declared name with parentheses.
    #[error("`{name}` is {role}, not a function")]
    NotAFunction {
        /// The name.
        name: String,
        /// What it is.
        role: Role,
    },
    /// A function without parentheses.
    #[error("the function `{function}` has no arguments")]
    NoArguments {
        /// The function.
        function: &'static str,
    },
    /// A function with too many or too few arguments.
    #[error("`{function}` takes {wanted} argument{}, found {given}", if *.wanted == 1 { "" } else { "s" })]
    Arguments {
        /// The function.
        function: &'static str,
        /// How many it takes.
        wanted: usize,
        /// How many there are.
        given: usize,
    },
    /// Too many parentheses, powers or signs within each other.
    #[error("more than {limit} parentheses, powers or signs within each other")]
    TooDeep {
        /// How many are possible.
        limit: usize,
    },
    /// A text that cannot be a name.
    #[error("`{found}` cannot be a name")]
    Name {
        /// The text.
        found: String,
    },
    /// A declared name that the language has taken.
    #[error("`{name}` is reserved")]
    Reserved {
        /// The name.
        name: String,
    },
    /// A name declared twice.
    #[error("`{name}` already names {first} (`{first_key}`)")]
    Twice {
        /// The name.
        name: String,
        /// What it names first.
        first: Role,
        /// Where it is declared first.
        first_key: String,
    },
    /// A coordinate that shares a name with something of another value.
    #[error("the coordinate `{name}` has another value than {first} of the same name")]
    OtherValue {
        /// The name.
        name: String,
        /// What else it names.
        first: Role,
    },
    /// A parameter or initial value that is no finite number.
    #[error("{value} is not a finite number")]
    NotFinite {
        /// The value.
        value: f64,
    },
    /// A range without values.
    #[error("`min` = {min} is above `max` = {max}")]
    Bounds {
        /// Smallest value allowed.
        min: f64,
        /// Largest value allowed.
        max: f64,
    },
    /// A parameter outside its range.
    #[error("the value {value} is outside {min} to {max}")]
    Outside {
        /// The value.
        value: f64,
        /// Smallest value allowed.
        min: f64,
        /// Largest value allowed.
        max: f64,
    },
    /// A state with `derivative` after one with `next`, or the other way round.
    #[error("`{found}` beside `{first}`: a model is either continuous or discrete")]
    Mixed {
        /// The key found.
        found: &'static str,
        /// The key of the first state.
        first: &'static str,
    },
    /// A state with neither `derivative` nor `next`.
    #[error("the state `{state}` has neither `derivative` nor `next`")]
    NoLaw {
        /// The state.
        state: String,
    },
    /// A state with both `derivative` and `next`.
    #[error("the state `{state}` has both `derivative` and `next`")]
    TwoLaws {
        /// The state.
        state: String,
    },
    /// No states, or no outputs, or a channel that enters nothing.
    #[error("the list is empty")]
    NoEntries,
    /// A channel into something that is no state.
    #[error("`{state}` is not a state")]
    UnknownState {
        /// The name.
        state: String,
        /// Names of all states.
        known: Vec<String>,
    },
    /// A channel's gain that an input changes.
    #[error("the gain of a channel depends on the input `{input}`")]
    GainOfInput {
        /// The input.
        input: String,
    },
}
