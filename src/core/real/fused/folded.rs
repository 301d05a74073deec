//! A number that knows what kind it is.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use super::Fuse;
use crate::real::Real;

/// What is known about a number while compiling.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// It is 0: adding it costs nothing, multiplying by it gives 0 (of infinity, too).
    Zero,
    /// It is 1.
    One,
    /// Nothing.
    Plain,
    /// It is `a * b`, and has not been computed before it is looked at.
    Product,
    /// It stays the same throughout, and one over it is `b`.
    Parameter,
}

/// A number that knows what kind it is. In straight formulas the compiler knows as well, and
/// nothing is left of `kind`.
#[derive(Debug, Clone, Copy)]
pub struct Folded<R> {
    value: R,
    a: R,
    b: R,
    kind: Kind,
}

impl<R: Fuse> Folded<R> {
    #[inline(always)]
    fn of(value: R, kind: Kind) -> Self {
        Self { value, a: value, b: value, kind }
    }

    /// A number of which nothing is known.
    #[inline(always)]
    pub fn plain(value: R) -> Self {
        Self::of(value, Kind::Plain)
    }

    /// A number that stays the same throughout, so that dividing by it is multiplying.
    #[inline(always)]
    pub fn parameter(value: R) -> Self {
        Self { b: R::constant(1.0) / value, ..Self::of(value, Kind::Parameter) }
    }

    /// 0.
    #[inline(always)]
    pub fn zero() -> Self {
        Self::of(R::constant(0.0), Kind::Zero)
    }

    /// 1.
    #[inline(always)]
    pub fn one() -> Self {
        Self::of(R::constant(1.0), Kind::One)
    }

    /// The number itself.
    #[inline(always)]
    pub fn value(self) -> R {
        self.value
    }

    /// The number itself, of which nothing is known any more.
    #[inline(always)]
    pub fn settled(self) -> Self {
        Self::plain(self.value)
    }

    #[inline(always)]
    fn product(a: R, b: R) -> Self {
        Self { value: a * b, a, b, kind: Kind::Product }
    }
}

impl<R: Fuse> Add for Folded<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, y: Self) -> Self {
        match (self.kind, y.kind) {
            (Kind::Zero, _) => y,
            (_, Kind::Zero) => self,
            (Kind::Product, _) => Self::plain(self.a.fma(self.b, y.value)),
            (_, Kind::Product) => Self::plain(y.a.fma(y.b, self.value)),
            _ => Self::plain(self.value + y.value),
        }
    }
}

impl<R: Fuse> Sub for Folded<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, y: Self) -> Self {
        match (self.kind, y.kind) {
            (_, Kind::Zero) => self,
            (Kind::Zero, _) => -y,
            (_, Kind::Product) => Self::plain(y.a.fnma(y.b, self.value)),
            (Kind::Product, _) => Self::plain(self.a.fms(self.b, y.value)),
            _ => Self::plain(self.value - y.value),
        }
    }
}

impl<R: Fuse> Mul for Folded<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, y: Self) -> Self {
        match (self.kind, y.kind) {
            (Kind::Zero, _) => self,
            (_, Kind::Zero) => y,
            (Kind::One, _) => y,
            (_, Kind::One) => self,
            _ => Self::product(self.value, y.value),
        }
    }
}

impl<R: Fuse> Div for Folded<R> {
    type Output = Self;
    #[inline(always)]
    fn div(self, y: Self) -> Self {
        match (self.kind, y.kind) {
            (Kind::Zero, _) | (_, Kind::One) => self,
            (Kind::One, Kind::Parameter) => Self::plain(y.b),
            (_, Kind::Parameter) => Self::product(self.value, y.b),
            _ => Self::plain(self.value / y.value),
        }
    }
}

impl<R: Fuse> Neg for Folded<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        match self.kind {
            Kind::Zero => self,
            Kind::Product => Self { value: -self.value, a: -self.a, ..self },
            _ => Self::plain(-self.value),
        }
    }
}

macro_rules! by_constant {
    ($($trait:ident $method:ident),*) => {$(
        impl<R: Fuse> $trait<f64> for Folded<R> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                self.$method(Self::plain(R::constant(other)))
            }
        }
    )*};
}

by_constant!(Add add, Sub sub, Mul mul, Div div);

macro_rules! assigned {
    ($($trait:ident $method:ident $by:ident),*) => {$(
        impl<R: Fuse> $trait for Folded<R> {
            #[inline(always)]
            fn $method(&mut self, other: Self) {
                *self = self.$by(other);
            }
        }
    )*};
}

assigned!(AddAssign add_assign add, SubAssign sub_assign sub, MulAssign mul_assign mul);

macro_rules! functions {
    ($($one:ident),*; $($two:ident),*) => {
        $(#[inline(always)]
        fn $one(self) -> Self {
            Self::plain(self.value.$one())
        })*
        $(#[inline(always)]
        fn $two(self, other: Self) -> Self {
            Self::plain(self.value.$two(other.value))
        })*
    };
}

impl<R: Fuse> Real for Folded<R> {
    functions!(sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, exp, ln, sqrt, abs, signum;
               atan2, min, max, powf);

    #[inline(always)]
    fn constant(value: f64) -> Self {
        if value == 0.0 {
            Self::zero()
        } else if value == 1.0 {
            Self::one()
        } else {
            Self::plain(R::constant(value))
        }
    }
    #[inline(always)]
    fn where_positive(self, yes: Self, no: Self) -> Self {
        match (yes.kind, no.kind) {
            (Kind::Zero, Kind::Zero) => yes,
            _ => Self::plain(self.value.where_positive(yes.value, no.value)),
        }
    }
    #[inline(always)]
    fn powi(self, exponent: i32) -> Self {
        // spelled out, because a loop is seen through too late
        match exponent {
            0 => Self::one(),
            1 => self,
            2 => self * self,
            3 => self * self * self,
            4 => {
                let square = self * self;
                square * square
            }
            _ => Self::plain(self.value.powi(exponent)),
        }
    }
}
