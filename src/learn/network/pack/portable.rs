//! Packs for processors without the wide registers: the compiler vectorises what it can.

use super::Pack;

/// Four numbers.
#[derive(Debug, Clone, Copy)]
pub struct Plain<T>([T; 4]);

macro_rules! plain {
    ($t:ty, $bits:ty, $shift:literal, $bias:literal) => {
        impl Plain<$t> {
            #[inline(always)]
            fn with(mut self, b: Self, f: impl Fn($t, $t) -> $t) -> Self {
                for i in 0..4 {
                    self.0[i] = f(self.0[i], b.0[i]);
                }
                self
            }
        }

        impl Pack for Plain<$t> {
            type Number = $t;
            const N: usize = 4;
            const SIDE: usize = 1;
            const TILE: usize = 1;

            #[inline(always)]
            fn splat(x: $t) -> Self {
                Self([x; 4])
            }
            #[inline(always)]
            unsafe fn load(from: *const $t) -> Self {
                // SAFETY: the caller's promise.
                Self(unsafe { from.cast::<[$t; 4]>().read() })
            }
            #[inline(always)]
            unsafe fn store(self, to: *mut $t) {
                // SAFETY: the caller's promise.
                unsafe { to.cast::<[$t; 4]>().write(self.0) }
            }
            #[inline(always)]
            fn add(self, b: Self) -> Self {
                self.with(b, |a, b| a + b)
            }
            #[inline(always)]
            fn sub(self, b: Self) -> Self {
                self.with(b, |a, b| a - b)
            }
            #[inline(always)]
            fn mul(self, b: Self) -> Self {
                self.with(b, |a, b| a * b)
            }
            // not `mul_add`: without the instruction it is a slow call
            #[inline(always)]
            fn fma(self, b: Self, c: Self) -> Self {
                self.mul(b).add(c)
            }
            #[inline(always)]
            fn fnma(self, b: Self, c: Self) -> Self {
                c.sub(self.mul(b))
            }
            #[inline(always)]
            fn abs(self) -> Self {
                self.with(self, |a, _| a.abs())
            }
            #[inline(always)]
            fn signed_as(self, of: Self) -> Self {
                self.with(of, <$t>::copysign)
            }
            #[inline(always)]
            fn at_least(self, limit: Self) -> Self {
                self.with(limit, |a, limit| if a < limit { limit } else { a })
            }
            #[inline(always)]
            fn power_of_two(self) -> Self {
                let power = |a: $t| <$t>::from_bits(a.to_bits().wrapping_add($bias) << $shift);
                self.with(self, |a, _| power(a))
            }
            #[inline(always)]
            fn divided(self, by: Self) -> Self {
                self.with(by, |a, b| a / b)
            }
        }
    };
}

plain!(f64, u64, 52, 1023);
plain!(f32, u32, 23, 127);
