//! A system with effects is a system like any other: it is saved, read, run, extended.

use lacuna::effect::Mechanism;
use lacuna::file::{self, Format};

use super::shelf::{extend, models, outputs, places, record, same_bits, working};

#[test]
fn saved_read_run_and_extended_again() {
    for (name, system) in models() {
        let record = record(&system, 80);
        for (card, effect) in lacuna::register::effects() {
            let effect = working(effect.as_ref());
            let Some(placed) = places(&system, effect.as_ref()).into_iter().next() else {
                continue;
            };
            let once = extend(&system, [placed.clone()]).unwrap();
            // in memory and by way of both kinds of file
            let mut kept = system.clone();
            kept.effects.push(placed.clone());
            let json = file::to_json(&once).unwrap();
            let from_json = file::parse(&json, "extended.json", Format::Json).unwrap();
            let run = outputs(&once, &record);
            assert!(same_bits(&run, &outputs(&kept, &record)), "{name}, {}", card.name);
            assert!(same_bits(&run, &outputs(&from_json, &record)), "{name}, {}", card.name);
            let text = file::to_toml(&once).unwrap();
            assert_eq!(file::to_toml(&from_json).unwrap(), text, "{name}, {}", card.name);
            // a second one stands beside the first
            let Some(twice) = extend(&once, [placed]) else {
                panic!("{name} with {} cannot be extended again", card.name)
            };
            assert_eq!(twice.effects.len(), 2);
            let again = outputs(&twice, &record);
            let idle = matches!(effect.card().mechanism, Mechanism::Data | Mechanism::Parameter);
            if !idle && !same_bits(&run, &outputs(&system, &record)) {
                assert!(!same_bits(&again, &run), "{name}: a second {} does nothing", card.name);
            }
        }
    }
}
