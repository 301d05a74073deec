//! The kinds of number that laws are called with.

use super::law::{Block, Call};
use crate::real::{Dual, F32x16, F64x8, InRegisters};

/// Directions that a dual number carries through a model at once.
pub const DIRECTIONS: usize = 4;

/// Double precision with slopes along [`DIRECTIONS`] directions.
pub type Dual64 = Dual<F64x8, DIRECTIONS>;
/// Single precision with slopes along [`DIRECTIONS`] directions.
pub type Dual32 = Dual<F32x16, DIRECTIONS>;

/// A number that a [`Law`](super::Law) can be called with.
pub trait LaneNumber: InRegisters {
    /// Numbers side by side.
    const LANES: usize;
    /// Wraps a block of this number for the object-safe call.
    fn call<'a>(block: &'a Block<'a, Self>, out: &'a mut [Self]) -> Call<'a>;
    /// Value in one lane, widened.
    fn lane(&self, lane: usize) -> f64;
    /// Sets the value in one lane.
    fn set_lane(&mut self, lane: usize, value: f64);
    /// A magnitude far below anything that matters but far above the subnormal numbers;
    /// adding and subtracting it flushes what would slow the processor down.
    const FLUSH: f64;
}

/// The same for one and the other precision.
macro_rules! lane_numbers {
    ($($plain:ty, $single:ty, $lanes:literal, $flush:literal, $call:ident,
       $slopes:ty, $call_slopes:ident;)*) => {$(
        impl LaneNumber for $plain {
            const LANES: usize = $lanes;
            const FLUSH: f64 = $flush;
            #[inline(always)]
            fn call<'a>(block: &'a Block<'a, Self>, out: &'a mut [Self]) -> Call<'a> {
                Call::$call(block, out)
            }
            #[inline(always)]
            fn lane(&self, lane: usize) -> f64 {
                f64::from(self.0[lane])
            }
            #[inline(always)]
            fn set_lane(&mut self, lane: usize, value: f64) {
                self.0[lane] = value as $single;
            }
        }

        impl LaneNumber for $slopes {
            const LANES: usize = $lanes;
            const FLUSH: f64 = $flush;
            #[inline(always)]
            fn call<'a>(block: &'a Block<'a, Self>, out: &'a mut [Self]) -> Call<'a> {
                Call::$call_slopes(block, out)
            }
            #[inline(always)]
            fn lane(&self, lane: usize) -> f64 {
                self.value.lane(lane)
            }
            #[inline(always)]
            fn set_lane(&mut self, lane: usize, value: f64) {
                self.value.set_lane(lane, value);
            }
        }
    )*};
}

lane_numbers! {
    F64x8, f64, 8, 1e-120, F64, Dual64, Dual64;
    F32x16, f32, 16, 1e-25, F32, Dual32, Dual32;
}
