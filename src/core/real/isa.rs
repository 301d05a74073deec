//! Which vector instructions this processor has.

use std::sync::OnceLock;

/// The instruction set that block kernels are run with.
///
/// The program is built for plain x86-64 (or any other processor) and picks wider
/// kernels at run time. Simulation, estimation and diagnosis give the same to the last bit in
/// all of them, because no kernel of a [`Real`](super::Real) fuses a multiplication with an
/// addition behind the author's back. Networks do fuse where the processor can: their weights
/// differ in the last digits from one instruction set to another, never with the number of
/// threads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Isa {
    /// What every processor of the target has.
    Baseline,
    /// AVX2 and FMA.
    Avx2,
    /// AVX-512 F, DQ and VL.
    Avx512,
}

impl Isa {
    /// The widest instruction set of this processor, found once.
    ///
    /// The environment variable `LACUNA_ISA` (`baseline`, `avx2`, `avx512`) lowers it,
    /// for measurements.
    #[inline]
    pub fn detect() -> Self {
        // asked before every kernel: one load and a comparison, without a call
        static FOUND: OnceLock<Isa> = OnceLock::new();
        *FOUND.get_or_init(Self::look)
    }

    #[cold]
    fn look() -> Self {
        let has = Self::of_processor();
        match std::env::var("LACUNA_ISA").as_deref() {
            Ok("baseline") => Self::Baseline,
            Ok("avx2") => has.min(Self::Avx2),
            _ => has,
        }
    }

    #[cfg(target_arch = "x86_64")]
    fn of_processor() -> Self {
        let avx2 = is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("fma")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2");
        let avx512 = is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512vl");
        match (avx2, avx512) {
            (true, true) => Self::Avx512,
            (true, false) => Self::Avx2,
            _ => Self::Baseline,
        }
    }

    #[cfg(not(target_arch = "x86_64"))]
    fn of_processor() -> Self {
        Self::Baseline
    }
}

