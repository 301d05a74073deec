//! Friction that remembers where it turned, in a plant that is disturbed.

use lacuna::data::Record;
use lacuna::diagnose::Diagnosis;

use super::is_the_one_cause;
use super::plants::{Sizes, excitation, simulate_by, system};

/// A carriage that a motor drives.
const CARRIAGE: &str = r#"
sampling_time = 0.02
integrator = { method = "rk4", substeps = 2 }
[model.equations]
inputs = [{ name = "force", unit = "N" }]
states = [{ name = "x", unit = "m", derivative = "v" }, { name = "v", unit = "m/s", derivative = "(force - c*v)/m" }]
outputs = [{ name = "position", unit = "m", value = "x" }]
parameters = [{ name = "m", value = 5.0, min = 0.0 }, { name = "c", value = 4.0, min = 0.0 }]
channels = [{ name = "on_carriage", unit = "N", into = [{ state = "v", gain = "1/m" }] }]
coordinates = [{ name = "place", unit = "m", value = "x", quantity = "position" }, { name = "speed", unit = "m/s", value = "v", quantity = "velocity" }]
"#;

/// Before it slides it is a spring, which no law of speed is.
#[test]
fn hysteresis_is_found_beside_random_forces_in_a_loop() {
    const STIFFNESS: f64 = 600.0;
    // what the simulator remembers is a state of the machine
    let held = CARRIAGE.replace("(force - c*v)", "(force - c*v - s)").replace(
        "states = [",
        "states = [{ name = \"s\", unit = \"N\", derivative = \"600*v - 60*abs(v)*s - 40*v*abs(s)\" }, ",
    );
    for seed in [51, 52] {
        let wanted = excitation(2500, 0.02, 0.06, seed);
        let noise = Sizes { white: vec![0.5], measurement: vec![0.0003], ..Sizes::default() };
        let (mut before, mut force) = (0.0, vec![]);
        let drive = |k: usize, seen: &[f64]| {
            force.push(300.0 * (wanted[k] - seen[0]) - 40.0 * (seen[0] - before) / 0.02);
            before = seen[0];
            force[k]
        };
        let acted = simulate_by(&system(&held), wanted.len(), &noise, seed + 10, drive);
        let record = Record::new(0.02).input("force", force).unwrap();
        let record = record.output("position", acted.outputs[0].values.clone()).unwrap();
        let finding = Diagnosis::of(&system(CARRIAGE)).run(&[record], None, &()).unwrap();
        is_the_one_cause(&finding, ("hysteresis", "on_carriage"), (STIFFNESS, 0.2));
    }
}
