//! What a sensor does in the loop of a known controller: the controller acts on what it is told.

use crate::hard_plants::states_later;
use lacuna::data::{FilteredNoise, Random, Record};
use lacuna::diagnose::Diagnosis;
use lacuna::evaluate::{Init, Simulation};
use lacuna::file::{Format, parse, to_json, to_toml};
use lacuna::lfr::Sampled;
use lacuna::system::{Drive, System, Transition};

/// A slide on a spring, with a strain gauge at the spring: where the slide is and what holds it are two
/// readings, so that an offset of one of them is no force and no offset of the other.
const PLANT: &str = r#"
sampling_time = 0.01
integrator = { method = "rk4", substeps = 4 }
[model.equations]
inputs = [{ name = "force", unit = "N" }]
states = [
  { name = "p", unit = "m", derivative = "v" },
  { name = "v", unit = "m/s", derivative = "(force - c*v - k*p)/m" },
]
outputs = [{ name = "place", unit = "m", value = "p" }, { name = "strain", unit = "N", value = "k*p" }]
parameters = [
  { name = "m", value = 2.0, unit = "kg", min = 0.0 },
  { name = "c", value = 3.0, unit = "N s/m", min = 0.0 },
  { name = "k", value = 150.0, unit = "N/m", fixed = true },
]
channels = [{ name = "on_slide", unit = "N", into = [{ state = "v", gain = "1/m" }] }]
coordinates = [{ name = "speed", unit = "m/s", value = "v", quantity = "velocity" }]
[controller]
references = ["r"]
measured = ["place"]
drives = ["force"]
inject = ["d"]
[controller.law.lti]
A = [[0.7]]
B = [[0.3, -0.3]]
C = [[-800.0]]
D = [[1100.0, -1100.0]]
"#;

fn system(effects: &str) -> System {
    parse(&format!("{PLANT}\n{effects}"), "slide.toml", Format::Toml).unwrap()
}

/// The closed loop with effects at its outputs, where `system` has them within its plant.
fn around(effects: &[&str]) -> System {
    let mut outside = system("");
    for effects in effects {
        let within = parse(&open(effects), "open.toml", Format::Toml).unwrap();
        outside.effects.extend(within.effects);
    }
    outside
}

/// The plant alone, with effects.
fn open(effects: &str) -> String {
    let plant = PLANT.split("[controller]").next().unwrap_or_default();
    format!("{plant}\n{effects}")
}

/// The loop driven by its reference, with noise at the sensor that the controller sees.
fn driven(offset: f64, noise: f64, n: usize, seed: u64) -> Record {
    let reference = FilteredNoise { rms: 0.05, cutoff: 1.0, order: 2 };
    let r = reference.generate(n, 0.01, seed).unwrap();
    let push = FilteredNoise { rms: 2.0, cutoff: 3.0, order: 2 };
    let d = push.generate(n, 0.01, 100 + seed).unwrap();
    let mut random = Random::new(200 + seed);
    let (mut x, mut memory) = ([0.0, 0.0], 0.0);
    let (mut place, mut strain) = (vec![], vec![]);
    for k in 0..n {
        let told = x[0] + offset + noise * random.normal();
        place.push(told);
        strain.push(150.0 * x[0] + 150.0 * noise * random.normal());
        let force = -800.0 * memory + 1100.0 * (r[k] - told) + d[k];
        memory = 0.7 * memory + 0.3 * (r[k] - told);
        x = states_later(x, 0.01, |x| [x[1], (force - 3.0 * x[1] - 150.0 * x[0]) / 2.0]);
    }
    let record = Record::new(0.01).input("r [m]", r).unwrap().input("d [N]", d).unwrap();
    record.output("place [m]", place).unwrap().output("strain [N]", strain).unwrap()
}

fn outputs(system: &System, record: &Record) -> Vec<Vec<f64>> {
    let run = Simulation::of(system, record, Init::Samples(0)).unwrap();
    run.outputs.into_iter().map(|(_, series)| series).collect()
}

/// Largest difference between two simulations, as a share of the largest value.
fn apart(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    let pairs = || a.iter().zip(b);
    let off = pairs().map(|(a, b)| {
        let most = a.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        a.iter().zip(b).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())) / most
    });
    off.fold(0.0, f64::max)
}

const BIAS: &str = "[[effects]]\ninto = \"place\"\neffect.bias = { value = 0.02 }\n";
const GAIN: &str = "[[effects]]\ninto = \"place\"\nof = \"place\"\neffect.gain = { gain = 0.1 }\n";
const BOUNDS: &str = "[[effects]]\ninto = \"place\"\nof = \"place\"\n\
    effect.saturation = { low = -0.03, high = 0.04 }\n";
const LAG: &str =
    "[[effects]]\ninto = \"place\"\nof = \"place\"\neffect.lag = { time_constant = 0.02 }\n";

