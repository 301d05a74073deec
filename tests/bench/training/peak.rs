//! What this processor can do at most: fused multiply-adds in registers, and how to count
//! its time.

use lacuna::real::Isa;

/// Processor time of this process so far, s.
pub fn processor_seconds() -> f64 {
    #[repr(C)]
    struct Time {
        seconds: i64,
        nanoseconds: i64,
    }
    unsafe extern "C" {
        fn clock_gettime(clock: i32, to: *mut Time) -> i32;
    }
    const PROCESS: i32 = 2;
    let mut time = Time { seconds: 0, nanoseconds: 0 };
    // SAFETY: the C library fills in the two numbers of the struct it is handed
    let done = unsafe { clock_gettime(PROCESS, &mut time) };
    if done == 0 { time.seconds as f64 + 1e-9 * time.nanoseconds as f64 } else { f64::NAN }
}

/// Independent sums, enough to hide the latency of one.
const SUMS: usize = 12;
const ROUNDS: usize = 4_000_000;

macro_rules! peak {
    ($name:ident, $t:ty, $w:expr, $n:expr, $wide_set:ident, $wide_fma:ident, $narrow_set:ident, $narrow_fma:ident) => {
        /// GFLOP/s of one core in this precision, with the instructions the library uses.
        #[cfg(target_arch = "x86_64")]
        pub fn $name() -> f64 {
            use std::arch::x86_64::*;
            #[target_feature(enable = "avx512f")]
            fn wide() -> $t {
                use std::hint::black_box;
                let (a, b) = ($wide_set(black_box(0.999)), $wide_set(black_box(1e-3)));
                let mut sums = [0.0; SUMS].map(|s| $wide_set(black_box(s)));
                for _ in 0..ROUNDS {
                    for sum in &mut sums {
                        *sum = $wide_fma(*sum, a, b);
                    }
                }
                // SAFETY: plain numbers side by side
                unsafe { std::mem::transmute::<[_; SUMS], [$t; SUMS * $w]>(sums) }.iter().sum()
            }
            #[target_feature(enable = "avx2,fma")]
            fn narrow() -> $t {
                use std::hint::black_box;
                let (a, b) = ($narrow_set(black_box(0.999)), $narrow_set(black_box(1e-3)));
                let mut sums = [0.0; SUMS].map(|s| $narrow_set(black_box(s)));
                for _ in 0..ROUNDS {
                    for sum in &mut sums {
                        *sum = $narrow_fma(*sum, a, b);
                    }
                }
                // SAFETY: as above
                unsafe { std::mem::transmute::<[_; SUMS], [$t; SUMS * $n]>(sums) }.iter().sum()
            }
            let mut least = f64::INFINITY;
            let mut lanes = 0;
            for _ in 0..5 {
                let before = processor_seconds();
                let (sum, width) = match Isa::detect() {
                    // SAFETY: `detect` saw these features on this processor
                    Isa::Avx512 => (unsafe { wide() }, $w),
                    // SAFETY: as above
                    Isa::Avx2 => (unsafe { narrow() }, $n),
                    Isa::Baseline => return f64::NAN,
                };
                std::hint::black_box(sum);
                least = least.min(processor_seconds() - before);
                lanes = width;
            }
            2.0 * (lanes * SUMS * ROUNDS) as f64 / least * 1e-9
        }

        #[cfg(not(target_arch = "x86_64"))]
        pub fn $name() -> f64 {
            f64::NAN
        }
    };
}

peak!(f64, f64, 8, 4, _mm512_set1_pd, _mm512_fmadd_pd, _mm256_set1_pd, _mm256_fmadd_pd);
peak!(f32, f32, 16, 8, _mm512_set1_ps, _mm512_fmadd_ps, _mm256_set1_ps, _mm256_fmadd_ps);
