//! Packs in the registers of x86-64 processors.
//!
//! SAFETY of all intrinsics here: these types are only used by kernels that `per_pack!`
//! runs after the processor's features have been seen.

use std::arch::x86_64::*;

use super::Pack;

macro_rules! pack {
    ($(#[$meta:meta])* $name:ident, $t:ty, $reg:ty, $n:literal, $side:literal, $tile:literal,
     $set:ident, $load:ident, $store:ident, $add:ident, $sub:ident, $mul:ident, $fma:ident,
     $fnma:ident, $max:ident, |$a:ident, $b:ident| abs: $abs:expr, signed: $signed:expr,
     power: $power:expr, divided: $divided:expr) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy)]
        #[repr(transparent)]
        pub struct $name($reg);

        impl Pack for $name {
            type Number = $t;
            const N: usize = $n;
            const SIDE: usize = $side;
            const TILE: usize = $tile;

            #[inline(always)]
            fn splat(x: $t) -> Self {
                // SAFETY: only kernels for processors with these features use the type.
                Self(unsafe { $set(x) })
            }
            #[inline(always)]
            unsafe fn load(from: *const $t) -> Self {
                // SAFETY: only kernels for processors with these features use the type; the pointer is the caller's promise.
                Self(unsafe { $load(from) })
            }
            #[inline(always)]
            unsafe fn store(self, to: *mut $t) {
                // SAFETY: only kernels for processors with these features use the type; the pointer is the caller's promise.
                unsafe { $store(to, self.0) }
            }
            #[inline(always)]
            fn add(self, b: Self) -> Self {
                // SAFETY: only kernels for processors with these features use the type.
                Self(unsafe { $add(self.0, b.0) })
            }
            #[inline(always)]
            fn sub(self, b: Self) -> Self {
                // SAFETY: only kernels for processors with these features use the type.
                Self(unsafe { $sub(self.0, b.0) })
            }
            #[inline(always)]
            fn mul(self, b: Self) -> Self {
                // SAFETY: only kernels for processors with these features use the type.
                Self(unsafe { $mul(self.0, b.0) })
            }
            #[inline(always)]
            fn fma(self, b: Self, c: Self) -> Self {
                // SAFETY: only kernels for processors with these features use the type.
                Self(unsafe { $fma(self.0, b.0, c.0) })
            }
            #[inline(always)]
            fn fnma(self, b: Self, c: Self) -> Self {
                // SAFETY: only kernels for processors with these features use the type.
                Self(unsafe { $fnma(self.0, b.0, c.0) })
            }
            #[inline(always)]
            fn abs(self) -> Self {
                let $a = self.0;
                // SAFETY: only kernels for processors with these features use the type.
                Self(unsafe { $abs })
            }
            #[inline(always)]
            fn signed_as(self, of: Self) -> Self {
                let ($a, $b) = (self.0, of.0);
                // SAFETY: only kernels for processors with these features use the type.
                Self(unsafe { $signed })
            }
            #[inline(always)]
            fn at_least(self, limit: Self) -> Self {
                // the second operand is what comes out where either is not a number
                // SAFETY: only kernels for processors with these features use the type.
                Self(unsafe { $max(limit.0, self.0) })
            }
            #[inline(always)]
            fn power_of_two(self) -> Self {
                let $a = self.0;
                // SAFETY: only kernels for processors with these features use the type.
                Self(unsafe { $power })
            }
            #[inline(always)]
            fn divided(self, by: Self) -> Self {
                let ($a, $b) = (self.0, by.0);
                // SAFETY: only kernels for processors with these features use the type.
                Self(unsafe { $divided })
            }
        }
    };
}

/// a / b: an estimate of 1 / b to 14 bits, improved to 42, then the quotient corrected by
/// its remainder. A division would take three times as long.
#[inline(always)]
unsafe fn quotient_f64(a: __m512d, b: __m512d) -> __m512d {
    // SAFETY: only kernels for processors with these features use the type.
    unsafe {
        let q = _mm512_rcp14_pd(b);
        let miss = _mm512_fnmadd_pd(b, q, _mm512_set1_pd(1.0));
        let q = _mm512_fmadd_pd(_mm512_fmadd_pd(miss, miss, miss), q, q);
        let v = _mm512_mul_pd(a, q);
        _mm512_fmadd_pd(_mm512_fnmadd_pd(v, b, a), q, v)
    }
}

