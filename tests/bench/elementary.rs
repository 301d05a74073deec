//! Nanoseconds per value of the elementary functions: one JSON line per function with
//! single numbers, blocks of eight, and the standard library.
//!
//! Run with `cargo bench --bench elementary`; `LACUNA_ISA=baseline` or `avx2` measures
//! the narrower instruction sets. An argument keeps to the functions named so.

use std::hint::black_box;
use std::time::Instant;

use lacuna::real::{F64x8, Isa, Lanes, Real};

const BLOCKS: usize = 256;
const VALUES: usize = BLOCKS * 8;

/// The least time per value of several runs of `work`, which handles `VALUES` values.
fn nanoseconds(mut work: impl FnMut()) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..15 {
        let start = Instant::now();
        for _ in 0..20 {
            work();
        }
        best = best.min(start.elapsed().as_secs_f64() / (20 * VALUES) as f64);
    }
    best * 1e9
}

/// Evenly spread arguments from `low` to `high`, in no order.
fn arguments(low: f64, high: f64) -> Vec<f64> {
    let golden = 0.6180339887498949;
    (0..VALUES).map(|i| low + (high - low) * (i as f64 * golden).fract()).collect()
}

fn blocks(values: &[f64]) -> Vec<F64x8> {
    values.chunks(8).map(|c| Lanes(std::array::from_fn(|i| c[i]))).collect()
}

fn report(name: &str, single: f64, block: f64, std: f64) {
    println!(
        "{{\"function\":\"{name}\",\"isa\":\"{:?}\",\"single_ns\":{single:.2},\
         \"block_ns\":{block:.2},\"std_ns\":{std:.2}}}",
        Isa::detect()
    );
}

macro_rules! bench {
    ($filter:expr, $($name:ident $std:expr, $low:expr, $high:expr;)*) => {$(
        {
            lacuna::per_isa! {
                fn all_blocks[](x: &[F64x8], y: &mut [F64x8]) {
                    for (y, x) in y.iter_mut().zip(x) {
                        *y = x.$name();
                    }
                }
            }
            let name = stringify!($name);
            if $filter.as_ref().is_none_or(|f| f == name) {
                let x = arguments($low, $high);
                let mut y = x.clone();
                let x_blocks = blocks(&x);
                let mut y_blocks = x_blocks.clone();
                let single = nanoseconds(|| {
                    for (y, &x) in y.iter_mut().zip(&x) {
                        *y = Real::$name(black_box(x));
                    }
                    black_box(&mut y);
                });
                let block = nanoseconds(|| {
                    all_blocks(black_box(&x_blocks), &mut y_blocks);
                    black_box(&mut y_blocks);
                });
                let standard: fn(f64) -> f64 = $std;
                let std = nanoseconds(|| {
                    for (y, &x) in y.iter_mut().zip(&x) {
                        *y = standard(black_box(x));
                    }
                    black_box(&mut y);
                });
                report(name, single, block, std);
            }
        }
    )*};
}

macro_rules! bench_pair {
    ($filter:expr, $($name:ident $std:expr, $a:expr, $b:expr;)*) => {$(
        {
            lacuna::per_isa! {
                fn all_blocks[](a: &[F64x8], b: &[F64x8], y: &mut [F64x8]) {
                    for ((y, a), &b) in y.iter_mut().zip(a).zip(b) {
                        *y = a.$name(b);
                    }
                }
            }
            let name = stringify!($name);
            if $filter.as_ref().is_none_or(|f| f == name) {
                let a = arguments($a.0, $a.1);
                let mut b = arguments($b.0, $b.1);
                b.reverse();
                let mut y = a.clone();
                let (a_blocks, b_blocks) = (blocks(&a), blocks(&b));
                let mut y_blocks = a_blocks.clone();
                let single = nanoseconds(|| {
                    for ((y, &a), &b) in y.iter_mut().zip(&a).zip(&b) {
                        *y = Real::$name(black_box(a), b);
                    }
                    black_box(&mut y);
                });
                let block = nanoseconds(|| {
                    all_blocks(black_box(&a_blocks), &b_blocks, &mut y_blocks);
                    black_box(&mut y_blocks);
                });
                let standard: fn(f64, f64) -> f64 = $std;
                let std = nanoseconds(|| {
                    for ((y, &a), &b) in y.iter_mut().zip(&a).zip(&b) {
                        *y = standard(black_box(a), b);
                    }
                    black_box(&mut y);
                });
                report(name, single, block, std);
            }
        }
    )*};
}

fn main() {
    // `cargo bench` adds --bench
    let filter = std::env::args().skip(1).find(|a| !a.starts_with('-'));
    bench! { filter,
        exp f64::exp, -20.0, 20.0;
        ln f64::ln, 1e-3, 100.0;
        sin f64::sin, -10.0, 10.0;
        cos f64::cos, -10.0, 10.0;
        tan f64::tan, -10.0, 10.0;
        asin f64::asin, -1.0, 1.0;
        acos f64::acos, -1.0, 1.0;
        atan f64::atan, -5.0, 5.0;
        sinh f64::sinh, -10.0, 10.0;
        cosh f64::cosh, -10.0, 10.0;
        tanh f64::tanh, -5.0, 5.0;
        sqrt f64::sqrt, 0.0, 10.0;
    }
    bench_pair! { filter,
        atan2 f64::atan2, (-5.0, 5.0), (-5.0, 5.0);
        powf f64::powf, (0.0, 10.0), (-3.0, 3.0);
    }
}
