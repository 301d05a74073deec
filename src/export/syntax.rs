//! How one language writes the terms of a graph.

use crate::real::{Binary, Given, Unary};

/// Text of a term, and whether it can be an operand without parentheses.
pub type Text = (String, bool);

/// The words of a language. Operands are given so that they can stand anywhere.
pub trait Syntax {
    /// A number.
    fn constant(&self, value: f64) -> String;
    /// Something given.
    fn given(&self, given: Given) -> String;
    /// A number that was prepared from the parameters.
    fn prepared(&self, number: usize) -> String;
    /// The name of a function of one argument; `None` for the sign of a negative.
    fn function(&self, function: Unary) -> &'static str;
    /// The name of a function of two arguments; `None` for an operator.
    fn pair(&self, function: Binary) -> &'static str;
    /// `yes` where `a` is above zero, else `no`.
    fn choice(&self, a: &str, yes: &str, no: &str) -> Text;
    /// A call to the helper that reads a delay line.
    fn past(&self, helper: &str, line: u32, arguments: &[&str]) -> String;
    /// The statement that gives a name to a value.
    fn name(&self, name: &str, value: &str) -> String;

    /// A function of one argument.
    fn one(&self, function: Unary, a: &str) -> Text {
        match function {
            Unary::Negative => (format!("-{a}"), false),
            _ => (format!("{}({a})", self.function(function)), true),
        }
    }

    /// A function of two arguments.
    fn two(&self, function: Binary, a: &str, b: &str) -> Text {
        let operator = match function {
            Binary::Add => "+",
            Binary::Subtract => "-",
            Binary::Multiply => "*",
            Binary::Divide => "/",
            _ => return (format!("{}({a}, {b})", self.pair(function)), true),
        };
        (format!("{a} {operator} {b}"), false)
    }
}

/// A number that reads back as the same, negative ones in parentheses.
pub fn number(value: f64, infinity: &str, nan: &str) -> String {
    let size = if value.is_nan() {
        nan.to_string()
    } else if value.is_infinite() {
        infinity.to_string()
    } else {
        format!("{:?}", value.abs())
    };
    if value.is_sign_negative() && !value.is_nan() { format!("(-{size})") } else { size }
}
