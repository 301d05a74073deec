//! A number that writes down what is done with it.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use super::tape::{Binary, Given, Node, Tape, Term, Unary};
use super::{InRegisters, Real};

/// A number with a value and, while a [`Tape`] is recorded, a term on it.
///
/// What multiplies by 0 or 1 or adds 0 leaves no term: recorded laws take such a product as 0
/// where the other factor is infinite or not a number.
#[derive(Debug, Clone, Copy)]
pub struct Trace {
    value: f64,
    /// `None` for a constant.
    node: Option<Node>,
}

impl Trace {
    /// Something that is given from outside, at present with this value.
    pub fn given(what: Given, value: f64) -> Self {
        Self { value, node: Tape::note(|_| Term::Given(what)) }
    }

    /// The value that it has while it is recorded.
    pub fn value(self) -> f64 {
        self.value
    }

    /// Its term on a tape that has been recorded; `None` for a constant.
    pub fn node(self, tape: &Tape) -> Option<Node> {
        self.node.filter(|&node| (node as usize) < tape.terms().len())
    }

    /// Its term on the tape that is being recorded, a constant's too.
    pub(crate) fn noted(self) -> Option<Node> {
        self.node.or_else(|| Tape::note(|_| Term::Constant(self.value.to_bits())))
    }

    fn on(self, tape: &mut Tape) -> Node {
        self.node.unwrap_or_else(|| tape.add(Term::Constant(self.value.to_bits())))
    }

    fn is(self, constant: f64) -> bool {
        self.node.is_none() && self.value == constant
    }

    fn one(self, function: Unary, value: f64) -> Self {
        let node = self.node.and_then(|a| Tape::note(|_| Term::One(function, a)));
        Self { value, node }
    }

    fn two(self, function: Binary, other: Self) -> Self {
        let value = function.of(self.value, other.value);
        if self.node.is_none() && other.node.is_none() {
            return Self::constant(value);
        }
        match function {
            Binary::Add if self.is(0.0) => return other,
            Binary::Add | Binary::Subtract if other.is(0.0) => return self,
            Binary::Subtract if self.is(0.0) => return -other,
            Binary::Multiply if self.is(1.0) => return other,
            Binary::Multiply | Binary::Divide if other.is(1.0) => return self,
            Binary::Multiply if self.is(-1.0) => return -other,
            Binary::Multiply if other.is(-1.0) => return -self,
            Binary::Multiply if self.is(0.0) || other.is(0.0) => return Self::constant(0.0),
            Binary::Divide if self.is(0.0) => return Self::constant(0.0),
            _ => {}
        }
        let term = |tape: &mut Tape| Term::Two(function, self.on(tape), other.on(tape));
        Self { value, node: Tape::note(term) }
    }

    /// What leaves a delay line that it enters now: the mean over the step of what entered
    /// `back` steps ago, each value held for a step, `depth` steps at most.
    ///
    /// `value` is what it is at present.
    pub fn held_past(self, depth: usize, back: Self, value: f64) -> Self {
        let line = Tape::line(depth, |tape| self.on(tape));
        let node = line.and_then(|line| {
            Tape::note(|tape| Term::PastHeld { line, back: back.on(tape), now: self.on(tape) })
        });
        Self { value, node }
    }

    /// The same for values joined by straight lines, `ats` steps from now on; `end` is what
    /// will have been reached one step from now.
    pub fn line_past<const N: usize>(
        self,
        depth: usize,
        ats: [Self; N],
        end: Self,
        values: [f64; N],
    ) -> [Self; N] {
        let line = Tape::line(depth, |tape| self.on(tape));
        std::array::from_fn(|i| {
            let node = line.and_then(|line| {
                Tape::note(|tape| Term::PastLine {
                    line,
                    at: ats[i].on(tape),
                    now: self.on(tape),
                    end: end.on(tape),
                })
            });
            Self { value: values[i], node }
        })
    }
}

