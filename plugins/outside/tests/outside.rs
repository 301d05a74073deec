//! What a stranger's crate can count on.

use lacuna::data::{FilteredNoise, Record, noise};
use lacuna::diagnose::{Diagnosis, Verdict};
use lacuna::encoder::{Baseline, Encoder, EncoderInitialiser, LinearEncoder, Outputs, Window};
use lacuna::evaluate::{Init, Simulation};
use lacuna::file::{self, Format};
use lacuna::optimise::{Optimiser, shelf};
use lacuna::system::System;
use lacuna_outside::{Extrapolate, HoldLast};

const CIRCUIT: &str = "sampling_time = 0.02
[model.rc_circuit]
resistance = 1000.0
capacitance = 1e-4
";
const DIODE: &str = "[[effects]]
into = \"current\"
of = \"v\"
effect.diode = { saturation = -1e-4, scale = 0.4 }
";

fn parse(text: &str) -> System {
    file::parse(text, "circuit.toml", Format::Toml).unwrap_or_else(|e| panic!("{}", e.pretty()))
}

/// A noisy record of a system.
fn record(system: &System, samples: usize, seed: u64) -> Record {
    let step = system.sampling.sampling_time.unwrap();
    let drive = FilteredNoise { cutoff: 2.0, order: 2, rms: 1.0 };
    let u = drive.generate(samples, step, seed).unwrap();
    let drive = Record::new(step).input("u [V]", u).unwrap();
    let clean = Simulation::of(system, &drive, Init::Samples(0)).unwrap().outputs.swap_remove(0).1;
    let noise = noise::at_snr(&clean, 30.0, seed + 1).unwrap();
    let y: Vec<f64> = clean.iter().zip(noise).map(|(y, e)| y + e).collect();
    drive.output("y [V]", y).unwrap()
}

#[test]
fn both_are_on_the_shelf() {
    let names: Vec<&str> = lacuna::register::registered().iter().map(|card| card.name).collect();
    assert!(names.contains(&"rc_circuit") && names.contains(&"diode"), "{names:?}");
}

#[test]
fn files_name_them_and_misspelt_keys_are_answered() {
    let extended = parse(&format!("{CIRCUIT}{DIODE}"));
    let text = file::to_toml(&extended).unwrap();
    assert_eq!(file::to_toml(&parse(&text)).unwrap(), text);
    let wrong = CIRCUIT.replace("resistance", "resistence");
    let error = file::parse(&wrong, "circuit.toml", Format::Toml).unwrap_err();
    assert!(error.pretty().contains("did you mean `resistance`"), "{}", error.pretty());
    let wrong = format!("{CIRCUIT}{}", DIODE.replace("diode", "doide"));
    let error = file::parse(&wrong, "circuit.toml", Format::Toml).unwrap_err();
    assert!(error.pretty().contains("did you mean `diode`"), "{}", error.pretty());
}

#[test]
fn the_neutral_effect_changes_nothing_to_the_last_bit() {
    let plain = parse(CIRCUIT);
    let neutral = parse(&format!("{CIRCUIT}{}", DIODE.replace("-1e-4", "0.0")));
    let record = record(&plain, 300, 5);
    let run = |system| Simulation::of(system, &record, Init::Samples(0)).unwrap().outputs;
    assert_eq!(run(&plain), run(&neutral));
    assert_ne!(run(&plain), run(&parse(&format!("{CIRCUIT}{DIODE}"))));
}

#[test]
fn a_strangers_effect_in_a_strangers_system_is_named() {
    let truth = parse(&format!("{CIRCUIT}{DIODE}"));
    let (est, test) = (record(&truth, 2000, 1), record(&truth, 1000, 3));
    let system = parse(CIRCUIT);
    let finding = Diagnosis::of(&system).run(&[est], Some(&test), &()).unwrap();
    assert_eq!(finding.verdict, Verdict::CausesFound, "{finding}");
    let cause = &finding.causes[0];
    assert_eq!((cause.effect.as_str(), cause.into.as_str()), ("diode", "current"), "{finding}");
    assert!(finding.gain.error_removed > 0.95, "{finding}");
    let scale = cause.parameters.iter().find(|p| p.name == "scale").unwrap();
    assert!((scale.value - 0.4).abs() < 0.08, "{scale:?}");
}

#[test]
fn an_optimiser_named_by_a_file() {
    let lion: Box<dyn Optimiser> = toml::from_str("[lion]\nrate = 0.01\nsteps = 4000").unwrap();
    let problem = shelf::rosenbrock(2);
    let mut theta = problem.start.clone();
    let outcome = lion.minimise(&problem, &mut theta, &mut ()).unwrap();
    assert!(outcome.loss < 1e-3, "{outcome:?} at {theta:?}");
}

#[test]
fn an_encoder_and_an_initialiser() {
    let text = "sampling_time = 0.01\nintegrator = { substeps = 4 }\n\
        [model.duffing]\nmass = 1.0\ndamping = 2.0\nstiffness = 50.0\n";
    let system = parse(text);
    let u = FilteredNoise { cutoff: 3.0, order: 2, rms: 5.0 }.generate(800, 0.01, 1).unwrap();
    let record = Record::new(0.01).input("u [N]", u).unwrap();
    let baseline = Baseline::new(&system, &record).unwrap();
    // from an encoder without weights
    let mut encoder: Box<dyn Encoder> = Box::new(Extrapolate::new(0.01));
    baseline.prepare(encoder.as_mut(), 0).unwrap();
    let score = baseline.score(encoder.as_ref(), Outputs::Simulated).unwrap();
    assert!(score[0].nrmse < 0.01 && score[1].nrmse < 0.2, "{score:?}");
    // and from an initialiser of our own for one of the library's
    let mut encoder = LinearEncoder::new(Window::past(3));
    let started = HoldLast {}.initialise(&mut encoder, &baseline, 0).unwrap();
    assert!(started.states[0].nrmse < 0.2, "{started}");
    assert!(started.states[1].nrmse > 0.9, "a state that is held at 0 explains nothing: {started}");
}
