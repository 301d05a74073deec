//! Expressions joined into one graph in which nothing is computed twice.

use std::collections::HashMap;

use super::error::Located;
use super::expression::{Expression, Node, Operator};
use super::function::{Function, Pair};

/// Position of a term in a [`Graph`].
pub type Id = usize;

/// One value. Terms that it is made of come before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Term {
    /// A number, by its bits.
    Constant(u64),
    /// Time in s.
    Time,
    /// Parameter number.
    Theta(usize),
    /// State number.
    State(usize),
    /// Input number.
    Input(usize),
    /// What enters own channel number.
    Channel(usize),
    /// What the derivative along law number is worth, on the way back.
    Weight(usize),
    /// -a.
    Negative(Id),
    /// a + b.
    Add(Id, Id),
    /// a - b.
    Subtract(Id, Id),
    /// a b.
    Multiply(Id, Id),
    /// a / b.
    Divide(Id, Id),
    /// A function of one value.
    Call(Function, Id),
    /// A function of two values.
    CallPair(Pair, Id, Id),
}

impl Term {
    /// The terms that it is made of.
    pub fn parts(self) -> [Option<Id>; 2] {
        match self {
            Self::Constant(_)
            | Self::Time
            | Self::Theta(_)
            | Self::State(_)
            | Self::Input(_)
            | Self::Channel(_)
            | Self::Weight(_) => [None, None],
            Self::Negative(a) | Self::Call(_, a) => [Some(a), None],
            Self::Add(a, b)
            | Self::Subtract(a, b)
            | Self::Multiply(a, b)
            | Self::Divide(a, b)
            | Self::CallPair(_, a, b) => [Some(a), Some(b)],
        }
    }
}

/// Whole powers up to this are repeated multiplications; beyond it the general power is
/// both faster and closer.
pub const WHOLE_POWERS: f64 = 64.0;

/// Terms, each different from all others.
///
/// Every simplification keeps the value to the last bit, but for three that the field
/// expects: whole powers are products (as [`Real::powi`](crate::real::Real::powi)), a power of 1/2 is a root, and
/// what varies is not divided by parameters but multiplied by their inverse, which is
/// computed once per run.
#[derive(Debug, Clone, Default)]
pub struct Graph {
    terms: Vec<Term>,
    /// Whether each term is made of numbers and parameters alone.
    still: Vec<bool>,
    known: HashMap<Term, Id>,
}

impl Graph {
    /// All terms, parts before wholes.
    pub fn terms(&self) -> &[Term] {
        &self.terms
    }

    /// The position of a term, which is added if it is new.
    pub fn add(&mut self, term: Term) -> Id {
        let term = match term {
            // a sum is the same from both sides, to the last bit
            Term::Add(a, b) => Term::Add(a.min(b), a.max(b)),
            Term::Multiply(a, b) => Term::Multiply(a.min(b), a.max(b)),
            other => other,
        };
        if let Some(&id) = self.known.get(&term) {
            return id;
        }
        self.still.push(match term {
            Term::Constant(_) | Term::Theta(_) => true,
            Term::Time | Term::State(_) | Term::Input(_) | Term::Channel(_) | Term::Weight(_) => {
                false
            }
            _ => term.parts().into_iter().flatten().all(|part| self.is_still(part)),
        });
        self.terms.push(term);
        self.known.insert(term, self.terms.len() - 1);
        self.terms.len() - 1
    }

    /// Whether a term is made of numbers and parameters alone.
    pub fn is_still(&self, id: Id) -> bool {
        self.still.get(id).copied().unwrap_or_default()
    }

    /// The first input that a term is made of.
    pub fn input_within(&self, id: Id) -> Option<usize> {
        match self.terms[id] {
            Term::Input(number) => Some(number),
            term => term.parts().into_iter().flatten().find_map(|part| self.input_within(part)),
        }
    }

    /// What follows from the parameters alone and is needed for these terms: the largest
    /// such parts, each once.
    pub fn derived(&self, roots: &[Id]) -> Vec<Id> {
        let mut needed = vec![false; self.terms.len()];
        let mut derived = vec![false; self.terms.len()];
        roots.iter().for_each(|&root| needed[root] = true);
        for id in (0..self.terms.len()).rev() {
            if !needed[id] {
                continue;
            }
            let parts = self.terms[id].parts().into_iter().flatten();
            if !self.still[id] {
                parts.for_each(|part| needed[part] = true);
            } else if parts.count() > 0 {
                derived[id] = true;
            }
        }
        (0..self.terms.len()).filter(|&id| derived[id]).collect()
    }

    /// The term of a number.
    pub fn constant(&mut self, value: f64) -> Id {
        self.add(Term::Constant(value.to_bits()))
    }

    /// The value of a term that is a number.
    pub fn value(&self, id: Id) -> Option<f64> {
        match self.terms.get(id) {
            Some(Term::Constant(bits)) => Some(f64::from_bits(*bits)),
            _ => None,
        }
    }

