//! Records in which nothing is hidden in the machine, as hostile as measured ones: what is named?
//!
//! `LACUNA_NULLS=25 cargo test --workspace --test diagnosis -- --ignored --nocapture nulls::` makes so many
//! of each kind and machine; two without it.

use crate::exam::plants::{HEATER, MSD, PENDULUM};
use crate::exam::{Conditions, Plant, USUAL, names};
use lacuna::data::{Record, noise};
use lacuna::diagnose::Verdict;

const N: usize = 1500;

/// What a record becomes: the clean output, white noise of deviation one, the output's deviation.
type Spoils = fn(&[f64], &[f64], f64, usize) -> f64;

/// Kinds, and whether a fault of the data is the right answer.
const KINDS: [(&str, bool, Spoils); 6] = [
    ("white noise, 5 % of the output", false, |y, e, size, k| y[k] + 0.05 * size * e[k]),
    ("random walk of the sensor, 2 % in 100 samples", false, |y, e, size, k| {
        let walk: f64 = e[..k].iter().rev().sum();
        y[k] + 0.002 * size * (walk + e[k])
    }),
    ("sensor not connected", true, |_, e, size, k| 0.3 * size + 0.05 * size * e[k]),
    ("sensor dead", true, |_, _, size, _| 0.3 * size),
    ("one reading a thousand times too large", true, |y, e, size, k| match k {
        60 => 1000.0 * size,
        _ => y[k] + 0.03 * size * e[k],
    }),
    ("no noise but that of six digits", false, |y, _, _, k| {
        format!("{:.5e}", y[k]).parse().unwrap_or(y[k])
    }),
];

fn spoilt(plant: &Plant, seed: u64, spoils: Spoils) -> Record {
    let conditions = Conditions { n: N, snr_db: 300.0, seed, ..USUAL };
    let mut record = plant.innocent(conditions);
    for (o, output) in record.outputs.iter_mut().enumerate() {
        let (clean, size) = (output.values.clone(), output.std());
        let e = noise::white(N, 1.0, 1000 * seed + o as u64).unwrap();
        output.values = (0..N).map(|k| spoils(&clean, &e, size, k)).collect();
    }
    record
}

#[test]
#[ignore = "takes minutes: see the module"]
fn nothing_is_named_where_nothing_is_hidden() {
    let count = std::env::var("LACUNA_NULLS").ok().and_then(|n| n.parse().ok()).unwrap_or(2);
    let (mut all, mut wrong) = (0, 0);
    println!("kind | records | cause in the machine | unexplained | fault of the data");
    for (kind, at_fault, spoils) in KINDS {
        let (mut records, mut named, mut open, mut faults) = (0, 0, 0, 0);
        for plant in [&MSD, &PENDULUM, &HEATER] {
            for seed in 0..count {
                let finding = plant.diagnose(&spoilt(plant, 700 + seed, spoils));
                records += 1;
                let is_named = finding.in_the_machine().next().is_some();
                named += u32::from(is_named);
                open += u32::from(finding.verdict == Verdict::Unexplained);
                faults += u32::from(finding.causes.iter().any(|cause| cause.is_data_fault()));
                if is_named {
                    println!("  {} {seed}: {}", plant.name, names(&finding));
                }
            }
        }
        println!("{kind} | {records} | {named} | {open} | {faults}");
        assert!(!at_fault || faults == records, "{kind}: {faults} of {records}");
        (all, wrong) = (all + records, wrong + named);
    }
    assert!(100 * wrong <= all, "{wrong} of {all}");
}
