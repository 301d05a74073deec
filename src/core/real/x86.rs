//! Blocks held in the processor's own registers.
//!
//! They have the layout of [`Lanes`](super::Lanes) and give the same bits; kernels are handed
//! slices of these instead, chosen when the program runs. Written with intrinsics because
//! the compiler, given arrays in a loop, tends to vectorise across the loop with gathers.

use std::arch::x86_64::*;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use super::fuse::Fuse;
use super::{Real, elementary};

/// Defines a block of `$lanes` numbers in `$count` registers.
///
/// SAFETY of all intrinsics here: these types are only made by `per_lanes!`, inside
/// functions that run after the processor's features have been seen.
macro_rules! registers {
    ($(#[$meta:meta])* $name:ident, $features:literal, $t:ty, $lanes:literal, $reg:ty, $count:literal,
     $set:ident, $add:ident, $sub:ident, $mul:ident, $div:ident, $sqrt:ident,
     $fma:ident, $fms:ident, $fnma:ident,
     |$a:ident, $b:ident| less: $less:expr, nan: $nan:expr,
     |$m:ident, $y:ident, $n:ident| pick: $pick:expr, |$v:ident| flip: $flip:expr, abs: $abs:expr) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy)]
        #[repr(C, align(64))]
        pub struct $name([$reg; $count]);

        impl $name {
            #[inline(always)]
            fn array(self) -> [$t; $lanes] {
                // SAFETY: same size, any bits are numbers.
                unsafe { std::mem::transmute(self) }
            }
            #[inline(always)]
            fn from_array(array: [$t; $lanes]) -> Self {
                // SAFETY: same size, any bits are numbers.
                unsafe { std::mem::transmute(array) }
            }
            #[inline(always)]
            fn wide(self) -> [f64; $lanes] {
                let array = self.array();
                let mut wide = [0.0; $lanes];
                for i in 0..$lanes {
                    wide[i] = f64::from(array[i]);
                }
                wide
            }
            #[inline(always)]
            fn narrow(wide: [f64; $lanes]) -> Self {
                let mut array = [0.0; $lanes];
                for i in 0..$lanes {
                    array[i] = wide[i] as $t;
                }
                Self::from_array(array)
            }
            #[inline(always)]
            fn splat(value: f64) -> Self {
                // SAFETY: only code for processors with these features uses the type.
                Self([unsafe { $set(value as $t) }; $count])
            }
            /// `other` where `other` is below `self` or not a number, else `self`.
            #[inline(always)]
            fn lower(self, other: Self) -> Self {
                let mut out = self;
                for k in 0..$count {
                    let ($a, $b) = (other.0[k], self.0[k]);
                    let ($y, $n) = (other.0[k], self.0[k]);
                    // SAFETY: only code for processors with these features uses the type.
                    out.0[k] = unsafe {
                        let $m = $less;
                        let first = $pick;
                        let $m = $nan;
                        let $n = first;
                        $pick
                    };
                }
                out
            }
            /// `yes` where `self` is above zero, else `no`.
            #[inline(always)]
            fn above_zero(self, yes: Self, no: Self) -> Self {
                let mut out = self;
                for k in 0..$count {
                    // SAFETY: only code for processors with these features uses the type.
                    out.0[k] = unsafe {
                        let ($a, $b) = ($set(0.0), self.0[k]);
                        let $m = $less;
                        let ($y, $n) = (yes.0[k], no.0[k]);
                        $pick
                    };
                }
                out
            }
        }

        registers!(@binary $name, $t, $count, $set, Add add AddAssign add_assign $add);
        registers!(@binary $name, $t, $count, $set, Sub sub SubAssign sub_assign $sub);
        registers!(@binary $name, $t, $count, $set, Mul mul MulAssign mul_assign $mul);

        impl Div for $name {
            type Output = Self;
            #[inline(always)]
            fn div(mut self, other: Self) -> Self {
                for k in 0..$count {
                    // SAFETY: only code for processors with these features uses the type.
                    self.0[k] = unsafe { $div(self.0[k], other.0[k]) };
                }
                self
            }
        }
        impl Div<f64> for $name {
            type Output = Self;
            #[inline(always)]
            fn div(self, other: f64) -> Self {
                self / Self::splat(other)
            }
        }
        impl Neg for $name {
            type Output = Self;
            #[inline(always)]
            fn neg(mut self) -> Self {
                for k in 0..$count {
                    let $v = self.0[k];
                    // SAFETY: only code for processors with these features uses the type.
                    self.0[k] = unsafe { $flip };
                }
                self
            }
        }

        registers!(@fused $name, $count, fma $fma fms $fms fnma $fnma);

        impl Real for $name {
            registers!(@elementary $name, $features, sin cos tan asin acos atan sinh cosh tanh exp ln);

            #[inline(always)]
            fn constant(value: f64) -> Self {
                Self::splat(value)
            }
            #[inline(always)]
            fn atan2(self, x: Self) -> Self {
                #[target_feature(enable = $features)]
                #[inline(never)]
                fn called(y: $name, x: $name) -> $name {
                    $name::narrow(elementary::atan2(y.wide(), x.wide()))
                }
                // SAFETY: of all intrinsics here, above.
                unsafe { called(self, x) }
            }
            #[inline(always)]
            fn powf(self, exponent: Self) -> Self {
                #[target_feature(enable = $features)]
                #[inline(never)]
                fn called(x: $name, exponent: $name) -> $name {
                    $name::narrow(elementary::pow(x.wide(), exponent.wide()))
                }
                // SAFETY: of all intrinsics here, above.
                unsafe { called(self, exponent) }
            }
            #[inline(always)]
            fn sqrt(mut self) -> Self {
                for k in 0..$count {
                    // SAFETY: only code for processors with these features uses the type.
                    self.0[k] = unsafe { $sqrt(self.0[k]) };
                }
                self
            }
            #[inline(always)]
            fn abs(mut self) -> Self {
                for k in 0..$count {
                    let $v = self.0[k];
                    // SAFETY: only code for processors with these features uses the type.
                    self.0[k] = unsafe { $abs };
                }
                self
            }
            #[inline(always)]
            fn signum(self) -> Self {
                let negative = (-self).above_zero(Self::splat(-1.0), self);
                self.above_zero(Self::splat(1.0), negative)
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                self.lower(other)
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                -((-self).lower(-other))
            }
            #[inline(always)]
            fn where_positive(self, yes: Self, no: Self) -> Self {
                self.above_zero(yes, no)
            }
        }
    };
    (@binary $name:ident, $t:ty, $count:literal, $set:ident,
     $trait:ident $method:ident $assign_trait:ident $assign:ident $op:ident) => {
        impl $trait for $name {
            type Output = Self;
            #[inline(always)]
            fn $method(mut self, other: Self) -> Self {
                for k in 0..$count {
                    // SAFETY: only code for processors with these features uses the type.
                    self.0[k] = unsafe { $op(self.0[k], other.0[k]) };
                }
                self
            }
        }
        impl $trait<f64> for $name {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                self.$method(Self::splat(other))
            }
        }
        impl $assign_trait for $name {
            #[inline(always)]
            fn $assign(&mut self, other: Self) {
                *self = self.$method(other);
            }
        }
    };
    (@fused $name:ident, $count:literal, $($method:ident $fused:ident)*) => {
        impl Fuse for $name {$(
            #[inline(always)]
            fn $method(mut self, b: Self, c: Self) -> Self {
                for k in 0..$count {
                    // SAFETY: only code for processors with these features uses the type.
                    self.0[k] = unsafe { $fused(self.0[k], b.0[k], c.0[k]) };
                }
                self
            }
        )*}
    };
    // long functions are compiled once and called: in line they would make up most of a kernel
    (@elementary $name:ident, $features:literal, $($function:ident)*) => {$(
        #[inline(always)]
        fn $function(self) -> Self {
            #[target_feature(enable = $features)]
            #[inline(never)]
            fn called(x: $name) -> $name {
                $name::narrow(elementary::$function(x.wide()))
            }
            // SAFETY: of all intrinsics here, above.
            unsafe { called(self) }
        }
    )*};
}

