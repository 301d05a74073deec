//! Laws without a name in noise that remembers.

use super::*;
use crate::data::{Random, Record};
use crate::evidence::NoiseModel;
use crate::fit::problem::Part;
use crate::prepare::prepared::Prepared;
use crate::search::fixture::{self, Run, mass};
use crate::system::System;

/// A record of a machine in noise with a pole of 0.95.
fn record(machine: &System, seed: u64) -> Record {
    let mut record = fixture::record(machine, &Run { samples: 2000, seed, size: 1.0, noise: 0.0 });
    let (mut random, mut noise) = (Random::new(seed + 100), 0.0);
    for y in &mut record.outputs[0].values {
        noise = 0.95 * noise + 0.02 * random.normal();
        *y += noise;
    }
    record
}

/// What a record leaves of a mass on a spring: whether its noise remembers, and the scores that what is left
/// and that innovations follow from inputs.
fn left(record: Record) -> (bool, f64, f64) {
    let system = mass("");
    let mut prepared = Prepared::new(&system, &[record], 0.7).unwrap();
    let Prepared { problem, nominal, start, .. } = &mut prepared;
    let allowed = Allowed::default();
    let mut study = Study::new(problem, nominal, &allowed, 2, &());
    let y = study.problem.simulate(start, Grain::Coarse).unwrap();
    let noise = study.disturbance.white(&study.problem.residual(&y, Part::Fit));
    study.fit_and_keep(false, &[Wish { model: start.clone(), noise }], 8);
    let fit = study.beam.best().unwrap();
    (fit.noise.remembers(), study.dependence(&fit.model), study.unforeseen(fit))
}

#[test]
fn noise_that_remembers_is_no_reason_to_draw_curves() {
    for seed in 8..20 {
        let (remembers, left, innovations) = left(record(&mass(""), seed));
        assert!(remembers, "seed {seed}");
        assert!(left.max(innovations) < DEPENDS, "seed {seed}: {left} {innovations}");
    }
}

#[test]
fn what_a_law_does_in_such_noise_is_seen() {
    let hidden = "[[effects]]\ninto = \"f\"\nof = \"x\"\neffect.cubic = { coefficient = -3.0 }\n";
    for seed in 8..20 {
        let (remembers, left, innovations) = left(record(&mass(hidden), seed));
        assert!(remembers, "seed {seed}");
        assert!(left.max(innovations) > DEPENDS, "seed {seed}: {left} {innovations}");
    }
}
