//! Places that are simulated of a wide machine.

use std::sync::atomic::{AtomicUsize, Ordering};

use lacuna_core::file::{Format, parse};

use super::*;
use crate::candidates::free_curve::{Drawing, Sketch};
use crate::data::{Random, Record};
use crate::evaluate::{Init, Simulation};
use crate::fit::affordable::each;
use crate::fit::nuisance::Nuisance;
use crate::fit::problem::Grain;
use crate::fit::work::Work;
use crate::prepare::prepared::Prepared;
use crate::system::System;

/// Masses in a row, each driven and measured: twice as many states as inputs and outputs.
const MASSES: usize = 6;

/// A row of masses, with what is hidden in it.
fn row(hidden: &str) -> System {
    let mut text = String::from("sampling_time = 0.05\n[model.equations]\n");
    let list = |of: &dyn Fn(usize) -> String| (0..MASSES).map(of).collect::<Vec<_>>().join(", ");
    text += &format!("inputs = [{}]\n", list(&|i| format!("{{ name = \"u{i}\" }}")));
    let state = |i: usize| {
        let pulled = if i == 0 { String::new() } else { format!(" + 0.5*x{}", i - 1) };
        format!(
            "{{ name = \"x{i}\", derivative = \"v{i}\" }}, \
             {{ name = \"v{i}\", derivative = \"u{i} - 5.0*x{i} - 0.7*v{i}{pulled}\" }}"
        )
    };
    text += &format!("states = [{}]\n", list(&state));
    let output = |i: usize| format!("{{ name = \"y{i}\", value = \"x{i}\" }}");
    text += &format!("outputs = [{}]\n", list(&output));
    let channel =
        |i: usize| format!("{{ name = \"f{i}\", into = [{{ state = \"v{i}\", gain = \"1\" }}] }}");
    text += &format!("channels = [{}]\n{hidden}", list(&channel));
    parse(&text, "row.toml", Format::Toml).unwrap_or_else(|e| panic!("{}", e.pretty()))
}

/// A record of the row with a hard spring at one mass.
fn record() -> Record {
    let machine =
        row("[[effects]]\ninto = \"f3\"\nof = \"x3\"\neffect.cubic = { coefficient = -0.3 }\n");
    let mut random = Random::new(5);
    let mut driven = Record::new(0.05);
    for i in 0..MASSES {
        let mut u = vec![0.0; 700];
        for k in 1..u.len() {
            u[k] = 0.9 * u[k - 1] + random.normal();
        }
        driven = driven.input(&format!("u{i}"), u).unwrap();
    }
    let run = Simulation::of(&machine, &driven, Init::Samples(0)).unwrap();
    for (name, y) in run.outputs {
        let y: Vec<f64> = y.into_iter().map(|y| y + 0.02 * random.normal()).collect();
        driven = driven.output(&name, y).unwrap();
    }
    driven
}

/// The curves of a prepared search, and the simulations that were made for them.
fn sketched(prepared: &Prepared<'_>, watch: &dyn Watch) -> (Vec<Sketch>, usize) {
    let Prepared { problem, nominal, start, .. } = prepared;
    let nuisance = &Nuisance::new(problem, nominal);
    let y = problem.simulate(start, Grain::Coarse).unwrap();
    let before = problem.simulations.load(Ordering::Relaxed);
    let sketches = Drawing { problem, nominal, nuisance, watch }.sketches(start, &y);
    (sketches, problem.simulations.load(Ordering::Relaxed) - before)
}

#[test]
fn of_too_many_places_the_leading_ones_are_drawn_and_the_best_is_the_same() {
    let (system, record) = (row(""), record());
    let mut prepared = Prepared::new(&system, &[record], 0.7).unwrap();
    let (all, many) = sketched(&prepared, &());
    // work for 90 simulations, ten places of nine knots
    prepared.problem.work = Work { most: 0.0, taken: 90.5 * each(&prepared.problem) };
    let (some, few) = sketched(&prepared, &());
    assert!(all.len() <= 8 && some.len() <= 8);
    for sketches in [&all, &some] {
        let best = &sketches[0];
        assert_eq!((&best.cause.into[..], best.cause.of.as_deref()), ("f3", Some("x3")));
    }
    assert_eq!(all[0].values, some[0].values);
    // beside nine knots of every place: the states' tangents, and finer knots of the best eight
    let others = 2 * MASSES + 8 * (13 + 19);
    assert!(few <= 90 + others, "{few}");
    assert!(many > few + 9 * 2 * MASSES, "{many} and {few}");
}

/// Asks to stop once it has been asked so often.
struct After(AtomicUsize);

impl Watch for After {
    fn report(&self, _: f64, _: &str) {}

    fn stopped(&self) -> bool {
        self.0
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| left.checked_sub(1))
            .is_err()
    }
}

#[test]
fn who_asks_to_stop_gets_what_was_drawn() {
    let (system, record) = (row(""), record());
    let prepared = Prepared::new(&system, &[record], 0.7).unwrap();
    let (sketches, simulations) = sketched(&prepared, &After(AtomicUsize::new(3)));
    assert!(sketches.len() <= 3);
    assert!(simulations <= 2 * MASSES + 3 * (9 + 13 + 19), "{simulations}");
    let (sketches, simulations) = sketched(&prepared, &After(AtomicUsize::new(0)));
    assert!(sketches.is_empty() && simulations <= 2 * MASSES, "{simulations}");
}

#[test]
fn learned_laws_of_the_leading_places_are_tried() {
    let (system, record) = (row(""), record());
    let mut prepared = Prepared::new(&system, &[record], 0.7).unwrap();
    prepared.problem.work = Work { most: 0.0, taken: 100.5 * each(&prepared.problem) };
    let Prepared { problem, nominal, start, .. } = &prepared;
    let nuisance = &Nuisance::new(problem, nominal);
    let y = problem.simulate(start, Grain::Coarse).unwrap();
    let before = problem.simulations.load(Ordering::Relaxed);
    let (surfaces, tried) = Drawing { problem, nominal, nuisance, watch: &() }.surfaces(start, &y);
    let made = problem.simulations.load(Ordering::Relaxed) - before;
    assert!(tried <= 20 && made <= 100 + 2 * MASSES, "{tried} laws by {made} simulations");
    assert_eq!(surfaces[0].cause.into, "f3");
    assert!(surfaces[0].cause.coordinates().contains(&"x3"), "{:?}", surfaces[0].cause.of);
}
