//! The kinds of number that laws are called with.

use super::block::{Block, Call, Dual32, Dual64};
use crate::real::{F32x16, F64x8, Given, InRegisters, Real, Trace};

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

    /// The time at `time` s, the same in every lane.
    #[inline(always)]
    fn time(time: f64) -> Self {
        Self::constant(time)
    }

    /// What is remembered once a run has `started`, `first` before.
    #[inline(always)]
    fn since(started: bool, remembered: Self, first: Self) -> Self {
        if started { remembered } else { first }
    }

    /// What a delay line of `depth` steps answers to a step's three values, for a number that
    /// has a way of its own; `back` is the delay in steps, `held` whether values are held.
    #[inline(always)]
    fn delayed(depth: usize, back: Self, three: [Self; 3], held: bool) -> Option<[Self; 3]> {
        let _ = (depth, back, three, held);
        None
    }
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

/// One lane that writes down what is done with it: steps begin at [`Given::Time`], and what is
/// remembered counts from [`Given::Started`] on.
impl LaneNumber for Trace {
    const LANES: usize = 1;
    const FLUSH: f64 = 1e-120;

    fn call<'a>(block: &'a Block<'a, Self>, out: &'a mut [Self]) -> Call<'a> {
        Call::Trace(block, out)
    }
    fn lane(&self, _: usize) -> f64 {
        self.value()
    }
    fn set_lane(&mut self, _: usize, value: f64) {
        *self = Self::constant(value);
    }
    fn time(time: f64) -> Self {
        Self::given(Given::Time, 0.0) + time
    }
    fn since(_: bool, remembered: Self, first: Self) -> Self {
        Self::given(Given::Started, 0.0).where_positive(remembered, first)
    }
    fn delayed(depth: usize, back: Self, three: [Self; 3], held: bool) -> Option<[Self; 3]> {
        // nothing has entered yet: what leaves is what enters
        let now = three[0];
        let past = if held {
            [now.held_past(depth, back, now.value()); 3]
        } else {
            let ats = [0.0, 0.5, 1.0].map(|offset| Self::constant(offset) - back);
            now.line_past(depth, ats, three[2], [now.value(); 3])
        };
        Some(std::array::from_fn(|i| back.where_positive(past[i], three[i])))
    }
}