registers! {
    /// Eight `f64` in one AVX-512 register.
    F64x8Avx512, "avx2,fma,bmi1,bmi2,avx512f,avx512dq,avx512vl", f64, 8, __m512d, 1,
    _mm512_set1_pd, _mm512_add_pd, _mm512_sub_pd, _mm512_mul_pd, _mm512_div_pd, _mm512_sqrt_pd,
    _mm512_fmadd_pd, _mm512_fmsub_pd, _mm512_fnmadd_pd,
    |a, b| less: _mm512_cmp_pd_mask::<_CMP_LT_OQ>(a, b), nan: _mm512_cmp_pd_mask::<_CMP_UNORD_Q>(a, a),
    |m, y, n| pick: _mm512_mask_blend_pd(m, n, y),
    |v| flip: _mm512_xor_pd(v, _mm512_set1_pd(-0.0)), abs: _mm512_abs_pd(v)
}

registers! {
    /// Sixteen `f32` in one AVX-512 register.
    F32x16Avx512, "avx2,fma,bmi1,bmi2,avx512f,avx512dq,avx512vl", f32, 16, __m512, 1,
    _mm512_set1_ps, _mm512_add_ps, _mm512_sub_ps, _mm512_mul_ps, _mm512_div_ps, _mm512_sqrt_ps,
    _mm512_fmadd_ps, _mm512_fmsub_ps, _mm512_fnmadd_ps,
    |a, b| less: _mm512_cmp_ps_mask::<_CMP_LT_OQ>(a, b), nan: _mm512_cmp_ps_mask::<_CMP_UNORD_Q>(a, a),
    |m, y, n| pick: _mm512_mask_blend_ps(m, n, y),
    |v| flip: _mm512_xor_ps(v, _mm512_set1_ps(-0.0)), abs: _mm512_abs_ps(v)
}

