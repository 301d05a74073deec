//! The initial state of a simulation, found from the first samples.

use lacuna::data::{FilteredNoise, Record};
use lacuna::evaluate::{Init, Simulation};
use lacuna::file::{Format, parse};
use lacuna::system::System;

/// An axis on a rail with dry friction, at `place` (in m) when nothing else is known.
fn axis(place: f64, outputs: &str) -> System {
    let text = format!(
        r#"
sampling_time = 0.001
integrator = {{ method = "rk4", substeps = 8 }}
[model.equations]
inputs = [{{ name = "force", unit = "N" }}]
states = [
  {{ name = "p", unit = "m", derivative = "v", initial = {place:?} }},
  {{ name = "v", unit = "m/s", derivative = "(force - c*v)/m" }},
]
outputs = [{outputs}]
parameters = [
  {{ name = "m", value = 12.0, unit = "kg", min = 0.0 }},
  {{ name = "c", value = 60.0, unit = "N s/m", min = 0.0 }},
]
channels = [{{ name = "rail", unit = "N", into = [{{ state = "v", gain = "1/m" }}] }}]
coordinates = [{{ name = "speed", unit = "m/s", value = "v", quantity = "velocity" }}]
[[effects]]
into = "rail"
of = "speed"
effect.coulomb_friction = {{ level = -35.0, width = 0.0005 }}
"#
    );
    parse(&text, "axis.toml", Format::Toml).unwrap()
}

/// A force that the friction bears for half a second, and is then too large for it.
fn record(outputs: &str) -> Record {
    let n = 4000;
    let push = FilteredNoise { rms: 120.0, cutoff: 3.0, order: 2 }.generate(n, 0.001, 4).unwrap();
    let force: Vec<f64> = (0..n).map(|k| if k < 500 { -2.0 } else { push[k] }).collect();
    let empty = Record::new(0.001).input("force", force).unwrap();
    let run = Simulation::of(&axis(0.09, outputs), &empty, Init::Samples(0)).unwrap();
    let with =
        |record: Record, (name, y): &(String, Vec<f64>)| record.output(name, y.clone()).unwrap();
    run.outputs.iter().fold(empty, with)
}

#[test]
fn a_machine_that_stands_still_at_first_begins_where_it_is_read() {
    let place = r#"{ name = "place", unit = "m", value = "p" }"#;
    let both = r#"{ name = "place", unit = "mm", value = "1000*p" }, { name = "rate", unit = "m/s", value = "v" }"#;
    for outputs in [place, both] {
        let record = record(outputs);
        for init in [Init::Forgotten, Init::Samples(50), Init::Samples(400)] {
            let run = Simulation::of(&axis(0.0, outputs), &record, init).unwrap();
            let (name, found) = &run.initial_state[0];
            assert!(name == "p" && (found - 0.09).abs() < 1e-6, "{init:?}: {found}");
            let (_, metrics) = &run.metrics[0];
            assert!(metrics.fit_percent > 99.9, "{init:?}: {metrics:?}");
        }
    }
}
