//! Accuracy against reference values, and equality over block sizes and instruction sets.

use super::*;

mod special;

const INF: f64 = f64::INFINITY;
const NAN: f64 = f64::NAN;
const LEAST: f64 = 5e-324;

type Single = fn(f64) -> f64;
type Pair = fn(f64, f64) -> f64;
/// Name, function, bound on its error in ulps, reference values.
type Case<F> = (&'static str, F, f64, &'static str);

macro_rules! singles {
    ($($name:ident $bound:literal),* $(,)?) => {
        [$((
            stringify!($name),
            (|x| $name([x])[0]) as fn(f64) -> f64,
            $bound,
            include_str!(concat!("../../../../tests/data/elementary/", stringify!($name), ".csv")),
        )),*]
    };
}

fn single_functions() -> [Case<Single>; 11] {
    singles![
        exp 0.8, ln 0.9, sin 0.85, cos 0.85, tan 1.1, asin 0.75, acos 0.75, atan 0.8,
        sinh 0.85, cosh 0.75, tanh 0.8,
    ]
}

fn pair_functions() -> [Case<Pair>; 2] {
    [
        (
            "atan2",
            |y, x| atan2([y], [x])[0],
            0.75,
            include_str!("../../../../tests/data/elementary/atan2.csv"),
        ),
        (
            "pow",
            |x, y| pow([x], [y])[0],
            1.0,
            include_str!("../../../../tests/data/elementary/pow.csv"),
        ),
    ]
}

/// Distance from `x` to the next number away from zero.
fn ulp(x: f64) -> f64 {
    let size = x.abs();
    if size == f64::MAX { size - size.next_down() } else { size.next_up() - size }
}

/// The numbers of every row of a reference table.
fn rows(table: &str) -> impl Iterator<Item = Vec<f64>> {
    table.lines().skip(2).map(|row| row.split(',').map(|n| n.parse().unwrap()).collect())
}

/// Checks every row: arguments, the value to double precision, what it lacks in ulps.
fn check_accuracy(name: &str, bound: f64, table: &str, f: impl Fn(&[f64]) -> f64) {
    let mut count = 0;
    for row in rows(table) {
        let (arguments, reference) = row.split_at(row.len() - 2);
        let (value, rest) = (reference[0], reference[1]);
        let got = f(arguments);
        let error = if value == 0.0 {
            assert_eq!(got.to_bits(), value.to_bits(), "{name}{arguments:?}");
            0.0
        } else {
            ((got - value) / ulp(value) - rest).abs()
        };
        assert!(error <= bound, "{name}{arguments:?} = {got:e}: {error} ulp from {value:e}");
        count += 1;
    }
    assert!(count > 200, "{name}: only {count} rows");
}

#[test]
fn reference_values_are_met_within_the_stated_bounds() {
    for (name, f, bound, table) in single_functions() {
        check_accuracy(name, bound, table, |x| f(x[0]));
    }
    for (name, f, bound, table) in pair_functions() {
        check_accuracy(name, bound, table, |x| f(x[0], x[1]));
    }
}

/// The same number, with the sign of zero; any NaN equals any other.
fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}

/// Random numbers by splitmix64.
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Any bit pattern, a number of ordinary size, or a special one.
    fn number(&mut self) -> f64 {
        let special = [0.0, -0.0, INF, -INF, NAN, 1.0, -1.0, LEAST, 0.5, 823549.0, 2.0, -3.0];
        let bits = self.bits();
        match self.bits() % 8 {
            0 => f64::from_bits(bits),
            1 => special[(bits % 12) as usize],
            2 | 3 => (bits as i64) as f64 * 2e-16,
            4 => (bits as i64) as f64 * 1e-13,
            _ => (bits as i64) as f64 / 9.3e18,
        }
    }

    fn block<const N: usize>(&mut self) -> [f64; N] {
        std::array::from_fn(|_| self.number())
    }
}