registers! {
    /// Eight `f64` in two AVX registers.
    F64x8Avx2, "avx2,fma,bmi1,bmi2", f64, 8, __m256d, 2,
    _mm256_set1_pd, _mm256_add_pd, _mm256_sub_pd, _mm256_mul_pd, _mm256_div_pd, _mm256_sqrt_pd,
    _mm256_fmadd_pd, _mm256_fmsub_pd, _mm256_fnmadd_pd,
    |a, b| less: _mm256_cmp_pd::<_CMP_LT_OQ>(a, b), nan: _mm256_cmp_pd::<_CMP_UNORD_Q>(a, a),
    |m, y, n| pick: _mm256_blendv_pd(n, y, m),
    |v| flip: _mm256_xor_pd(v, _mm256_set1_pd(-0.0)), abs: _mm256_andnot_pd(_mm256_set1_pd(-0.0), v)
}

registers! {
    /// Sixteen `f32` in two AVX registers.
    F32x16Avx2, "avx2,fma,bmi1,bmi2", f32, 16, __m256, 2,
    _mm256_set1_ps, _mm256_add_ps, _mm256_sub_ps, _mm256_mul_ps, _mm256_div_ps, _mm256_sqrt_ps,
    _mm256_fmadd_ps, _mm256_fmsub_ps, _mm256_fnmadd_ps,
    |a, b| less: _mm256_cmp_ps::<_CMP_LT_OQ>(a, b), nan: _mm256_cmp_ps::<_CMP_UNORD_Q>(a, a),
    |m, y, n| pick: _mm256_blendv_ps(n, y, m),
    |v| flip: _mm256_xor_ps(v, _mm256_set1_ps(-0.0)), abs: _mm256_andnot_ps(_mm256_set1_ps(-0.0), v)
}