macro_rules! operators {
    ($($trait:ident $method:ident $function:ident,)*) => {$(
        impl $trait for Trace {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                self.two(Binary::$function, other)
            }
        }
        impl $trait<f64> for Trace {
            type Output = Self;
            fn $method(self, other: f64) -> Self {
                self.two(Binary::$function, Self::constant(other))
            }
        }
    )*};
}

operators! {
    Add add Add,
    Sub sub Subtract,
    Mul mul Multiply,
    Div div Divide,
}

macro_rules! assigning {
    ($($trait:ident $method:ident $op:tt,)*) => {$(
        impl $trait for Trace {
            #[allow(clippy::assign_op_pattern)] // the operator is an argument
            fn $method(&mut self, other: Self) {
                *self = *self $op other;
            }
        }
    )*};
}

assigning! {
    AddAssign add_assign +,
    SubAssign sub_assign -,
    MulAssign mul_assign *,
}

impl Neg for Trace {
    type Output = Self;
    fn neg(self) -> Self {
        self.one(Unary::Negative, -self.value)
    }
}

macro_rules! functions {
    ($($method:ident $function:ident,)*) => {$(
        fn $method(self) -> Self {
            self.one(Unary::$function, self.value.$method())
        }
    )*};
}

impl Real for Trace {
    fn constant(value: f64) -> Self {
        Self { value, node: None }
    }

    functions! {
        sin Sin,
        cos Cos,
        tan Tan,
        asin Asin,
        acos Acos,
        atan Atan,
        sinh Sinh,
        cosh Cosh,
        tanh Tanh,
        exp Exp,
        ln Ln,
        sqrt Sqrt,
        abs Abs,
    }

    // `f64` has another one of that name
    fn signum(self) -> Self {
        self.one(Unary::Signum, Real::signum(self.value))
    }
    fn atan2(self, x: Self) -> Self {
        self.two(Binary::Atan2, x)
    }
    fn min(self, other: Self) -> Self {
        self.two(Binary::Min, other)
    }
    fn max(self, other: Self) -> Self {
        self.two(Binary::Max, other)
    }
    fn powf(self, exponent: Self) -> Self {
        self.two(Binary::Power, exponent)
    }
    fn where_positive(self, yes: Self, no: Self) -> Self {
        let value = if self.value > 0.0 { yes.value } else { no.value };
        if self.node.is_none() {
            return if self.value > 0.0 { yes } else { no };
        }
        let term = |tape: &mut Tape| Term::Choice(self.on(tape), yes.on(tape), no.on(tape));
        Self { value, node: Tape::note(term) }
    }
}

impl InRegisters for Trace {
    type Plain = Self;
    type Avx512 = Self;
    type Avx2 = Self;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_terms_are_there_once_and_what_is_known_is_computed() {
        let (y, tape) = Tape::record(|| {
            let (a, x) =
                (Trace::given(Given::Parameter(0), 3.0), Trace::given(Given::State(0), 2.0));
            let two = Trace::constant(1.0) + 1.0;
            let nothing = x * 0.0;
            let y = (a * x + nothing) * 1.0;
            y * two + (a * x).powi(2)
        });
        assert_eq!(y.value(), 48.0);
        // a, x, a x, the constant 2, twice it, its square, the sum
        assert_eq!(tape.terms().len(), 7, "{:?}", tape.terms());
    }

    #[test]
    fn choices_keep_both_sides_and_the_value_of_one() {
        let (y, tape) = Tape::record(|| {
            let x = Trace::given(Given::State(0), -2.0);
            x.where_positive(x, -x)
        });
        assert_eq!(y.value(), 2.0);
        assert!(matches!(tape.terms().last(), Some(Term::Choice(0, 0, 1))));
    }

    #[test]
    fn outside_a_recording_there_is_only_the_value() {
        let x = Trace::given(Given::State(0), 0.25);
        assert_eq!(x.sqrt().value(), 0.5);
        assert_eq!(x.node(&Tape::default()), None);
    }
}