    /// -a.
    pub fn negative(&mut self, a: Id) -> Id {
        match (self.value(a), self.terms.get(a)) {
            (Some(value), _) => self.constant(-value),
            (_, Some(&Term::Negative(inside))) => inside,
            _ => self.add(Term::Negative(a)),
        }
    }

    /// a with b, by an operator.
    pub fn binary(&mut self, operator: Operator, a: Id, b: Id) -> Id {
        let negated = match self.terms.get(b) {
            Some(&Term::Negative(inside)) => Some(inside),
            _ => None,
        };
        match (operator, self.value(a), self.value(b)) {
            (Operator::Power, ..) => self.power(a, b),
            (Operator::Add, Some(x), Some(y)) => self.constant(x + y),
            (Operator::Subtract, Some(x), Some(y)) => self.constant(x - y),
            (Operator::Multiply, Some(x), Some(y)) => self.constant(x * y),
            (Operator::Divide, Some(x), Some(y)) => self.constant(x / y),
            (Operator::Multiply | Operator::Divide, _, Some(1.0)) => a,
            (Operator::Multiply, Some(1.0), _) => b,
            (Operator::Add, ..) => match negated {
                Some(inside) => self.add(Term::Subtract(a, inside)),
                None => self.add(Term::Add(a, b)),
            },
            (Operator::Subtract, ..) => match negated {
                Some(inside) => self.add(Term::Add(a, inside)),
                None => self.add(Term::Subtract(a, b)),
            },
            (Operator::Multiply, ..) => self.add(Term::Multiply(a, b)),
            // dividing by a power of two is exact either way
            (Operator::Divide, _, Some(y)) if is_power_of_two(y) => {
                let inverse = self.constant(1.0 / y);
                self.add(Term::Multiply(a, inverse))
            }
            (Operator::Divide, _, None) if self.is_still(b) && !self.is_still(a) => {
                let one = self.constant(1.0);
                let inverse = self.add(Term::Divide(one, b));
                self.add(Term::Multiply(a, inverse))
            }
            (Operator::Divide, ..) => self.add(Term::Divide(a, b)),
        }
    }

    /// a to the power of b.
    pub fn power(&mut self, a: Id, b: Id) -> Id {
        match self.value(b) {
            Some(n) if n.fract() == 0.0 && n.abs() <= WHOLE_POWERS => self.whole_power(a, n as i32),
            Some(0.5) => self.call(Function::Sqrt, a),
            _ => self.call_pair(Pair::Pow, a, b),
        }
    }

    /// The multiplications of [`Real::powi`](crate::real::Real::powi), in its order.
    fn whole_power(&mut self, mut base: Id, exponent: i32) -> Id {
        let mut left = exponent.unsigned_abs();
        let mut result = None;
        while left > 0 {
            if left & 1 == 1 {
                result = Some(match result {
                    Some(so_far) => self.binary(Operator::Multiply, so_far, base),
                    None => base,
                });
            }
            left >>= 1;
            if left > 0 {
                base = self.binary(Operator::Multiply, base, base);
            }
        }
        let one = self.constant(1.0);
        let result = result.unwrap_or(one);
        if exponent < 0 { self.binary(Operator::Divide, one, result) } else { result }
    }

    /// A function of one term.
    pub fn call(&mut self, function: Function, a: Id) -> Id {
        match self.value(a) {
            Some(value) => self.constant(function.of(value)),
            None => self.add(Term::Call(function, a)),
        }
    }

    /// A function of two terms.
    pub fn call_pair(&mut self, pair: Pair, a: Id, b: Id) -> Id {
        match (self.value(a), self.value(b)) {
            (Some(a), Some(b)) => self.constant(pair.of(a, b)),
            _ => self.add(Term::CallPair(pair, a, b)),
        }
    }

    /// Adds an expression whose names are looked up by `find`, which gets the name and the
    /// character at which it stands.
    ///
    /// # Errors
    ///
    /// The first one of `find`.
    pub fn expression(
        &mut self,
        expression: &Expression,
        mut find: impl FnMut(&mut Self, &str, usize) -> Result<Id, Located>,
    ) -> Result<Id, Located> {
        let mut ids: Vec<Id> = vec![];
        for (node, at) in expression.nodes() {
            let id = match *node {
                Node::Number(value) => self.constant(value),
                Node::Pi => self.constant(std::f64::consts::PI),
                Node::Time => self.add(Term::Time),
                Node::Name(ref name) => find(self, name, at)?,
                Node::Negative(a) => self.negative(ids[a]),
                Node::Binary(operator, a, b) => self.binary(operator, ids[a], ids[b]),
                Node::Call(function, a) => self.call(function, ids[a]),
                Node::CallPair(Pair::Pow, a, b) => self.power(ids[a], ids[b]),
                Node::CallPair(pair, a, b) => self.call_pair(pair, ids[a], ids[b]),
            };
            ids.push(id);
        }
        // a parsed expression has at least one node
        Ok(ids.last().copied().unwrap_or_else(|| self.constant(0.0)))
    }
}

/// Whether a number and its inverse are powers of two.
fn is_power_of_two(value: f64) -> bool {
    value.is_normal() && (1.0 / value).is_normal() && value.to_bits() << 12 == 0
}
