//! Noise whose level follows the output or time, and noise with heavy tails: nothing of the machine, no
//! outliers; and a law beside it is found.

use crate::exam::plants::PENDULUM;
use crate::exam::{Conditions, USUAL, names, placed};
use lacuna::data::{Record, noise};
use lacuna::diagnose::Verdict;

const N: usize = 2500;

/// Noise of a sample: normal numbers, the output in units of its deviation, the share of the record
/// that has passed.
type Noise = fn([f64; 5], f64, f64) -> f64;

const NOISES: [(&str, Noise); 3] = [
    ("follows the output", |e, y, _| e[0] * (0.01 + y * y).sqrt()),
    ("grows", |e, _, t| e[0] * (0.4 + 1.2 * t)),
    // Student's t of four degrees of freedom
    ("heavy tails", |[e, rest @ ..], _, _| {
        e / (rest.iter().map(|e| e * e).sum::<f64>() / 2.0).sqrt()
    }),
];

fn with_noise(mut record: Record, seed: u64, noise_of: Noise) -> Record {
    let e: [Vec<f64>; 5] =
        std::array::from_fn(|i| noise::white(N, 1.0, 100 * seed + i as u64).unwrap());
    for output in &mut record.outputs {
        let size = output.std();
        for (k, y) in output.values.iter_mut().enumerate() {
            let e = std::array::from_fn(|i| e[i][k]);
            *y += 0.1 * size * noise_of(e, *y / size, k as f64 / N as f64);
        }
    }
    record
}

const QUIET: Conditions = Conditions { n: N, snr_db: 300.0, ..USUAL };

#[test]
fn nothing_is_named_in_noise_of_changing_level_or_of_heavy_tails() {
    for (name, noise) in NOISES {
        for seed in 0..3 {
            let clean = PENDULUM.innocent(Conditions { seed: 60 + seed, ..QUIET });
            let finding = PENDULUM.diagnose(&with_noise(clean, seed, noise));
            assert_eq!(finding.verdict, Verdict::NothingFound, "{name}: {}", names(&finding));
        }
    }
}

#[test]
fn drag_is_named_in_noise_that_follows_the_output() {
    let drag = placed("torque_on_arm", Some("rate"), "drag = { coefficient = -0.02 }");
    let clean = PENDULUM.noisy_record(&PENDULUM.with(&[drag]), Conditions { seed: 64, ..QUIET });
    let finding = PENDULUM.diagnose(&with_noise(clean, 7, NOISES[0].1));
    let first = &finding.causes[0];
    assert_eq!(finding.verdict, Verdict::CausesFound);
    assert_eq!(first.into, "torque_on_arm", "{}", names(&finding));
    assert!(first.holds("drag", "torque_on_arm", Some("rate")), "{}", names(&finding));
    let value = first.parameters.iter().find(|p| p.name == "coefficient").unwrap();
    let off = (value.value + 0.02).abs() / value.std_error.unwrap();
    assert!(off < 4.0, "{value:?}");
}
