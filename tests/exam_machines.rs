//! The machines of `examples/exam`: each runs as its field expects, before anything is hidden in it.

use std::path::Path;

use lacuna::data::Record;
use lacuna::file::{Document, load};
use lacuna::study::Exam;

/// Machine, output, and the range in which it lives, in its unit.
const LIVES: [(&str, &str, f64, f64); 17] = [
    ("hidden_friction", "position", -0.3, 0.3),
    ("friction_loop", "position", -1.5, 1.5),
    ("gantry", "x1", -0.3, 0.3),
    ("gantry", "x2", -0.3, 0.3),
    ("gantry", "head", -0.6, 0.6),
    ("valve", "stem", 0.0, 20.0),
    ("valve", "flow", 0.0, 40.0),
    ("magnet", "gap", -2e-3, 2e-3),
    ("fermenter", "x", 1.0, 8.0),
    ("fermenter", "s", 0.1, 6.0),
    ("elevator", "sheave", -10.0, 10.0),
    ("elevator", "velocity", -3.0, 3.0),
    ("heat_pump", "floor", 15.0, 50.0),
    ("heat_pump", "room", 10.0, 35.0),
    ("rotor", "probe_x", -0.6, 0.6),
    ("rotor", "probe_y", -0.6, 0.6),
    ("pendulum", "angle", -2.0, 2.0),
];

fn refs(of: &[String]) -> Vec<&str> {
    of.iter().map(String::as_str).collect()
}

#[test]
fn sixteen_machines_of_different_fields_live_where_they_should() {
    let examples = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/exam"));
    let readme = std::fs::read_to_string(examples.join("README.md")).unwrap();
    let (mut seen, mut machines) = (0, vec![]);
    for file in ["exam.toml", "unseen.toml"] {
        let mut exam: Exam = Document::load(&examples.join(file)).unwrap().read().unwrap();
        (exam.seeds, exam.nulls, exam.pairs, exam.triples, exam.singles) = (1, 1, 0, 0, false);
        (exam.samples, exam.sizes) = (vec![800], vec![1.0]);
        for machine in &mut exam.systems {
            machine.outside.clear();
        }
        let systems: Vec<_> =
            exam.systems.iter().map(|m| load(&examples.join(&m.model)).unwrap()).collect();
        let name = format!("lacuna-machines-{}-{file}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        let written = exam.write(&systems, 1, &folder, &()).unwrap();
        assert_eq!(written, exam.systems.len());
        for (k, machine) in exam.systems.iter().enumerate() {
            let name = machine.name();
            let listed = readme.lines().find(|line| line.contains(&machine.model)).unwrap();
            assert_eq!(listed.contains("**no**"), file == "unseen.toml", "{listed}");
            let signals = systems[k].signals();
            let names = |of: &[lacuna::model::Signal]| -> Vec<String> {
                of.iter().map(|signal| signal.name.clone()).collect()
            };
            let (inputs, outputs) = (names(&signals.inputs), names(&signals.outputs));
            let path = folder.join(format!("cases/case{}/record1.csv", k + 1));
            let record = Record::csv(&path).unwrap().pick(&refs(&inputs), &refs(&outputs)).unwrap();
            assert_eq!(record.len(), 800);
            for signal in &record.outputs {
                assert!(signal.std() > 0.0, "{name}: {} stands still", signal.name);
                let lives = LIVES.iter().find(|l| l.0 == name && l.1 == signal.name);
                let Some((_, _, low, high)) = lives else { continue };
                seen += 1;
                let inside = signal.values.iter().all(|y| low <= y && y <= high);
                assert!(inside, "{name}: {} leaves {low} to {high}", signal.name);
            }
            machines.push(name);
        }
        std::fs::remove_dir_all(&folder).unwrap();
    }
    assert_eq!((seen, machines.len()), (LIVES.len(), 16));
}