/// The functions on blocks of N numbers equal the functions on each number alone.
macro_rules! blocks_equal_singles {
    ($n:literal, $random:expr, $($name:ident($($arg:ident),*))*) => {$(
        for _ in 0..1500 {
            $(let $arg: [f64; $n] = $random.block();)*
            let block = $name($($arg),*);
            for i in 0..$n {
                let [single] = $name($([$arg[i]]),*);
                let (name, arguments) = (stringify!($name), ($($arg[i],)*));
                assert!(
                    same(single, block[i]),
                    "{name}{arguments:?}: {single:e} alone, {:e} among {}", block[i], $n
                );
            }
        }
    )*};
}

#[test]
fn blocks_equal_single_numbers_to_the_last_bit() {
    let mut random = Random(7);
    macro_rules! for_blocks_of {
        ($($n:literal),*) => {$(
            blocks_equal_singles!($n, random, exp(x) ln(x) sin(x) cos(x) tan(x) asin(x) acos(x)
                atan(x) sinh(x) cosh(x) tanh(x) atan2(x, y) pow(x, y));
        )*};
    }
    for_blocks_of!(1, 5, 8, 16);
}

/// The functions on blocks of eight equal those compiled for wider instructions.
#[cfg(target_arch = "x86_64")]
macro_rules! instruction_sets_agree {
    ($($name:ident($($arg:ident),*))*) => {$({
        #[target_feature(enable = "avx2,fma")]
        fn avx2($($arg: [f64; 8]),*) -> [f64; 8] { $name($($arg),*) }
        #[target_feature(enable = "avx2,fma,avx512f,avx512dq,avx512vl")]
        fn avx512($($arg: [f64; 8]),*) -> [f64; 8] { $name($($arg),*) }
        let has_avx2 = is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma");
        let has_avx512 = has_avx2 && is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512dq") && is_x86_feature_detected!("avx512vl");
        let mut random = Random(11);
        for _ in 0..3000 {
            $(let $arg: [f64; 8] = random.block();)*
            let narrow = $name($($arg),*);
            // SAFETY: the features were detected on this processor.
            let wide = if has_avx2 { unsafe { avx2($($arg),*) } } else { narrow };
            // SAFETY: as above.
            let wider = if has_avx512 { unsafe { avx512($($arg),*) } } else { narrow };
            for i in 0..8 {
                let (name, arguments) = (stringify!($name), ($($arg[i],)*));
                let [plain, avx2, avx512] = [narrow[i], wide[i], wider[i]];
                assert!(
                    same(plain, avx2) && same(plain, avx512),
                    "{name}{arguments:?}: {plain:e}, AVX2 {avx2:e}, AVX-512 {avx512:e}"
                );
            }
        }
    })*};
}

#[cfg(target_arch = "x86_64")]
#[test]
fn instruction_sets_agree_to_the_last_bit() {
    instruction_sets_agree!(exp(x) ln(x) sin(x) cos(x) tan(x) asin(x) acos(x) atan(x) sinh(x)
        cosh(x) tanh(x) atan2(x, y) pow(x, y));
}

#[test]
fn signs_and_the_smaller_and_larger_of_two() {
    for (x, want) in [(3.0, 1.0), (-LEAST, -1.0), (0.0, 0.0), (-0.0, -0.0), (INF, 1.0), (NAN, NAN)]
    {
        assert!(same(sign(x), want), "sign({x})");
        assert!(same(f64::from(sign(x as f32)), if x == -LEAST { -0.0 } else { want }));
    }
    for (a, b) in [(1.0, 2.0), (-INF, INF), (-0.0, LEAST), (f64::MIN, f64::MAX)] {
        assert!(same(smaller(a, b), a) && same(smaller(b, a), a));
        assert!(same(larger(a, b), b) && same(larger(b, a), b));
    }
    for f in [smaller, larger] {
        assert!(same(f(0.0, -0.0), 0.0) && same(f(-0.0, 0.0), -0.0), "the first at a tie");
        assert!(f(NAN, 1.0).is_nan() && f(1.0, NAN).is_nan() && f(NAN, NAN).is_nan());
    }
}
