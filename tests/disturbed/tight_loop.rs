//! A controller that feeds a sensor's noise back: the input of a sample follows the noise of that sample.

use lacuna::data::{Random, Record};
use lacuna::diagnose::{Diagnosis, Verdict};

use super::plants::{excitation, system};

const STEP: f64 = 0.05;
/// Deviation of the sensor's noise.
const NOISE: f64 = 0.01;

/// A cart on a spring, or on a rail that has none; `more` are outputs beside its position.
fn cart(k: f64, more: &str) -> String {
    format!(
        r#"
sampling_time = 0.05
[model.equations]
inputs = [{{ name = "force", unit = "N" }}]
states = [{{ name = "p", unit = "m", derivative = "v" }}, {{ name = "v", unit = "m/s", derivative = "(force - k*p - d*v)/m" }}]
outputs = [{{ name = "position", unit = "m", value = "p" }}{more}]
parameters = [{{ name = "m", value = 1.0, unit = "kg" }}, {{ name = "d", value = 0.8 }}, {{ name = "k", value = {k} }}]
"#
    )
}

/// A record of that cart under a controller that reads the position of the same sample; the acceleration that
/// goes with it.
fn record(k: f64, seed: u64) -> (Record, Vec<f64>) {
    let wanted = excitation(2000, STEP, 0.25, seed);
    let mut random = Random::new(seed);
    let (mut p, mut v, mut before, mut sum) = (0.0, 0.0, 0.0, 0.0);
    let (mut force, mut position, mut felt) = (vec![], vec![], vec![]);
    for wanted in wanted {
        let seen = p + NOISE * random.normal();
        let off = wanted - seen;
        sum += STEP * off;
        let u = 8.0 * off - 4.0 * (seen - before) / STEP + sum;
        before = seen;
        force.push(u);
        position.push(seen);
        felt.push(u - k * p - 0.8 * v + NOISE * random.normal());
        // midpoint rule in steps of 1 ms
        for _ in 0..50 {
            let rate = |p: f64, v: f64| u - k * p - 0.8 * v;
            let (half_p, half_v) = (p + 5e-4 * v, v + 5e-4 * rate(p, v));
            (p, v) = (p + 1e-3 * half_v, v + 1e-3 * rate(half_p, half_v));
        }
    }
    let record = Record::new(STEP).input("force", force).unwrap();
    (record.output("position", position).unwrap(), felt)
}

/// The model is right; most of what moves the force from sample to sample is noise.
#[test]
fn noise_that_a_controller_feeds_back_is_no_error_of_the_model() {
    for (k, seed) in [(4.0, 31), (4.0, 32), (0.0, 33), (0.0, 34)] {
        let (plant, record) = (system(&cart(k, "")), record(k, seed).0);
        let finding = Diagnosis::of(&plant).run(&[record], None, &()).unwrap();
        assert_eq!(finding.verdict, Verdict::NothingFound, "{k} {seed}: {}", finding.dependence);
        let noise = finding.noise_floor["position"].std;
        assert!((noise / NOISE - 1.0).abs() < 0.1, "{k} {seed}: {noise}");
    }
}

/// An accelerometer feels the force of the same sample, a position does not.
#[test]
fn nor_is_it_where_another_output_feels_the_input_at_once() {
    let felt = r#", { name = "felt", unit = "m/s^2", value = "(force - k*p - d*v)/m" }"#;
    for seed in [35, 36] {
        let (record, acceleration) = record(4.0, seed);
        let record = record.output("felt", acceleration).unwrap();
        let finding = Diagnosis::of(&system(&cart(4.0, felt))).run(&[record], None, &()).unwrap();
        assert_eq!(finding.verdict, Verdict::NothingFound, "{seed}: {}", finding.dependence);
        for output in ["position", "felt"] {
            let noise = finding.noise_floor[output].std;
            assert!((noise / NOISE - 1.0).abs() < 0.1, "{output} {seed}: {noise}");
        }
    }
}