/// Defines a function compiled once per instruction set and a dispatcher in front.
///
/// The body must be `#[inline(always)]` all the way down, or it falls back to plain
/// instructions without a word.
#[doc(hidden)]
#[macro_export]
macro_rules! per_isa {
    ($(#[$meta:meta])* $vis:vis fn $name:ident [$($generic:tt)*] ($($arg:ident : $ty:ty),* $(,)?) $(-> $ret:ty)? $body:block) => {
        $(#[$meta])*
        $vis fn $name<$($generic)*>($($arg: $ty),*) $(-> $ret)? {
            #[inline(always)]
            fn body<$($generic)*>($($arg: $ty),*) $(-> $ret)? $body
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx2,fma,bmi1,bmi2")]
                fn avx2<$($generic)*>($($arg: $ty),*) $(-> $ret)? { body($($arg),*) }
                #[target_feature(enable = "avx2,fma,bmi1,bmi2,avx512f,avx512dq,avx512vl")]
                fn avx512<$($generic)*>($($arg: $ty),*) $(-> $ret)? { body($($arg),*) }
                match $crate::real::Isa::detect() {
                    // SAFETY: `detect` saw these features on this processor.
                    $crate::real::Isa::Avx512 => unsafe { avx512($($arg),*) },
                    // SAFETY: as above.
                    $crate::real::Isa::Avx2 => unsafe { avx2($($arg),*) },
                    $crate::real::Isa::Baseline => body($($arg),*),
                }
            }
            #[cfg(not(target_arch = "x86_64"))]
            {
                body($($arg),*)
            }
        }
    };
}

/// Looks at the same memory as another type of the same size.
///
/// # Safety
///
/// Only between a type made of lanes and the same type made of registers.
#[doc(hidden)]
#[inline(always)]
pub unsafe fn recast<A, B>(from: A) -> B {
    const { assert!(std::mem::size_of::<A>() == std::mem::size_of::<B>()) };
    let from = std::mem::ManuallyDrop::new(from);
    // SAFETY: same size (above), same layout (the caller's promise).
    unsafe { std::mem::transmute_copy(&from) }
}

/// Defines a kernel generic in its number: compiled once per instruction set, with the
/// numbers in registers, and a dispatcher in front. The last generic is the number; the
/// other arguments may mention it only behind references or by value.
///
/// The body must be `#[inline(always)]` all the way down, or it falls back to plain
/// instructions without a word.
#[doc(hidden)]
#[macro_export]
macro_rules! per_lanes {
    // without AVX-512, where its wider registers gain nothing
    (up to avx2, $(#[$meta:meta])* $vis:vis fn $name:ident [$($generic:ident : $bound:path,)* ; $number:ident] ($($arg:ident : $ty:ty),* $(,)?) $body:block) => {
        $(#[$meta])*
        $vis fn $name<$($generic: $bound,)* $number: $crate::real::InRegisters>($($arg: $ty),*) {
            #[inline(always)]
            fn body<$($generic: $bound,)* $number: $crate::real::Real>($($arg: $ty),*) $body
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx2,fma,bmi1,bmi2")]
                fn avx2<$($generic: $bound,)* $number: $crate::real::InRegisters>($($arg: $ty),*) {
                    // SAFETY: registers of this processor with the layout of the lanes.
                    unsafe { body::<$($generic,)* $number::Avx2>($($crate::real::recast($arg)),*) }
                }
                match $crate::real::Isa::detect() {
                    // SAFETY: the same numbers in a type of the same layout.
                    $crate::real::Isa::Baseline => unsafe {
                        body::<$($generic,)* $number::Plain>($($crate::real::recast($arg)),*)
                    },
                    // SAFETY: `detect` saw these features on this processor.
                    _ => unsafe { avx2::<$($generic,)* $number>($($arg),*) },
                }
            }
            #[cfg(not(target_arch = "x86_64"))]
            {
                body::<$($generic,)* $number>($($arg),*)
            }
        }
    };
    ($(#[$meta:meta])* $vis:vis fn $name:ident [$($generic:ident : $bound:path,)* ; $number:ident] ($($arg:ident : $ty:ty),* $(,)?) $(-> $ret:ty)? $body:block) => {
        $(#[$meta])*
        $vis fn $name<$($generic: $bound,)* $number: $crate::real::InRegisters>($($arg: $ty),*) $(-> $ret)? {
            #[inline(always)]
            fn body<$($generic: $bound,)* $number: $crate::real::Real>($($arg: $ty),*) $(-> $ret)? $body
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx2,fma,bmi1,bmi2")]
                fn avx2<$($generic: $bound,)* $number: $crate::real::InRegisters>($($arg: $ty),*) $(-> $ret)? {
                    // SAFETY: registers of this processor with the layout of the lanes.
                    unsafe { body::<$($generic,)* $number::Avx2>($($crate::real::recast($arg)),*) }
                }
                #[target_feature(enable = "avx2,fma,bmi1,bmi2,avx512f,avx512dq,avx512vl")]
                fn avx512<$($generic: $bound,)* $number: $crate::real::InRegisters>($($arg: $ty),*) $(-> $ret)? {
                    // SAFETY: registers of this processor with the layout of the lanes.
                    unsafe { body::<$($generic,)* $number::Avx512>($($crate::real::recast($arg)),*) }
                }
                match $crate::real::Isa::detect() {
                    // SAFETY: `detect` saw these features on this processor.
                    $crate::real::Isa::Avx512 => unsafe { avx512::<$($generic,)* $number>($($arg),*) },
                    // SAFETY: as above.
                    $crate::real::Isa::Avx2 => unsafe { avx2::<$($generic,)* $number>($($arg),*) },
                    // SAFETY: the same numbers in a type of the same layout.
                    $crate::real::Isa::Baseline => unsafe {
                        body::<$($generic,)* $number::Plain>($($crate::real::recast($arg)),*)
                    },
                }
            }
            #[cfg(not(target_arch = "x86_64"))]
            {
                body::<$($generic,)* $number>($($arg),*)
            }
        }
    };
}
