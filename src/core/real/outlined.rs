//! Blocks whose operations are calls: the fallback for x86-64 processors without AVX2.
//!
//! A kernel over [`Lanes`](super::Lanes) unrolls every operation over eight or sixteen numbers.
//! Where no registers take them, that text is long and no faster than a call per operation, so
//! here each operation is compiled once and called. The bits are those of `Lanes`.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use super::Real;

/// A block of numbers, with the layout of `L`, whose operations are calls.
#[derive(Debug, Clone, Copy)]
#[repr(transparent)]
pub struct Outlined<L>(L);

macro_rules! binary {
    ($($trait:ident $method:ident),*) => {$(
        impl<L: Real> $trait for Outlined<L> {
            type Output = Self;
            #[inline(never)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }
        impl<L: Real> $trait<f64> for Outlined<L> {
            type Output = Self;
            #[inline(never)]
            fn $method(self, other: f64) -> Self {
                Self(self.0.$method(other))
            }
        }
    )*};
}

binary!(Add add, Sub sub, Mul mul, Div div);

macro_rules! assign {
    ($($trait:ident $method:ident),*) => {$(
        impl<L: Real> $trait for Outlined<L> {
            #[inline(never)]
            fn $method(&mut self, other: Self) {
                self.0.$method(other.0);
            }
        }
    )*};
}

assign!(AddAssign add_assign, SubAssign sub_assign, MulAssign mul_assign);

impl<L: Real> Neg for Outlined<L> {
    type Output = Self;
    #[inline(never)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

macro_rules! functions {
    ($($one:ident),*; $($two:ident),*) => {
        $(#[inline(never)]
        fn $one(self) -> Self {
            Self(self.0.$one())
        })*
        $(#[inline(never)]
        fn $two(self, other: Self) -> Self {
            Self(self.0.$two(other.0))
        })*
    };
}

impl<L: Real> Real for Outlined<L> {
    functions!(sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, exp, ln, sqrt, abs, signum;
               atan2, powf, min, max);

    #[inline(never)]
    fn constant(value: f64) -> Self {
        Self(L::constant(value))
    }
    #[inline(never)]
    fn where_positive(self, yes: Self, no: Self) -> Self {
        Self(self.0.where_positive(yes.0, no.0))
    }
    #[inline(never)]
    fn powi(self, exponent: i32) -> Self {
        Self(self.0.powi(exponent))
    }
}
