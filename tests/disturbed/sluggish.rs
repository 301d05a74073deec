//! Instruments that remember, in a plant that is disturbed.

use lacuna::data::Record;
use lacuna::diagnose::Diagnosis;

use super::is_the_one_cause;
use super::plants::{Sizes, excitation, simulate_by, system};

/// A body that turns, with its rate and its angle measured.
const BODY: &str = r#"
sampling_time = 0.01
integrator = { method = "rk4", substeps = 2 }
[model.equations]
inputs = [{ name = "torque", unit = "N m" }]
states = [{ name = "turn", unit = "rad", derivative = "rate" }, { name = "rate", unit = "rad/s", derivative = "(torque - d*rate)/j" }]
outputs = [{ name = "gyro", unit = "rad/s", value = "rate" }, { name = "attitude", unit = "rad", value = "turn" }]
parameters = [{ name = "j", value = 0.02, min = 0.0 }, { name = "d", value = 0.03, min = 0.0 }]
channels = [{ name = "on_body", unit = "N m", into = [{ state = "rate", gain = "1/j" }] }]
coordinates = [{ name = "speed", unit = "rad/s", value = "rate", quantity = "velocity" }]
"#;

/// Gusts that the loop feeds back drown a simulation, not a predictor.
#[test]
fn a_slow_actuator_is_found_beside_gusts_in_a_loop() {
    // what the simulator remembers is a state of the machine, or the course of what was commanded
    let slow = BODY.replace("(torque - d*rate)", "(acts - d*rate)").replace(
        "states = [",
        "states = [{ name = \"acts\", unit = \"N m\", derivative = \"(torque - acts)/0.06\" }, ",
    );
    for (machine, late, effect, value) in [(&slow[..], 0, "lag", 0.06), (BODY, 5, "delay", 0.05)] {
        let wanted = excitation(2500, 0.01, 0.4, 21);
        let noise = Sizes {
            slow: vec![0.004],
            fades: 0.1,
            measurement: vec![0.02, 0.002],
            ..Sizes::default()
        };
        let mut commanded: Vec<f64> = vec![];
        let drive = |k: usize, seen: &[f64]| {
            commanded.push(0.5 * (wanted[k] - seen[1]) - 0.15 * seen[0]);
            commanded[k.saturating_sub(late)]
        };
        let acted = simulate_by(&system(machine), wanted.len(), &noise, 22, drive);
        let mut record = Record::new(0.01).input("torque", commanded).unwrap();
        for output in &acted.outputs {
            record = record.output(&output.name, output.values.clone()).unwrap();
        }
        let finding = Diagnosis::of(&system(BODY)).run(&[record], None, &()).unwrap();
        is_the_one_cause(&finding, (effect, "torque"), (value, 0.1));
    }
}

/// An oven, its element before its chamber.
const OVEN: &str = r#"
sampling_time = 2.0
integrator = { method = "rk4", substeps = 2 }
[model.equations]
inputs = [{ name = "power", unit = "W" }]
states = [{ name = "element", unit = "K", derivative = "(power - g*(element - chamber))/1200" }, { name = "chamber", unit = "K", derivative = "(g*(element - chamber) - loss*chamber)/c" }]
outputs = [{ name = "temperature", unit = "K", value = "chamber" }]
parameters = [{ name = "g", value = 15.0, min = 0.0 }, { name = "c", value = 3000.0, min = 0.0 }, { name = "loss", value = 6.0, min = 0.0 }]
channels = [{ name = "heat", unit = "W", into = [{ state = "chamber", gain = "1/c" }] }]
"#;

/// In a linear plant a lag before it does what one behind it does; what enters between the two tells.
#[test]
fn a_slow_sensor_is_told_from_a_slow_actuator_by_what_disturbs_the_plant() {
    const LAG: f64 = 25.0;
    let slow = OVEN.replace("value = \"chamber\"", "value = \"read\"").replace(
        "states = [",
        "states = [{ name = \"read\", unit = \"K\", derivative = \"(chamber - read)/25\" }, ",
    );
    for seed in [41, 42] {
        let wanted = excitation(1800, 0.02, 10.0, seed);
        let noise = Sizes { white: vec![150.0], measurement: vec![0.02], ..Sizes::default() };
        let (mut sum, mut power) = (0.0, vec![]);
        let drive = |k: usize, seen: &[f64]| {
            let off = wanted[k] - seen[0];
            sum += 2.0 * off;
            power.push(40.0 * off + 0.3 * sum);
            power[k]
        };
        let acted = simulate_by(&system(&slow), wanted.len(), &noise, seed + 10, drive);
        let record = Record::new(2.0).input("power", power).unwrap();
        let record = record.output("temperature", acted.outputs[0].values.clone()).unwrap();
        let finding = Diagnosis::of(&system(OVEN)).run(&[record], None, &()).unwrap();
        is_the_one_cause(&finding, ("lag", "temperature"), (LAG, 0.1));
    }
}
