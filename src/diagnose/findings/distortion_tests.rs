use super::{AtLines, Distortion, Lit};
use crate::data::{Lines, Multisine, Phases, Record, noise};

const PERIOD: usize = 1000;

fn multisine(lines: Lines, seed: u64) -> Vec<f64> {
    let settings =
        Multisine { period: PERIOD, lines, rms: 1.0, phases: Phases::Random, crest_iterations: 0 };
    settings.generate(4 * PERIOD, 0.01, seed).unwrap()
}

fn odd_random() -> Lines {
    Lines::OddRandom { from: 1, to: Some(199), group: 4 }
}

/// A low-pass filter followed by a curve.
fn answer(u: &[f64], curve: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut x = 0.0;
    let filtered = u.iter().map(|u| {
        x += 0.3 * (u - x);
        curve(x)
    });
    filtered.collect()
}

/// The last `periods` of an answer with noise.
fn found(u: &[f64], y: &[f64], e: &[f64], periods: usize) -> Option<Distortion> {
    let from = u.len() - periods * PERIOD;
    let y: Vec<f64> = y.iter().zip(e).map(|(y, e)| y + e).collect();
    let record = Record::new(0.01).input("u", u[from..].to_vec()).unwrap();
    let record = record.output("y", y[from..].to_vec()).unwrap();
    Lit::of(&record)?.distortion(&record.outputs[0].values)
}

fn white(size: f64, seed: u64) -> Vec<f64> {
    noise::white(4 * PERIOD, size, seed).unwrap()
}

fn there(at: &Option<AtLines>) -> bool {
    at.as_ref().unwrap().present
}

#[test]
fn odd_and_even_laws_show_where_they_should() {
    let u = multisine(odd_random(), 1);
    for periods in [2, 3, 4] {
        let seen = |curve: fn(f64) -> f64| {
            let found = found(&u, &answer(&u, curve), &white(0.05, 2), periods).unwrap();
            assert_eq!(found.periods, periods);
            (there(&found.odd), there(&found.even))
        };
        assert_eq!(seen(|x| x - 0.1 * x * x * x), (true, false));
        assert_eq!(seen(|x| x - 0.1 * x * x), (false, true));
        assert_eq!(seen(|x| x - 0.5 * x.max(0.5)), (true, true));
        assert_eq!(seen(|x| x), (false, false));
    }
}

#[test]
fn sizes_are_those_of_the_distortion_and_of_the_noise() {
    let u = multisine(odd_random(), 3);
    let (bent, plain) = (answer(&u, |x| x - 0.3 * x * x), answer(&u, |x| x));
    let found = found(&u, &bent, &white(0.02, 4), 3).unwrap();
    let even = found.even.unwrap();
    // 99 of 500 lines, three periods averaged
    assert_eq!(even.lines, 99);
    let expected = 0.02 * (99.0_f64 / 500.0 / 3.0).sqrt();
    assert!((even.noise_rms / expected - 1.0).abs() < 0.15, "{} {expected}", even.noise_rms);
    // all that an even law adds but its mean is even
    let last = 3 * PERIOD;
    let added: Vec<f64> = bent[last..].iter().zip(&plain[last..]).map(|(a, b)| a - b).collect();
    let size = crate::statistics::deviation(&added);
    assert!((even.rms / size - 1.0).abs() < 0.1, "{} {size}", even.rms);
    assert!((found.excited_rms / crate::statistics::deviation(&plain) - 1.0).abs() < 0.01);
}

#[test]
fn noise_is_no_distortion_whatever_its_colour() {
    let (mut alarms, mut tests) = (0, 0);
    for (pole, periods) in [(0.0, 2), (0.0, 4), (0.9, 2), (0.9, 4), (0.99, 2), (0.99, 4)] {
        let before = alarms;
        for seed in 1..=100 {
            let u = multisine(odd_random(), seed);
            let e = match pole {
                0.0 => white(0.3, 1000 + seed),
                pole => noise::ar1(4 * PERIOD, pole, 0.3, 1000 + seed).unwrap(),
            };
            let found = found(&u, &answer(&u, |x| x), &e, periods).unwrap();
            alarms += usize::from(there(&found.odd)) + usize::from(there(&found.even));
            tests += 2;
        }
        println!("pole {pole}, {periods} periods: {} of 200", alarms - before);
    }
    println!("{alarms} alarms in {tests} tests");
    assert!(alarms <= 6, "{alarms} of {tests} at a level of 0.1 %");
}

#[test]
fn a_start_that_has_not_settled_is_no_distortion() {
    for (periods, kept) in [(4, 3), (2, 2)] {
        let u = multisine(odd_random(), 5);
        let mut y = answer(&u, |x| x);
        let from = u.len() - periods * PERIOD;
        for (k, y) in y[from..].iter_mut().enumerate() {
            *y += 2.0 * (-(k as f64) / 60.0).exp();
        }
        let found = found(&u, &y, &white(0.02, 6), periods).unwrap();
        assert_eq!((there(&found.odd), there(&found.even), found.periods), (false, false, kept));
    }
}

#[test]
fn a_few_missing_samples_do_no_harm() {
    let u = multisine(odd_random(), 7);
    let mut y = answer(&u, |x| x - 0.1 * x * x * x);
    for k in [3010, 3333, 2100] {
        y[k] = f64::NAN;
    }
    let found = found(&u, &y, &white(0.02, 8), 2).unwrap();
    assert_eq!((there(&found.odd), there(&found.even)), (true, false));
}

#[test]
fn without_empty_lines_or_a_second_period_nothing_is_said() {
    let e = white(0.02, 9);
    let cubed = |u: &[f64]| answer(u, |x| x * x * x);
    let u = multisine(odd_random(), 9);
    assert_eq!(found(&u, &cubed(&u), &e, 1), None);
    let full = multisine(Lines::Full { from: 1, to: Some(199) }, 9);
    assert_eq!(found(&full, &cubed(&full), &e, 4), None);
    // with all odd lines excited up to the top, only even ones are empty
    let odd = multisine(Lines::Odd { from: 1, to: None }, 9);
    let even_only = found(&odd, &cubed(&odd), &e, 4).unwrap();
    assert!(even_only.odd.is_none() && !there(&even_only.even));
}

#[test]
fn an_input_written_with_three_decimals_is_no_distortion() {
    let round = |u: f64| (1000.0 * u).round() / 1000.0;
    let u: Vec<f64> = multisine(odd_random(), 10).into_iter().map(round).collect();
    let found = found(&u, &answer(&u, |x| x), &vec![0.0; 4 * PERIOD], 2).unwrap();
    assert_eq!((there(&found.odd), there(&found.even)), (false, false));
}