#[test]
fn one_entry_means_one_machine_wherever_it_stands() {
    let record = driven(0.0, 0.0, 400, 1);
    let healthy = outputs(&system(""), &record);
    assert!(apart(&healthy, &driven_outputs(&record)) < 1e-6, "the loop is the one that was run");
    for (effects, near) in [(&[BIAS][..], 1e-9), (&[GAIN], 1e-9), (&[BOUNDS], 1e-9), (&[LAG], 0.02)]
    {
        let within = outputs(&system(&effects.concat()), &record);
        let outside = outputs(&around(effects), &record);
        assert!(apart(&within, &outside) < near, "{effects:?}: {}", apart(&within, &outside));
        assert!(apart(&within[1..], &healthy[1..]) > 0.05, "{effects:?} moves the slide itself");
        // within a model that learns, and linearised: the plant is linear
        let step = Sampled::where_needed(&around(effects), 0.01).unwrap();
        assert!(apart(&outputs(&step, &record), &outside) < 1e-9, "{effects:?}");
        let linear = outputs(&linearised(&around(effects)), &record);
        assert!(apart(&linear, &outside) < 1e-9, "{effects:?}: {}", apart(&linear, &outside));
        // as it is saved
        let saved = to_toml(&around(effects)).unwrap();
        let again = outputs(&parse(&saved, "saved.toml", Format::Toml).unwrap(), &record);
        assert!(apart(&outside, &again) < 1e-12, "{effects:?}");
    }
    // an output that the controller does not see reaches nothing
    let blind = "[[effects]]\ninto = \"strain\"\neffect.bias = { value = 1.0 }\n";
    let unseen = outputs(&around(&[blind]), &record);
    assert_eq!(unseen[0], healthy[0]);
}

/// The loop's linearisation, with the same effects.
fn linearised(system: &System) -> System {
    let mut table: serde_json::Value = serde_json::from_str(&to_json(system).unwrap()).unwrap();
    let model = table["model"].take();
    table["model"] = serde_json::json!({ "linearised": { "of": model } });
    parse(&table.to_string(), "linear.json", Format::Json).unwrap()
}

fn driven_outputs(record: &Record) -> Vec<Vec<f64>> {
    record.outputs.iter().map(|signal| signal.values.clone()).collect()
}

/// What a filter is told along a sensor's addition is the difference that an offset makes, whether the step
/// is recorded (long records) or simulated.
#[test]
fn what_a_sensor_adds_moves_the_next_state() {
    let next = |system: &System, samples: usize| {
        let plan = system.plan(0.01).unwrap();
        let (theta, values) = (plan.signals.theta(), plan.effect_values());
        let wave = |by: f64| (0..samples).map(|k| (by * k as f64).sin()).collect();
        let inputs = vec![wave(0.3), wave(0.2)];
        let drive =
            Drive { inputs, segments: std::iter::once(0..samples).collect(), clocks: vec![0.0] };
        let mut of = Transition::new(system, &plan, &drive, (&theta, &values), false).unwrap();
        let (n, ny) = (of.states(), plan.sizes.y);
        let (mut y, mut c) = (vec![0.0; ny], vec![0.0; ny * n]);
        let (mut x, mut to) = (vec![0.1; n], of.jacobian());
        of.start(0);
        of.place(&x);
        of.observe(5, &mut y, &mut c, &mut []);
        // a filter moves the states by what it has read
        x[0] += 0.05;
        of.place(&x);
        of.advance(5, &vec![0.0; of.forces()], &mut x, &mut to);
        (x, to)
    };
    let offset = |value: f64| around(&[&BIAS.replace("0.02", &format!("{value:?}"))]);
    for samples in [40, 400] {
        let (none, slopes) = next(&system(""), samples);
        let (some, same) = next(&offset(0.01), samples);
        assert_eq!(slopes.read.len(), 2 * none.len());
        for i in 0..none.len() {
            let difference = (some[i] - none[i]) / 0.01;
            assert!((slopes.read[2 * i] - difference).abs() < 1e-9, "{samples} {i}");
            assert_eq!(slopes.read[2 * i + 1], 0.0);
            assert!((slopes.a[i] - same.a[i]).abs() < 1e-9);
        }
        // the controller's memory takes 0.3 of the deviation
        assert!((slopes.read[2 * (none.len() - 1)] + 0.3).abs() < 1e-12);
    }
}

#[test]
fn an_offset_of_a_sensor_that_a_known_controller_reads_is_the_only_cause() {
    for seed in [11, 12] {
        let record = driven(0.02, 0.0005, 3000, seed);
        let finding = Diagnosis::of(&system("")).run(&[record], None, &()).unwrap();
        assert_eq!(finding.causes.len(), 1, "{finding}");
        let cause = &finding.causes[0];
        assert_eq!((cause.effect.as_str(), cause.into.as_str()), ("bias", "place"), "{finding}");
        let value = cause.parameters[0].value;
        assert!((value - 0.02).abs() < 0.001, "{value} {finding}");
    }
}
