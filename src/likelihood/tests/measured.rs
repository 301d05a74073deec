//! Measured records of others, and times.

use std::path::Path;
use std::time::Instant;

use lacuna_core::data::{Record, Step, Table, Want};
use lacuna_core::file::load;
use lacuna_core::system::System;

use super::plants::{GANTRY, Sizes, excitation, simulate, system};
use crate::replay::Pass;
use crate::{Predictor, places};

#[test]
#[ignore = "a measurement of time"]
fn one_pass_of_4000_samples() {
    let plant = system(GANTRY);
    let sizes = Sizes { white: vec![2.0], measurement: vec![0.002, 0.004], ..Sizes::default() };
    let record = simulate(&plant, &excitation(4000, 0.02, 20.0, 2), &sizes, 3);
    let predictor = Predictor::new(&plant, &[record]).unwrap();
    let mut noise = predictor.white(vec![4e-6, 1.6e-5]);
    noise.white[0] = 4.0;
    for slow in &mut noise.slow {
        *slow = crate::Slow::walk(1e-4);
    }
    let time = |name: &str, mut work: Box<dyn FnMut() + '_>| {
        work();
        let begun = busy();
        (0..20).for_each(|_| work());
        println!("{name}: {:.2} ms", 50.0 * (busy() - begun));
    };
    time("filter", Box::new(|| drop(predictor.run(&predictor.model, &noise, Default::default()))));
    let path = predictor.run(&predictor.model, &noise, Default::default()).unwrap().path;
    let mut pass = Pass::of(&path, &noise, false);
    time(
        "replay",
        Box::new(|| {
            pass.forward(&path, &noise);
        }),
    );
    let pass = Pass::of(&path, &noise, false);
    let along = noise.components();
    let mut slopes = vec![0.0; along.len()];
    time("score", Box::new(|| pass.gradient(&path, &noise, &along, &mut slopes)));
    let begun = Instant::now();
    let chosen = predictor.fit_noise().unwrap();
    println!("noise {:.2} s: {:?}", begun.elapsed().as_secs_f64(), chosen.noise);
}

/// Seconds that this thread has been on a processor, where the system tells.
fn busy() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    text.split(' ').next().and_then(|ns| ns.parse::<f64>().ok()).unwrap_or(0.0) * 1e-9
}

fn read(model: &Path, record: &Path) -> (System, Record) {
    let system = load(model).unwrap();
    let signals = system.signals();
    let pairs = |signals: &[lacuna_core::model::Signal]| {
        signals.iter().map(|s| (s.name.clone(), s.unit.clone())).collect()
    };
    let want = Want {
        inputs: pairs(&signals.inputs),
        outputs: pairs(&signals.outputs),
        step: Step::Free { default: system.sampling.sampling_time },
        outputs_required: true,
        minimum: 4,
    };
    let record = Table::open(record).unwrap().record_for(&want).unwrap().0;
    (system, record)
}

/// MODEL=.. DATA=..,.. cargo test -p lacuna-likelihood measured::a_record -- --ignored --nocapture
#[test]
#[ignore = "needs MODEL and DATA"]
fn a_record() {
    let (model, data) = (std::env::var("MODEL").unwrap(), std::env::var("DATA").unwrap());
    let all: Vec<_> = data.split(',').map(|d| read(Path::new(&model), Path::new(d))).collect();
    let (systems, records): (Vec<System>, Vec<Record>) = all.into_iter().unzip();
    let begun = Instant::now();
    let found = places(&systems[0], &records).unwrap();
    println!("{:.1} s, noise {:?}", begun.elapsed().as_secs_f64(), found.noise);
    for place in found.places.iter().take(6) {
        println!("{:9.1} {} of {:?}", place.log_evidence, place.into, place.of);
    }
    for set in found.sets.iter().take(8) {
        let laws: Vec<String> = set
            .laws
            .iter()
            .map(|l| {
                format!(
                    "{} into {} of {:?} {:?}",
                    l.effect.typetag_name(),
                    l.into,
                    l.of,
                    l.effect.card().values()
                )
            })
            .collect();
        println!(
            "{:9.1} P {:.3} {laws:?} {:?} {:?}",
            set.log_odds,
            set.probability,
            set.parameters,
            set.noise.components()
        );
    }
}
