use std::slice::from_ref;

use super::{REACTS, scores};
use crate::data::{
    Excitation, FilteredNoise, Lines, Multisine, Phases, Prbs, Sequence, Steps, noise,
};

const N: usize = 3000;

/// Filtered noise, a multisine that does not repeat, a two-level sequence, steps.
fn excitations() -> Vec<(&'static str, Excitation)> {
    let lines = Lines::Full { from: 1, to: Some(300) };
    vec![
        ("noise", Excitation::FilteredNoise(FilteredNoise { rms: 1.0, cutoff: 0.5, order: 2 })),
        (
            "multisine",
            Excitation::Multisine(Multisine {
                period: N,
                lines,
                rms: 1.0,
                phases: Phases::Random,
                crest_iterations: 0,
            }),
        ),
        (
            "prbs",
            Excitation::Prbs(Prbs { amplitude: 1.0, clock: 5, sequence: Sequence::Telegraph {} }),
        ),
        ("steps", Excitation::Steps(Steps { low: -1.0, high: 1.0, hold_min: 10, hold_max: 80 })),
    ]
}

fn coloured(pole: f64, size: f64, seed: u64) -> Vec<f64> {
    match pole {
        0.0 => noise::white(N, size, seed).unwrap(),
        pole => noise::ar1(N, pole, size, seed).unwrap(),
    }
}

/// Both scores of the one input.
fn of_one(u: Vec<f64>, e: Vec<f64>) -> (f64, f64) {
    scores(&[u], (&[e], &[true]), from_ref(&(0..N)))[0]
}

#[test]
fn no_loop_is_seen_where_none_is() {
    let (mut alarms, mut tests, mut largest) = (0, 0, 0.0_f64);
    for (name, excitation) in excitations() {
        for pole in [0.0, 0.9] {
            for seed in 1..=40 {
                let u = excitation.generate(N, 0.1, seed).unwrap();
                let (at_once, later) = of_one(u, coloured(pole, 0.3, 1000 + seed));
                let score = at_once.max(later);
                largest = largest.max(score);
                if score > REACTS {
                    println!("{name}, pole {pole}, seed {seed}: {at_once:.1} {later:.1}");
                    alarms += 1;
                }
                tests += 1;
            }
        }
    }
    println!("{alarms} alarms in {tests} records; the largest score is {largest:.1}");
    assert!(alarms == 0, "{alarms} of {tests}");
}

/// An input that a proportional controller makes of a reference and of a plant of first order
/// with noise, `late` samples late; and the noise.
fn controlled(gain: f64, late: usize, pole: f64, size: f64, seed: u64) -> (Vec<f64>, Vec<f64>) {
    let reference = FilteredNoise { rms: 1.0, cutoff: 0.5, order: 2 };
    let reference = reference.generate(N, 0.1, seed).unwrap();
    let e = coloured(pole, size, 1000 + seed);
    let (mut x, mut u, mut y) = (0.0, vec![], vec![]);
    for k in 0..N {
        y.push(x + e[k]);
        u.push(gain * (reference[k] - if k < late { 0.0 } else { y[k - late] }));
        x += 0.1 * (u[k] - x);
    }
    (u, e)
}

#[test]
fn a_loop_is_seen() {
    let mut seen = vec![];
    for (late, pole, size) in
        [(1, 0.0, 0.1), (1, 0.9, 0.1), (0, 0.9, 0.1), (0, 0.0, 0.1), (2, 0.0, 0.03)]
    {
        let (mut later, mut any) = (0, 0);
        for seed in 1..=40 {
            let (u, e) = controlled(2.0, late, pole, size, seed);
            let found = of_one(u, e);
            later += usize::from(found.1 > REACTS);
            any += usize::from(found.0.max(found.1) > REACTS);
        }
        println!(
            "{late} late, pole {pole}, noise {size}: {later} with a delay, {any} at all, of 40"
        );
        seen.push(any);
    }
    assert!(seen.iter().all(|&seen| seen >= 38), "{seen:?}");
}

#[test]
fn too_few_samples_say_nothing() {
    let u = noise::white(100, 1.0, 1).unwrap();
    let u = from_ref(&u);
    assert_eq!(scores(u, (u, &[true]), from_ref(&(0..100))), [(0.0, 0.0)]);
    assert_eq!(scores(u, (u, &[true]), &[]), [(0.0, 0.0)]);
}
