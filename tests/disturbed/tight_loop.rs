//! A controller that feeds a sensor's noise back: the input of a sample follows the noise of that sample.

use lacuna::data::{Random, Record};
use lacuna::diagnose::{Diagnosis, Verdict};

use super::plants::{excitation, system};

const STEP: f64 = 0.05;
/// Deviation of the sensor's noise.
const NOISE: f64 = 0.01;

/// A cart on a spring, and one on a rail that has none.
fn cart(k: f64) -> String {
    format!(
        r#"
sampling_time = 0.05
[model.equations]
inputs = [{{ name = "force", unit = "N" }}]
states = [{{ name = "p", unit = "m", derivative = "v" }}, {{ name = "v", unit = "m/s", derivative = "(force - k*p - d*v)/m" }}]
outputs = [{{ name = "position", unit = "m", value = "p" }}]
parameters = [{{ name = "m", value = 1.0, unit = "kg" }}, {{ name = "d", value = 0.8 }}, {{ name = "k", value = {k} }}]
"#
    )
}

/// A record of that cart under a controller that reads the position of the same sample.
fn record(k: f64, seed: u64) -> Record {
    let wanted = excitation(2000, STEP, 0.25, seed);
    let mut random = Random::new(seed);
    let (mut p, mut v, mut before, mut sum) = (0.0, 0.0, 0.0, 0.0);
    let (mut force, mut position) = (vec![], vec![]);
    for wanted in wanted {
        let seen = p + NOISE * random.normal();
        let off = wanted - seen;
        sum += STEP * off;
        let u = 8.0 * off - 4.0 * (seen - before) / STEP + sum;
        before = seen;
        force.push(u);
        position.push(seen);
        // midpoint rule in steps of 1 ms
        for _ in 0..50 {
            let rate = |p: f64, v: f64| u - k * p - 0.8 * v;
            let (half_p, half_v) = (p + 5e-4 * v, v + 5e-4 * rate(p, v));
            (p, v) = (p + 1e-3 * half_v, v + 1e-3 * rate(half_p, half_v));
        }
    }
    Record::new(STEP).input("force", force).unwrap().output("position", position).unwrap()
}

/// The model is right; most of what moves the force from sample to sample is noise.
#[test]
fn noise_that_a_controller_feeds_back_is_no_error_of_the_model() {
    for (k, seed) in [(4.0, 31), (4.0, 32), (0.0, 33), (0.0, 34)] {
        let plant = system(&cart(k));
        let finding = Diagnosis::of(&plant).run(&[record(k, seed)], None, &()).unwrap();
        assert_eq!(finding.verdict, Verdict::NothingFound, "{k} {seed}: {}", finding.dependence);
        let noise = finding.noise_floor["position"].std;
        assert!((noise / NOISE - 1.0).abs() < 0.1, "{k} {seed}: {noise}");
    }
}
