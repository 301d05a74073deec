//! Machines of other kinds, written as equations: six effects in each, from just above the
//! noise to far above it, one and two at a time.

use crate::exam::plants::{CART, CIRCUIT, HEATER, PENDULUM, TANKS};
use crate::exam::{Conditions, Hidden, Plant, USUAL, coefficient, hidden, names, value};

fn all() -> Vec<(&'static Plant, Vec<Hidden>)> {
    vec![
        (
            &PENDULUM,
            vec![
                hidden!("coulomb_friction", "torque_on_arm", Some("rate"), |s| format!(
                    "{{ level = {:?}, width = 0.02 }}",
                    -0.02 * s
                )),
                hidden!("drag", "torque_on_arm", Some("rate"), |s| coefficient(-0.01 * s)),
                hidden!("cubic", "torque_on_arm", Some("tilt"), |s| coefficient(-0.05 * s)),
                hidden!("bias", "torque_on_arm", None, |s| value(0.02 * s)),
                hidden!("parameter", "J", None, |s| value(0.02 * (1.0 + s))),
                hidden!("delay", "torque", Some("torque"), |s| format!(
                    "{{ delay = {:?} }}",
                    0.01 * s
                )),
            ],
        ),
        (
            &CIRCUIT,
            vec![
                hidden!("cubic", "coil", Some("current"), |s| coefficient(-s)),
                hidden!("quadratic", "leak", Some("charge_voltage"), |s| coefficient(-1e-4 * s)),
                hidden!("saturation", "supply", Some("supply"), |s| format!(
                    "{{ low = {:?}, high = {:?} }}",
                    -20.0 / s,
                    20.0 / s
                )),
                hidden!("parameter", "L", None, |s| value(1e-3 * (1.0 + s))),
                hidden!("gain", "voltage", Some("voltage"), |s| format!(
                    "{{ gain = {:?} }}",
                    0.05 * s
                )),
                hidden!("lag", "supply", Some("supply"), |s| format!(
                    "{{ time_constant = {:?} }}",
                    1e-6 * s
                )),
            ],
        ),
        (
            &TANKS,
            vec![
                hidden!("hinge", "inflow_1", Some("level_1"), |s| format!(
                    "{{ coefficient = {:?}, start = 7.0, side = 1.0 }}",
                    -0.01 * s
                )),
                hidden!("linear", "inflow_2", Some("level_2"), |s| coefficient(-0.002 * s)),
                hidden!("parameter", "a2", None, |s| value(0.12 * (1.0 + s))),
                hidden!("bias", "level", None, |s| value(0.1 * s)),
                // (a dead zone that the pump never enters would be an offset, nothing else)
                hidden!("quadratic", "pump", Some("pump"), |s| coefficient(-0.05 * s)),
                hidden!("drift", "b", Some("time"), |s| format!("{{ rate = {:?} }}", 1e-6 * s)),
            ],
        ),
        (
            &HEATER,
            vec![
                hidden!("quadratic", "heat_block", Some("hot"), |s| coefficient(-0.002 * s)),
                hidden!("cubic", "heat_case", Some("warm"), |s| coefficient(-0.0005 * s)),
                hidden!("bias", "heat_block", None, |s| value(s)),
                hidden!("parameter", "H", None, |s| value(2.0 * (1.0 + s))),
                hidden!("delay", "power", Some("power"), |s| format!(
                    "{{ delay = {:?} }}",
                    0.2 * s
                )),
                hidden!("gain", "block", Some("block"), |s| format!("{{ gain = {:?} }}", 0.02 * s)),
            ],
        ),
        (
            &CART,
            vec![
                hidden!("coulomb_friction", "push", Some("speed"), |s| format!(
                    "{{ level = {:?}, width = 0.02 }}",
                    -0.1 * s
                )),
                hidden!("drag", "push", Some("speed"), |s| coefficient(-0.1 * s)),
                hidden!("cubic", "push", Some("place"), |s| coefficient(-0.1 * s)),
                hidden!("parameter", "c", None, |s| value(2.0 * (1.0 + s))),
                hidden!("dead_zone", "force", Some("force"), |s| format!(
                    "{{ slope = 1.0, width = {:?} }}",
                    0.1 * s
                )),
                hidden!("linear", "push", Some("place"), |s| coefficient(-0.1 * s)),
            ],
        ),
    ]
}

#[test]
fn effects_are_found_in_machines_of_five_kinds() {
    let sizes = [0.5, 1.0, 2.0, 4.0];
    let (mut named, mut count, mut poor) = (0, 0, vec![]);
    let mut told = |plant: &Plant, hidden: &[&Hidden], c: Conditions| {
        let (machine, record) = plant.guilty(hidden, c);
        let finding = plant.diagnose(&record);
        let hit = hidden.iter().all(|h| finding.causes.iter().any(|cause| h.is_named(cause)));
        let removed = plant.removed(&machine, &finding, c);
        let what: Vec<String> = hidden
            .iter()
            .map(|h| format!("{}>{}<{}", h.effect, h.into, h.of.unwrap_or("-")))
            .collect();
        println!(
            "| {} | {} | {} | {} | {removed:.4} | {:.1} | {} |",
            plant.name,
            what.join(" + "),
            c.g,
            if hit { "yes" } else { "NO" },
            finding.seconds,
            names(&finding)
        );
        count += 1;
        named += usize::from(hit);
        if hit && removed < 0.95 {
            poor.push(format!("{} {}: {removed:.3}", plant.name, what.join(" + ")));
        }
    };
    println!(
        "| plant | hidden | g | named | removed | s | found |\n| --- | --- | --- | --- | --- | --- | --- |"
    );
    for (p, (plant, effects)) in all().iter().enumerate() {
        for (i, hidden) in effects.iter().enumerate() {
            let c =
                Conditions { g: sizes[(p + i) % 4], seed: (10 * p + i) as u64, n: 3000, ..USUAL };
            told(plant, &[hidden], c);
        }
        let c = Conditions { g: 1.5, seed: 70 + p as u64, n: 3000, ..USUAL };
        told(plant, &[&effects[0], &effects[3]], c);
    }
    println!("{named} of {count} named; removed less than 95 %: {poor:?}");
    assert!(named * 10 >= count * 9, "{named} of {count}");
    assert!(poor.is_empty(), "{poor:?}");
}
