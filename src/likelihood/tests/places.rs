//! Places and laws: nothing where nothing is, friction where friction is.

use super::plants::{
    GANTRY, OSCILLATOR, SLIDE, Sizes, excitation, simulate, simulate_by, system, with,
};
use crate::places;
use lacuna_core::data::Record;
use lacuna_core::system::Placed;

const FRICTION: [(&str, &str); 3] = [
    (
        SLIDE,
        "into = \"on_slide\"\nof = \"speed\"\neffect.coulomb_friction = { level = -3.0, width = 0.01 }",
    ),
    (
        OSCILLATOR,
        "into = \"on_mass\"\nof = \"rate\"\neffect.coulomb_friction = { level = -0.4, width = 0.02 }",
    ),
    (
        GANTRY,
        "into = \"on_trolley\"\nof = \"trolley_speed\"\neffect.coulomb_friction = { level = -4.0, width = 0.03 }",
    ),
];

const PLACES: [(&str, &str); 3] =
    [("on_slide", "speed"), ("on_mass", "rate"), ("on_trolley", "trolley_speed")];

/// Process noise, a noisy input, wandering sensors: of each plant in turn.
fn sizes(plant: usize, kind: usize) -> Sizes {
    let measurement = [vec![1e-4], vec![0.01], vec![0.001, 0.002]][plant].clone();
    let force = [1.0, 0.3, 2.0][plant];
    let forces = if plant == 2 { 3 } else { 2 };
    let mut white = vec![0.0; forces];
    match kind {
        0 => white[0] = force,
        1 => white[forces - 1] = force,
        _ => {}
    }
    let wander = if kind == 2 { measurement.iter().map(|r| 0.3 * r).collect() } else { vec![] };
    Sizes { white, measurement, wander, ..Sizes::default() }
}

fn record(plant: usize, hidden: bool, kind: usize, n: usize, seed: u64) -> Record {
    let (text, friction) = FRICTION[plant];
    let truth = if hidden { with(text, friction) } else { system(text) };
    let sizes = sizes(plant, kind);
    let step = truth.sampling.sampling_time.unwrap();
    if plant > 0 {
        let size = [0.0, 1.0, 20.0][plant];
        return simulate(&truth, &excitation(n, step, size, seed), &sizes, seed + 100);
    }
    // the slide is no plant to leave alone: a controller holds it
    let wanted = excitation(n, step, 0.1, seed);
    let mut before = 0.0;
    simulate_by(&truth, n, &sizes, seed + 100, |k, y| {
        let rate = (y[0] - before) / step;
        before = y[0];
        90.0 * (wanted[k] - y[0]) - 5.0 * rate
    })
}

/// Whether friction is named at its place, whether the place is the right one, whether anything is
/// named, and all that in words.
fn judged(
    plant: usize,
    hidden: bool,
    kind: usize,
    n: usize,
    seed: u64,
) -> (bool, bool, bool, String) {
    let found =
        places(&system(FRICTION[plant].0), &[record(plant, hidden, kind, n, seed)]).unwrap();
    let said = |set: &crate::FittedLaws| {
        let laws: Vec<String> = set.laws.iter().map(law).collect();
        format!("odds {:.1} {laws:?} {:?}", set.log_odds, set.parameters)
    };
    let first = found.sets.first().map_or("none".into(), said);
    let text = format!("{first}; {:?}", found.noise.components());
    let best = found.best();
    let all = |test: &dyn Fn(&Placed) -> bool| best.is_some_and(|set| set.laws.iter().any(test));
    let there =
        |law: &Placed| law.into == PLACES[plant].0 && law.of.as_deref() == Some(PLACES[plant].1);
    let named = all(&|law| there(law) && law.effect.typetag_name().contains("friction"));
    (named, all(&there), best.is_some(), text)
}

fn law(placed: &Placed) -> String {
    let (name, values) = (placed.effect.typetag_name(), placed.effect.card().values());
    format!("{name} into {} of {:?} {values:?}", placed.into, placed.of)
}

#[test]
fn the_place_of_friction_is_found_and_nothing_is_nothing() {
    for plant in 0..3 {
        let (_, place, _, text) = judged(plant, true, 0, 2000, 1);
        assert!(place, "plant {plant}: {text}");
        let (_, _, any, text) = judged(plant, false, 0, 2000, 2);
        assert!(!any, "plant {plant}: {text}");
    }
}

/// The rates of false and of right names over seeds; prints every case.
#[test]
#[ignore = "minutes"]
fn rates_over_seeds() {
    let seeds: u64 = std::env::var("SEEDS").ok().and_then(|s| s.parse().ok()).unwrap_or(5);
    let (mut wrong, mut right, mut placed, mut all) = (0, 0, 0, 0);
    for plant in 0..3 {
        for kind in 0..3 {
            for seed in 0..seeds {
                let begun = std::time::Instant::now();
                let (named, place, _, text) = judged(plant, true, kind, 4000, 10 + seed);
                let seconds = begun.elapsed().as_secs_f64();
                println!(
                    "plant {plant} noise {kind} seed {seed} friction: {named}, place {place} ({seconds:.1} s) {text}"
                );
                let (_, _, any, text) = judged(plant, false, kind, 4000, 50 + seed);
                println!("plant {plant} noise {kind} seed {seed} nothing: {any} {text}");
                wrong += usize::from(any);
                right += usize::from(named);
                placed += usize::from(place);
                all += 1;
            }
        }
    }
    println!("false {wrong}, friction {right}, its place {placed}, of {all}");
    assert!(wrong * 100 <= all && right * 100 >= 95 * all);
}
