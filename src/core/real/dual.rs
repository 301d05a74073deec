//! Numbers that carry their exact derivatives along `D` directions.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use super::Real;
use super::rules::chain_rules;

/// A value and its slopes along `D` directions (forward-mode differentiation).
///
/// Over [`Lanes`](super::Lanes) each lane has its own value and slopes. Kinks follow
/// the rule stated in [the module](super).
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Dual<R, const D: usize> {
    /// The value itself.
    pub value: R,
    /// The derivative along each direction, in units of value per unit of direction.
    pub slope: [R; D],
}

impl<R: Real, const D: usize> Dual<R, D> {
    /// A value with given slopes.
    #[inline(always)]
    pub fn new(value: R, slope: [R; D]) -> Self {
        Self { value, slope }
    }

    /// A value that does not depend on anything.
    #[inline(always)]
    pub fn fixed(value: R) -> Self {
        Self { value, slope: [R::constant(0.0); D] }
    }

    /// A value that moves one to one along `direction`.
    #[inline(always)]
    pub fn along(value: R, direction: usize) -> Self {
        let mut dual = Self::fixed(value);
        dual.slope[direction] = R::constant(1.0);
        dual
    }

    /// `f(self)` given the value and the derivative of `f` there.
    #[inline(always)]
    fn chain(self, value: R, derivative: R) -> Self {
        let mut slope = self.slope;
        for s in &mut slope {
            *s *= derivative;
        }
        Self { value, slope }
    }
}

/// `yes` where `at` is above zero, else 0: keeps infinite slopes out.
#[inline(always)]
fn or_zero<R: Real>(at: R, yes: R) -> R {
    at.where_positive(yes, R::constant(0.0))
}

impl<R: Real, const D: usize> Add for Dual<R, D> {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}

impl<R: Real, const D: usize> AddAssign for Dual<R, D> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        self.value += other.value;
        for d in 0..D {
            self.slope[d] += other.slope[d];
        }
    }
}

impl<R: Real, const D: usize> Sub for Dual<R, D> {
    type Output = Self;
    #[inline(always)]
    fn sub(mut self, other: Self) -> Self {
        self -= other;
        self
    }
}

impl<R: Real, const D: usize> SubAssign for Dual<R, D> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        self.value -= other.value;
        for d in 0..D {
            self.slope[d] -= other.slope[d];
        }
    }
}

impl<R: Real, const D: usize> Mul for Dual<R, D> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let mut slope = self.slope;
        for d in 0..D {
            slope[d] = slope[d] * other.value + self.value * other.slope[d];
        }
        Self { value: self.value * other.value, slope }
    }
}

impl<R: Real, const D: usize> MulAssign for Dual<R, D> {
    #[inline(always)]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl<R: Real, const D: usize> Div for Dual<R, D> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let inverse = R::constant(1.0) / other.value;
        let mut slope = self.slope;
        for d in 0..D {
            slope[d] = (slope[d] - value * other.slope[d]) * inverse;
        }
        Self { value, slope }
    }
}

impl<R: Real, const D: usize> Neg for Dual<R, D> {
    type Output = Self;
    #[inline(always)]
    fn neg(mut self) -> Self {
        self.value = -self.value;
        for s in &mut self.slope {
            *s = -*s;
        }
        self
    }
}

impl<R: Real, const D: usize> Add<f64> for Dual<R, D> {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, other: f64) -> Self {
        self.value = self.value + other;
        self
    }
}

impl<R: Real, const D: usize> Sub<f64> for Dual<R, D> {
    type Output = Self;
    #[inline(always)]
    fn sub(mut self, other: f64) -> Self {
        self.value = self.value - other;
        self
    }
}

impl<R: Real, const D: usize> Mul<f64> for Dual<R, D> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        let mut slope = self.slope;
        for s in &mut slope {
            *s = *s * other;
        }
        Self { value: self.value * other, slope }
    }
}

impl<R: Real, const D: usize> Div<f64> for Dual<R, D> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: f64) -> Self {
        let mut slope = self.slope;
        for s in &mut slope {
            *s = *s / other;
        }
        Self { value: self.value / other, slope }
    }
}

impl<R: Real, const D: usize> Real for Dual<R, D> {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self::fixed(R::constant(value))
    }
    chain_rules!(R);
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        let square = self.value * self.value + x.value * x.value;
        let along_y = or_zero(square, x.value / square);
        let along_x = or_zero(square, self.value / square);
        let mut slope = self.slope;
        for d in 0..D {
            slope[d] = slope[d] * along_y - x.slope[d] * along_x;
        }
        Self { value: self.value.atan2(x.value), slope }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        let above = self.value - other.value;
        let mut slope = self.slope;
        for d in 0..D {
            let tie = (slope[d] + other.slope[d]) * 0.5;
            let not_above = (-above).where_positive(other.slope[d], tie);
            slope[d] = above.where_positive(slope[d], not_above);
        }
        Self { value: self.value.max(other.value), slope }
    }
    #[inline(always)]
    fn powf(self, exponent: Self) -> Self {
        let value = self.value.powf(exponent.value);
        let inside = exponent.value * self.value.powf(exponent.value - 1.0);
        // at 0 the slope of a power below 1 is infinite (of power 0: 0 times infinity)
        let at_zero = (-exponent.value + 1.0).where_positive(R::constant(0.0), inside);
        let along_base = self.value.abs().where_positive(inside, at_zero);
        let along_exponent = or_zero(self.value, value * self.value.ln());
        let mut slope = self.slope;
        for d in 0..D {
            slope[d] = slope[d] * along_base + exponent.slope[d] * along_exponent;
        }
        Self { value, slope }
    }
    #[inline(always)]
    fn where_positive(self, yes: Self, no: Self) -> Self {
        let mut slope = yes.slope;
        for d in 0..D {
            slope[d] = self.value.where_positive(yes.slope[d], no.slope[d]);
        }
        Self { value: self.value.where_positive(yes.value, no.value), slope }
    }
}
