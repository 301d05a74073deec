//! A value and its slopes along four directions, most of them 0.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use super::{Folded, Fuse};
use crate::real::Real;
use crate::real::rules::chain_rules;

/// What [`Dual`](crate::real::Dual) is, for kernels that the compiler sees as a whole: what
/// does not depend on a direction costs nothing there. Kinks follow the same rule. Four named
/// slopes and not an array, because loops over arrays are unrolled after it is decided what
/// stays in registers.
#[derive(Debug, Clone, Copy)]
pub struct Sparse<R> {
    /// The value itself.
    pub value: Folded<R>,
    /// The derivative along each direction.
    pub slope: Slopes<R>,
}

type Slopes<R> = (Folded<R>, Folded<R>, Folded<R>, Folded<R>);

/// The same for each direction. A macro, because a closure is a function of its own, which
/// does not get the vector instructions of the one around it.
macro_rules! each {
    ($s:ident = $from:expr; $result:expr) => {{
        let from = $from;
        (
            {
                let $s = from.0;
                $result
            },
            {
                let $s = from.1;
                $result
            },
            {
                let $s = from.2;
                $result
            },
            {
                let $s = from.3;
                $result
            },
        )
    }};
    ($s:ident = $from:expr, $t:ident = $other:expr; $result:expr) => {{
        let (from, other) = ($from, $other);
        (
            {
                let ($s, $t) = (from.0, other.0);
                $result
            },
            {
                let ($s, $t) = (from.1, other.1);
                $result
            },
            {
                let ($s, $t) = (from.2, other.2);
                $result
            },
            {
                let ($s, $t) = (from.3, other.3);
                $result
            },
        )
    }};
}

impl<R: Fuse> Sparse<R> {
    /// A value that does not depend on anything.
    #[inline(always)]
    pub fn fixed(value: Folded<R>) -> Self {
        let zero = Folded::zero();
        Self { value, slope: (zero, zero, zero, zero) }
    }

    /// A value that moves one to one along `direction`.
    #[inline(always)]
    pub fn along(value: R, direction: usize) -> Self {
        let (zero, one) = (Folded::zero(), Folded::one());
        let slope = match direction {
            0 => (one, zero, zero, zero),
            1 => (zero, one, zero, zero),
            2 => (zero, zero, one, zero),
            _ => (zero, zero, zero, one),
        };
        Self { value: Folded::plain(value), slope }
    }

    #[inline(always)]
    fn chain(self, value: Folded<R>, by: Folded<R>) -> Self {
        let (s, by) = (self.slope, by.settled());
        Self { value, slope: (s.0 * by, s.1 * by, s.2 * by, s.3 * by) }
    }

    /// `a` times the slopes of `self` and `b` times those of `other`.
    #[inline(always)]
    fn mixed(self, a: Folded<R>, other: Self, b: Folded<R>) -> Slopes<R> {
        let (s, o) = (self.slope, other.slope);
        (s.0 * a + b * o.0, s.1 * a + b * o.1, s.2 * a + b * o.2, s.3 * a + b * o.3)
    }
}

macro_rules! linear {
    ($($trait:ident $method:ident $assign_trait:ident $assign:ident),*) => {$(
        impl<R: Fuse> $trait for Sparse<R> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let (a, b) = (self.slope, other.slope);
                let slope =
                    (a.0.$method(b.0), a.1.$method(b.1), a.2.$method(b.2), a.3.$method(b.3));
                Self { value: self.value.$method(other.value), slope }
            }
        }
        impl<R: Fuse> $trait<f64> for Sparse<R> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                Self { value: self.value.$method(other), ..self }
            }
        }
        linear!(@ $assign_trait $assign $method);
    )*};
    (@ $trait:ident $method:ident $by:ident) => {
        impl<R: Fuse> $trait for Sparse<R> {
            #[inline(always)]
            fn $method(&mut self, other: Self) {
                *self = self.$by(other);
            }
        }
    };
}

linear!(Add add AddAssign add_assign, Sub sub SubAssign sub_assign);
linear!(@ MulAssign mul_assign mul);

impl<R: Fuse> Mul for Sparse<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let slope = self.mixed(other.value, other, self.value);
        Self { value: self.value * other.value, slope }
    }
}

impl<R: Fuse> Div for Sparse<R> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let inverse = (Folded::one() / other.value).settled();
        let value = (self.value * inverse).settled();
        Self { value, slope: self.mixed(inverse, other, -(value * inverse)) }
    }
}

impl<R: Fuse> Mul<f64> for Sparse<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        Self { value: self.value * other, slope: each!(s = self.slope; s * other) }
    }
}

impl<R: Fuse> Div<f64> for Sparse<R> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: f64) -> Self {
        Self { value: self.value / other, slope: each!(s = self.slope; s / other) }
    }
}

impl<R: Fuse> Neg for Sparse<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, slope: each!(s = self.slope; -s) }
    }
}

#[inline(always)]
fn or_zero<R: Fuse>(at: Folded<R>, yes: Folded<R>) -> Folded<R> {
    at.where_positive(yes, Folded::zero())
}

impl<R: Fuse> Real for Sparse<R> {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self::fixed(Folded::constant(value))
    }
    chain_rules!(Folded<R>);
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        let square = self.value * self.value + x.value * x.value;
        let along_y = or_zero(square, x.value / square);
        let along_x = or_zero(square, self.value / square);
        Self { value: self.value.atan2(x.value), slope: self.mixed(along_y, x, -along_x) }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        let above = (self.value - other.value).settled();
        let below = -above;
        let (a, b) = (self.slope, other.slope);
        let slope =
            each!(a = a, b = b; above.where_positive(a, below.where_positive(b, (a + b) * 0.5)));
        Self { value: self.value.max(other.value), slope }
    }
    #[inline(always)]
    fn powf(self, exponent: Self) -> Self {
        let value = self.value.powf(exponent.value);
        let inside = exponent.value * self.value.powf(exponent.value - 1.0);
        // at 0 the slope of a power below 1 is infinite (of power 0: 0 times infinity)
        let at_zero = (-exponent.value + 1.0).where_positive(Folded::zero(), inside);
        let along_base = self.value.abs().where_positive(inside, at_zero);
        let along_exponent = or_zero(self.value, value * self.value.ln());
        Self { value, slope: self.mixed(along_base, exponent, along_exponent) }
    }
    #[inline(always)]
    fn where_positive(self, yes: Self, no: Self) -> Self {
        let (at, a, b) = (self.value, yes.slope, no.slope);
        let slope = each!(a = a, b = b; at.where_positive(a, b));
        Self { value: at.where_positive(yes.value, no.value), slope }
    }
    #[inline(always)]
    fn powi(self, exponent: i32) -> Self {
        match exponent {
            0 => Self::constant(1.0),
            1 => self,
            _ => {
                let by = self.value.powi(exponent - 1) * f64::from(exponent);
                self.chain(self.value.powi(exponent), by)
            }
        }
    }
}
