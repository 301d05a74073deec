//! Model files: what is written reads as the same.

use lacuna::file::{self, Format};
use lacuna::system::Placed;

use super::shelf::{self, models, outputs, record, same_bits, working};

#[test]
fn every_model_survives_its_files() {
    for (name, system) in models() {
        let toml = file::to_toml(&system).unwrap();
        let again = file::parse(&toml, "again.toml", Format::Toml)
            .unwrap_or_else(|error| panic!("{name}: {}\n{toml}", error.pretty()));
        assert_eq!(file::to_toml(&again).unwrap(), toml, "{name}");
        assert_eq!(again.signals(), system.signals(), "{name}");
        let json = file::to_json(&system).unwrap();
        let again = file::parse(&json, "again.json", Format::Json)
            .unwrap_or_else(|error| panic!("{name}: {}\n{json}", error.pretty()));
        assert_eq!(file::to_toml(&again).unwrap(), toml, "{name}, by way of JSON");
    }
}

#[test]
fn every_parameter_has_a_place_in_the_models_own_table() {
    for (name, system) in models() {
        for parameter in system.signals().parameters {
            let value = parameter.value * 1.25 + 0.125;
            let change = [(parameter.name.clone(), value)];
            let changed = lacuna::model::with_parameters(system.model.as_ref(), &change)
                .unwrap_or_else(|error| panic!("{name}, {}: {error}", parameter.name));
            let signals = changed.signals();
            let found = signals.parameters.iter().find(|p| p.name == parameter.name);
            assert_eq!(found.map(|p| p.value), Some(value), "{name}, {}", parameter.name);
        }
    }
}

#[test]
fn every_effect_survives_its_files() {
    let system = &models().into_iter().find(|(name, _)| *name == "duffing").unwrap().1;
    for (card, effect) in lacuna::register::effects() {
        for effect in [effect.boxed(), working(effect.as_ref())] {
            let mut extended = system.clone();
            extended.effects.push(Placed::new(effect.boxed(), "u", None));
            let toml = file::to_toml(&extended).unwrap();
            let read = toml::from_str::<toml::Table>(&toml).unwrap();
            let table = read["effects"][0]["effect"].clone();
            let again: Box<dyn lacuna::effect::CandidateEffect> = table.try_into().unwrap();
            assert_eq!(again.card().values(), effect.card().values(), "{}", card.name);
            assert_eq!(format!("{again:?}"), format!("{effect:?}"), "{}", card.name);
        }
    }
}

#[test]
fn a_system_read_again_runs_the_same() {
    for (name, system) in models() {
        let toml = file::to_toml(&system).unwrap();
        let again = file::parse(&toml, "again.toml", Format::Toml).unwrap();
        let record = record(&system, 200);
        let (a, b) = (outputs(&system, &record), outputs(&again, &record));
        assert!(same_bits(&a, &b), "{name}");
        let moved = a.iter().flatten().any(|&y| y != a[0][0]);
        assert!(moved, "{name}: nothing happens in the example's simulation");
    }
}

#[test]
fn a_copy_is_the_model() {
    for (name, system) in models() {
        let copy = lacuna::model::copied(shelf::model(&system)).unwrap();
        assert_eq!(format!("{:?}", copy.signals()), format!("{:?}", system.signals()), "{name}");
    }
}
