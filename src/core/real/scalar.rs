//! A single `f64`. (A single `f32` is [`Lanes<f32, 1>`](super::Lanes).)

use super::{Real, elementary};

impl Real for f64 {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn sin(self) -> Self {
        elementary::sin([self])[0]
    }
    #[inline(always)]
    fn cos(self) -> Self {
        elementary::cos([self])[0]
    }
    #[inline(always)]
    fn tan(self) -> Self {
        elementary::tan([self])[0]
    }
    #[inline(always)]
    fn asin(self) -> Self {
        elementary::asin([self])[0]
    }
    #[inline(always)]
    fn acos(self) -> Self {
        elementary::acos([self])[0]
    }
    #[inline(always)]
    fn atan(self) -> Self {
        elementary::atan([self])[0]
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        elementary::atan2([self], [x])[0]
    }
    #[inline(always)]
    fn sinh(self) -> Self {
        elementary::sinh([self])[0]
    }
    #[inline(always)]
    fn cosh(self) -> Self {
        elementary::cosh([self])[0]
    }
    #[inline(always)]
    fn tanh(self) -> Self {
        elementary::tanh([self])[0]
    }
    #[inline(always)]
    fn exp(self) -> Self {
        elementary::exp([self])[0]
    }
    #[inline(always)]
    fn ln(self) -> Self {
        elementary::ln([self])[0]
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn signum(self) -> Self {
        elementary::sign(self)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        elementary::smaller(self, other)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        elementary::larger(self, other)
    }
    #[inline(always)]
    fn powf(self, exponent: Self) -> Self {
        elementary::pow([self], [exponent])[0]
    }
    #[inline(always)]
    fn where_positive(self, yes: Self, no: Self) -> Self {
        if self > 0.0 { yes } else { no }
    }
}
