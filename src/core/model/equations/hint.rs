//! What to try when equations are wrong.

use super::function;
use super::problem::{Expected, Problem};
use super::token::Token;
use crate::fault::nearest;

/// Functions that go by another name elsewhere.
const ELSEWHERE: &[(&str, &str)] = &[
    ("ln", "write `log(x)`"),
    ("log10", "write `log(x)/log(10)`"),
    ("log2", "write `log(x)/log(2)`"),
    ("arcsin", "write `asin(x)`"),
    ("arccos", "write `acos(x)`"),
    ("arctan", "write `atan(x)`"),
    ("fabs", "write `abs(x)`"),
    ("sgn", "write `sign(x)`"),
    ("signum", "write `sign(x)`"),
    ("sqr", "write `x^2`"),
    ("cbrt", "write `sign(x)*abs(x)^(1/3)`"),
    ("sec", "write `1/cos(x)`"),
    ("cot", "write `1/tan(x)`"),
    ("heaviside", "write `(1 + sign(x))/2`"),
    ("saturate", "write `max(low, min(high, x))`"),
    ("clip", "write `max(low, min(high, x))`"),
    ("clamp", "write `max(low, min(high, x))`"),
];

/// The known names, the nearest one first.
fn among<'a>(wanted: &str, known: impl Iterator<Item = &'a str> + Clone) -> String {
    let list = known.clone().collect::<Vec<_>>().join(", ");
    match nearest(wanted, known) {
        Some(near) => format!("did you mean `{near}`? There are: {list}"),
        None if list.is_empty() => "declare it among `parameters` or `variables`".into(),
        None => format!("there are: {list}"),
    }
}

impl Problem {
    /// The known name that was probably meant.
    pub fn near(&self) -> Option<String> {
        match self {
            Self::UnknownName { name, known } | Self::UnknownState { state: name, known } => {
                nearest(name, known.iter().map(String::as_str))
            }
            Self::UnknownFunction { name } => nearest(name, function::names()),
            _ => None,
        }
    }

    /// What to try.
    pub fn hint(&self) -> Option<String> {
        let text = match self {
            Self::Empty => "write an expression, `0` for nothing",
            Self::Character { found: '[' | ']' | '{' | '}' } => "use parentheses: ( )",
            Self::Character { found: '=' } => "write only the right-hand side",
            Self::Character { .. } => "operators are + - * / ^ and parentheses",
            Self::Number { .. } => "write numbers like 12, 0.5 or 1e-3",
            Self::Unexpected { found: Token::Star, expected: Expected::Operand } => {
                "a power is written `x^2`"
            }
            Self::Unexpected { found: Token::End, .. } => "write the missing operand",
            Self::Unexpected { found: Token::Comma, .. } => "decimals need a point, not a comma",
            Self::Unexpected { expected: Expected::Operand, .. } => "write the missing operand",
            Self::Unexpected { .. } => "write `*` between the factors of a product",
            Self::Unopened => "remove it, or write the missing `(`",
            Self::Unclosed { .. } => "write the missing `)`",
            Self::UnknownName { name, known } => {
                return Some(among(name, known.iter().map(String::as_str)));
            }
            Self::UnknownState { state, known } => {
                return Some(among(state, known.iter().map(String::as_str)));
            }
            Self::GainOfInput { .. } => {
                "use parameters and states only; what depends on an input is a law of the effect"
            }
            Self::UnknownFunction { name } => {
                let elsewhere = ELSEWHERE.iter().find(|(other, _)| other == name);
                return Some(match elsewhere {
                    Some((_, text)) => (*text).into(),
                    None => among(name, function::names().collect::<Vec<_>>().into_iter()),
                });
            }
            Self::NotUsable { .. } => "use inputs, states, parameters, variables and `time`",
            Self::TooEarly { .. } => "move it up: variables use only those above them",
            Self::NotAFunction { name, .. } => {
                return Some(format!("write `{name}*(...)` for a product"));
            }
            Self::NoArguments { function } => return Some(format!("write `{function}(...)`")),
            Self::Arguments { .. } => "separate arguments by commas, decimals need a point",
            Self::TooDeep { .. } => "name a part of it in `variables`",
            Self::Name { .. } => {
                "a name is made of letters, digits and `_`, and does not begin with a digit"
            }
            Self::Reserved { .. } => {
                "functions, `pi` and `time` cannot be declared; choose another name"
            }
            Self::Twice { .. } => {
                "choose another name; only a coordinate may share one, with a state, input or output of the same value"
            }
            Self::OtherValue { .. } => "choose another name, or make the two mean the same",
            Self::NotFinite { .. } => {
                "write a finite number; leave `min` or `max` out for no bound"
            }
            Self::Bounds { .. } => "exchange `min` and `max`",
            Self::Outside { .. } => "change the value or its bounds",
            Self::Mixed { .. } => "use `derivative` for all states, or `next` for all",
            Self::NoLaw { .. } => {
                "write `derivative = \"...\"`, or `next = \"...\"` for a discrete model"
            }
            Self::TwoLaws { .. } => "keep one of them",
            Self::NoEntries => "write at least one entry",
        };
        Some(text.into())
    }
}
