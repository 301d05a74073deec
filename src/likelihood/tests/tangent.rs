//! Tangents of the innovations against differences of the filter itself.

use super::plants::{GANTRY, OSCILLATOR, Sizes, excitation, simulate, system, with};
use crate::follow::Wanted;
use crate::given::Given;
use crate::hypothesis::Hypothesis;
use crate::noise::Slow;
use crate::predictor::{Predictor, column};
use crate::replay::Pass;
use crate::tangent::{Site, gram};
use lacuna_core::file::{Format, parse};
// registers closed loops
use lacuna_learn as _;

#[test]
fn scores_are_slopes_of_the_likelihood() {
    let plant = system(GANTRY);
    let sizes = Sizes { white: vec![2.0], measurement: vec![0.002, 0.004], ..Sizes::default() };
    let record = simulate(&plant, &excitation(400, 0.02, 20.0, 2), &sizes, 3);
    let predictor = Predictor::new(&plant, std::slice::from_ref(&record)).unwrap();
    let mut noise = predictor.white(vec![4e-6, 1.6e-5]);
    noise.white[0] = 4.0;
    noise.slow[1] = Slow::walk(1e-4);
    let wanted = Wanted { theta: true, seen: true, gate: None };
    let run = predictor.run(&predictor.model, &noise, wanted).unwrap();
    let path = &run.path;
    let entries = predictor.model.plan.sources.entries.len();
    let speed = column(&path.seen, entries, 0);
    let columns = vec![
        (Site::Force(0), speed).into(),
        (Site::Output(1), vec![1.0; path.len]).into(),
        (Site::Parameter(1), vec![1.0; path.len]).into(),
    ];
    let pass = Pass::of(path, &noise, false);
    let sums = gram(path, &pass, &noise, &columns);
    let exact = |sign: f64, which: usize, size: f64| {
        let effect = match which {
            0 => format!(
                "into = \"on_trolley\"\nof = \"trolley_speed\"\neffect.linear = {{ coefficient = {:?} }}",
                sign * size
            ),
            _ => format!("into = \"angle\"\neffect.bias = {{ value = {:?} }}", sign * size),
        };
        let mut moved = match which {
            2 => Predictor::new(&plant, std::slice::from_ref(&record)).unwrap(),
            _ => Predictor::new(&with(GANTRY, &effect), std::slice::from_ref(&record)).unwrap(),
        };
        moved.start = predictor.start.clone();
        if which == 2 {
            moved.model.theta[1] += sign * size;
        }
        moved.run(&moved.model, &noise, Wanted::default()).unwrap().log_likelihood
    };
    for (which, size) in [(0, 1e-3), (1, 1e-6), (2, 1e-4)] {
        let difference = (exact(1.0, which, size) - exact(-1.0, which, size)) / (2.0 * size);
        // d log L / d theta = -T'z; gains are held in it
        let off = (-sums.slope[which] - difference).abs();
        let size = sums.square[(which, which)].sqrt();
        assert!(off < 0.05 * size, "{which}: {} {difference} {size}", -sums.slope[which]);
    }
}

/// An offset of a sensor that a known controller reads moves what is predicted, and the plant too.
#[test]
fn scores_of_a_sensor_in_a_loop_are_slopes_of_the_likelihood() {
    let controller = "[controller]\nreferences = [\"r\"]\nmeasured = [\"position\"]\ndrives = [\"force\"]\n\
        [controller.law.lti]\nA = [[0.7]]\nB = [[0.3, -0.3]]\nC = [[-8.0]]\nD = [[11.0, -11.0]]\n";
    let looped = format!("{OSCILLATOR}{controller}");
    let plant = system(&looped);
    let sizes = Sizes { measurement: vec![0.01], ..Sizes::default() };
    let record = simulate(&plant, &excitation(400, 0.05, 1.0, 2), &sizes, 3);
    let predictor = Predictor::new(&plant, std::slice::from_ref(&record)).unwrap();
    let mut noise = predictor.white(vec![1e-4]);
    noise.white[1] = 0.01;
    let wanted = Wanted { theta: false, seen: true, gate: None };
    let run = predictor.run(&predictor.model, &noise, wanted).unwrap();
    let pass = Pass::of(&run.path, &noise, false);
    let sums = gram(&run.path, &pass, &noise, &[(Site::Output(0), vec![1.0; run.path.len]).into()]);
    let exact = |value: f64| {
        let bias = parse(&with_bias(value), "bias.toml", Format::Toml).unwrap();
        let mut moved = system(&looped);
        moved.effects = bias.effects;
        let mut moved = Predictor::new(&moved, std::slice::from_ref(&record)).unwrap();
        moved.start = predictor.start.clone();
        moved.run(&moved.model, &noise, Wanted::default()).unwrap().log_likelihood
    };
    let difference = (exact(1e-5) - exact(-1e-5)) / 2e-5;
    let size = sums.square[(0, 0)].sqrt();
    assert!((-sums.slope[0] - difference).abs() < 1e-3 * size, "{} {difference}", -sums.slope[0]);
    assert!(run.path.read(5, 1, 0).abs() > 0.1);
}

fn with_bias(value: f64) -> String {
    format!("{OSCILLATOR}[[effects]]\ninto = \"position\"\neffect.bias = {{ value = {value:?} }}\n")
}

/// A lag on the path of an input has no column of its own; its slope is a difference of the filter.
#[test]
fn scores_of_a_law_that_remembers_are_slopes_of_the_likelihood() {
    let lag = |time_constant: f64| {
        let law = format!(
            "into = \"force\"\nof = \"force\"\neffect.lag = {{ time_constant = {time_constant:?} }}"
        );
        with(OSCILLATOR, &law)
    };
    let sizes = Sizes { white: vec![0.05], measurement: vec![0.02], ..Sizes::default() };
    // the simulator remembers states alone
    let slow = OSCILLATOR.replace("(force -", "(acts -").replace(
        "states = [",
        "states = [{ name = \"acts\", derivative = \"(force - acts)/0.15\" },",
    );
    let record = simulate(&system(&slow), &excitation(600, 0.05, 1.0, 2), &sizes, 3);
    let plant = system(OSCILLATOR);
    let predictor = Predictor::new(&plant, std::slice::from_ref(&record)).unwrap();
    let mut noise = predictor.white(vec![4e-4]);
    noise.white[0] = 0.0025;
    let at = |time_constant: f64| {
        let given = Given::new(lag(time_constant).effects, &[], &[]);
        let mut asked = predictor.clone();
        let begun = asked.first_hypothesis(&given, Some(&noise)).unwrap();
        let of = Hypothesis { noise: noise.clone(), ..begun.now };
        predictor.evaluated(of).unwrap()
    };
    let (of, run) = at(0.12);
    let columns = predictor.slopes(&of, &run);
    let pass = Pass::of(&run.path, &noise, false);
    let sums = gram(&run.path, &pass, &noise, &columns);
    let likely = |time_constant: f64| at(time_constant).0.log_likelihood;
    let difference = (likely(0.1201) - likely(0.1199)) / 2e-4;
    let size = sums.square[(0, 0)].sqrt();
    assert!((-sums.slope[0] - difference).abs() < 0.02 * size, "{} {difference}", -sums.slope[0]);
    assert!(size > 10.0);
    // and the fit that goes by them ends at the lag
    let fitted = predictor.refit(predictor.fit(of.parts, &of.theta, &noise).unwrap()).unwrap();
    let found = predictor.placed(&fitted.parts)[0].effect.card().values()[0];
    assert!((found - 0.15).abs() < 0.02, "{found}");
}