/// The same in single precision, where 28 bits are enough to begin with.
#[inline(always)]
unsafe fn quotient_f32(a: __m512, b: __m512) -> __m512 {
    // SAFETY: only kernels for processors with these features use the type.
    unsafe {
        let q = _mm512_rcp14_ps(b);
        let miss = _mm512_fnmadd_ps(b, q, _mm512_set1_ps(1.0));
        let q = _mm512_fmadd_ps(miss, q, q);
        let v = _mm512_mul_ps(a, q);
        _mm512_fmadd_ps(_mm512_fnmadd_ps(v, b, a), q, v)
    }
}

pack! {
    /// Eight `f64` (AVX-512).
    F64x8, f64, __m512d, 8, 4, 4,
    _mm512_set1_pd, _mm512_loadu_pd, _mm512_storeu_pd, _mm512_add_pd, _mm512_sub_pd,
    _mm512_mul_pd, _mm512_fmadd_pd, _mm512_fnmadd_pd, _mm512_max_pd,
    |a, b| abs: _mm512_abs_pd(a),
    signed: _mm512_or_pd(a, _mm512_and_pd(b, _mm512_set1_pd(-0.0))),
    power: _mm512_castsi512_pd(_mm512_slli_epi64::<52>(_mm512_add_epi64(
        _mm512_castpd_si512(a), _mm512_set1_epi64(1023)))),
    divided: quotient_f64(a, b)
}

pack! {
    /// Sixteen `f32` (AVX-512).
    F32x16, f32, __m512, 16, 4, 4,
    _mm512_set1_ps, _mm512_loadu_ps, _mm512_storeu_ps, _mm512_add_ps, _mm512_sub_ps,
    _mm512_mul_ps, _mm512_fmadd_ps, _mm512_fnmadd_ps, _mm512_max_ps,
    |a, b| abs: _mm512_abs_ps(a),
    signed: _mm512_or_ps(a, _mm512_and_ps(b, _mm512_set1_ps(-0.0))),
    power: _mm512_castsi512_ps(_mm512_slli_epi32::<23>(_mm512_add_epi32(
        _mm512_castps_si512(a), _mm512_set1_epi32(127)))),
    divided: quotient_f32(a, b)
}

pack! {
    /// Four `f64` (AVX2 and FMA).
    F64x4, f64, __m256d, 4, 2, 3,
    _mm256_set1_pd, _mm256_loadu_pd, _mm256_storeu_pd, _mm256_add_pd, _mm256_sub_pd,
    _mm256_mul_pd, _mm256_fmadd_pd, _mm256_fnmadd_pd, _mm256_max_pd,
    |a, b| abs: _mm256_andnot_pd(_mm256_set1_pd(-0.0), a),
    signed: _mm256_or_pd(a, _mm256_and_pd(b, _mm256_set1_pd(-0.0))),
    power: _mm256_castsi256_pd(_mm256_slli_epi64::<52>(_mm256_add_epi64(
        _mm256_castpd_si256(a), _mm256_set1_epi64x(1023)))),
    divided: _mm256_div_pd(a, b)
}

pack! {
    /// Eight `f32` (AVX2 and FMA).
    F32x8, f32, __m256, 8, 2, 3,
    _mm256_set1_ps, _mm256_loadu_ps, _mm256_storeu_ps, _mm256_add_ps, _mm256_sub_ps,
    _mm256_mul_ps, _mm256_fmadd_ps, _mm256_fnmadd_ps, _mm256_max_ps,
    |a, b| abs: _mm256_andnot_ps(_mm256_set1_ps(-0.0), a),
    signed: _mm256_or_ps(a, _mm256_and_ps(b, _mm256_set1_ps(-0.0))),
    power: _mm256_castsi256_ps(_mm256_slli_epi32::<23>(_mm256_add_epi32(
        _mm256_castps_si256(a), _mm256_set1_epi32(127)))),
    divided: _mm256_div_ps(a, b)
}
