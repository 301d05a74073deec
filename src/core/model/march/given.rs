//! What a kernel is given, entry by entry.

use super::call::Stage;
use crate::model::block::Sizes;
use crate::real::fused::{Folded, Fuse};

/// The largest law: parameters, derived numbers, inputs, channels, states.
pub const THETA: usize = 16;
pub const DERIVED: usize = 8;
pub const INPUTS: usize = 4;
pub const CHANNELS: usize = 8;
pub const STATES: usize = 4;

/// The array of `$entry!(0)`, `$entry!(1)`, ...
macro_rules! listed {
    ($entry:ident; 4) => {
        [$entry!(0), $entry!(1), $entry!(2), $entry!(3)]
    };
    ($entry:ident; 8) => {
        [
            $entry!(0),
            $entry!(1),
            $entry!(2),
            $entry!(3),
            $entry!(4),
            $entry!(5),
            $entry!(6),
            $entry!(7),
        ]
    };
    ($entry:ident; 16) => {
        [
            $entry!(0),
            $entry!(1),
            $entry!(2),
            $entry!(3),
            $entry!(4),
            $entry!(5),
            $entry!(6),
            $entry!(7),
            $entry!(8),
            $entry!(9),
            $entry!(10),
            $entry!(11),
            $entry!(12),
            $entry!(13),
            $entry!(14),
            $entry!(15),
        ]
    };
}

/// The same for each state, without a loop.
macro_rules! each_state {
    ($n:ident, $i:ident, $body:block) => {
        each_state!(@ $n, $i, $body, 0 1 2 3);
    };
    (@ $n:ident, $i:ident, $body:block, $($state:literal)*) => {$(
        if $n > $state {
            const $i: usize = $state;
            $body
        }
    )*};
}

/// A [`March`] in registers.
pub struct Given<'a, R> {
    pub sizes: Sizes,
    pub packs: usize,
    pub substeps: usize,
    pub step: f64,
    pub stages: &'a [Stage],
    pub theta: &'a [f64],
    pub derived: &'a [f64],
    pub x: &'a [R],
    pub u: &'a [R],
    pub du: &'a [R],
    pub time: &'a [R],
}

/// What a law looks at besides the states.
pub struct Around<R> {
    pub theta: [Folded<R>; THETA],
    pub derived: [Folded<R>; DERIVED],
    pub u: [Folded<R>; INPUTS],
    pub w: [Folded<R>; CHANNELS],
    pub time: Folded<R>,
}

impl<R: Fuse> Given<'_, R> {
    #[inline(always)]
    fn parameter(from: &[f64], i: usize) -> Folded<R> {
        Folded::parameter(R::constant(if i < from.len() { from[i] } else { 0.0 }))
    }

    #[inline(always)]
    fn input(&self, from: &[R], i: usize, pack: usize) -> R {
        let at = i * self.packs + pack;
        if at < from.len() { from[at] } else { R::constant(0.0) }
    }

    #[inline(always)]
    pub fn around(&self, pack: usize) -> Around<R> {
        macro_rules! theta {
            ($i:literal) => {
                Self::parameter(self.theta, $i)
            };
        }
        macro_rules! derived {
            ($i:literal) => {
                Self::parameter(self.derived, $i)
            };
        }
        macro_rules! input {
            ($i:literal) => {
                Folded::plain(self.input(self.u, $i, pack))
            };
        }
        macro_rules! channel {
            ($i:literal) => {
                Folded::zero()
            };
        }
        Around {
            theta: listed!(theta; 16),
            derived: listed!(derived; 8),
            u: listed!(input; 4),
            w: listed!(channel; 8),
            time: Folded::plain(self.time[pack]),
        }
    }

    /// The inputs after a share of the sample, where they move.
    #[inline(always)]
    pub fn drive(&self, around: &mut Around<R>, pack: usize, share: f64) {
        if !self.du.is_empty() {
            macro_rules! input {
                ($i:literal) => {{
                    let change = Folded::plain(self.input(self.du, $i, pack)) * share;
                    (Folded::plain(self.input(self.u, $i, pack)) + change).settled()
                }};
            }
            around.u = listed!(input; 4);
        }
    }
}
/// The same memory as registers.
///
/// # Safety
///
/// `B` is registers with the layout of one or two `A`, and of the same alignment.
pub unsafe fn as_registers<A, B>(from: &[A]) -> &[B] {
    // SAFETY: the caller's promise.
    unsafe { std::slice::from_raw_parts(from.as_ptr().cast(), size_of_val(from) / size_of::<B>()) }
}

/// The same, to be changed.
///
/// # Safety
///
/// As above.
pub unsafe fn as_registers_mut<A, B>(from: &mut [A]) -> &mut [B] {
    let length = size_of_val(from) / size_of::<B>();
    // SAFETY: the caller's promise.
    unsafe { std::slice::from_raw_parts_mut(from.as_mut_ptr().cast(), length) }
}

/// Whether a list holds a number.
pub const fn holds(list: &[usize], number: usize) -> bool {
    let mut i = 0;
    while i < list.len() {
        if list[i] == number {
            return true;
        }
        i += 1;
    }
    false
}

pub(super) use {each_state, listed};
