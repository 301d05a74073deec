//! Two numbers side by side.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use super::Fuse;
use crate::real::Real;

/// Two numbers, each treated as a single one would be: while the processor waits for the
/// result of one it computes the other.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct Pair<R>(R, R);

macro_rules! operators {
    ($($trait:ident $method:ident $assign_trait:ident $assign:ident),*) => {$(
        operators!(@ $trait $method);
        impl<R: Real> $assign_trait for Pair<R> {
            #[inline(always)]
            fn $assign(&mut self, other: Self) {
                *self = self.$method(other);
            }
        }
    )*};
    (@ $trait:ident $method:ident) => {
        impl<R: Real> $trait for Pair<R> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0), self.1.$method(other.1))
            }
        }
        impl<R: Real> $trait<f64> for Pair<R> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                Self(self.0.$method(other), self.1.$method(other))
            }
        }
    };
}

operators!(Add add AddAssign add_assign, Sub sub SubAssign sub_assign, Mul mul MulAssign mul_assign);
operators!(@ Div div);

impl<R: Real> Neg for Pair<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}

macro_rules! functions {
    ($($one:ident),*; $($two:ident),*) => {
        $(#[inline(always)]
        fn $one(self) -> Self {
            Self(self.0.$one(), self.1.$one())
        })*
        $(#[inline(always)]
        fn $two(self, other: Self) -> Self {
            Self(self.0.$two(other.0), self.1.$two(other.1))
        })*
    };
}

impl<R: Real> Real for Pair<R> {
    functions!(sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, exp, ln, sqrt, abs, signum;
               atan2, min, max, powf);

    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self(R::constant(value), R::constant(value))
    }
    #[inline(always)]
    fn where_positive(self, yes: Self, no: Self) -> Self {
        Self(self.0.where_positive(yes.0, no.0), self.1.where_positive(yes.1, no.1))
    }
}

impl<R: Fuse> Fuse for Pair<R> {
    #[inline(always)]
    fn fma(self, b: Self, c: Self) -> Self {
        Self(self.0.fma(b.0, c.0), self.1.fma(b.1, c.1))
    }
    #[inline(always)]
    fn fms(self, b: Self, c: Self) -> Self {
        Self(self.0.fms(b.0, c.0), self.1.fms(b.1, c.1))
    }
    #[inline(always)]
    fn fnma(self, b: Self, c: Self) -> Self {
        Self(self.0.fnma(b.0, c.0), self.1.fnma(b.1, c.1))
    }
}
