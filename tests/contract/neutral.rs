//! At its neutral value an effect changes nothing, to the last bit, wherever it stands.

use lacuna::effect::{CandidateEffect, Mechanism};
use lacuna::system::{Hold, Placed, System};
use rayon::prelude::*;

use super::shelf::{extend, models, neutral, outputs, places, record, same_bits, working};

/// An effect with the value that changes nothing at this place: another value of a
/// parameter is neutral at the present one.
fn neutral_here(
    system: &System,
    effect: &dyn CandidateEffect,
    placed: &Placed,
) -> Vec<Box<dyn CandidateEffect>> {
    if effect.card().mechanism != Mechanism::Parameter {
        return neutral(effect);
    }
    let parameters = system.signals().parameters;
    let own = parameters.iter().find(|p| p.name == placed.into).unwrap();
    vec![effect.with_values(&[own.value]).unwrap()]
}

/// The same system, its inputs between samples held in another way.
fn holding(system: &System, hold: Hold) -> System {
    let mut system = system.clone();
    system.sampling.hold = hold;
    system
}

/// How often each effect stood in a model, and where it changed something.
fn neutral_in(name: &str, system: &System) -> (Vec<usize>, Vec<String>) {
    let effects = lacuna::register::effects();
    let (mut stood, mut failures) = (vec![0; effects.len()], vec![]);
    let record = record(system, 60);
    let held = [Hold::Zero, Hold::First];
    let plain = held.map(|hold| outputs(&holding(system, hold), &record));
    for (number, (card, effect)) in effects.iter().enumerate() {
        for placed in places(system, working(effect.as_ref()).as_ref()) {
            for neutral in neutral_here(system, effect.as_ref(), &placed) {
                let placed = Placed { effect: neutral, ..placed.clone() };
                let told = format!("{} into {} of {:?}", card.name, placed.into, placed.of);
                let Some(extended) = extend(system, [placed]) else {
                    panic!("{name}: {told} stands there, but not when neutral")
                };
                for (hold, plain) in held.into_iter().zip(&plain) {
                    stood[number] += 1;
                    let extended = holding(&extended, hold);
                    if !same_bits(&outputs(&extended, &record), plain) {
                        let effect = &extended.effects[0].effect;
                        failures.push(format!("{name}, {hold:?}: {told}: {effect:?}"));
                    }
                }
            }
        }
    }
    (stood, failures)
}

#[test]
fn every_effect_at_every_place_of_every_model() {
    let all: Vec<_> =
        models().into_par_iter().map(|(name, system)| neutral_in(name, &system)).collect();
    for (number, (card, _)) in lacuna::register::effects().into_iter().enumerate() {
        let stood: usize = all.iter().map(|(stood, _)| stood[number]).sum();
        assert!(stood >= 8, "{} was tried at only {stood} places", card.name);
    }
    let failures: Vec<&str> =
        all.iter().flat_map(|(_, failures)| failures).map(String::as_str).collect();
    assert!(failures.is_empty(), "{} changes:\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn no_effect_is_neutral_at_other_values() {
    // the other half of the test above: values that should do something do, somewhere
    for (card, effect) in lacuna::register::effects() {
        if effect.card().mechanism == Mechanism::Data {
            continue;
        }
        let effect = working(effect.as_ref());
        let acts = models().into_iter().any(|(_, system)| {
            let record = record(&system, 60);
            let plain = outputs(&system, &record);
            places(&system, effect.as_ref()).into_iter().any(|placed| {
                let extended = extend(&system, [placed]).unwrap();
                !same_bits(&outputs(&extended, &record), &plain)
            })
        });
        assert!(acts, "{} does nothing anywhere", card.name);
    }
}
