//! Every registered effect inside a baseline of S: it simulates as the system does, and slopes
//! along states, inputs, parameters and the effect's own numbers meet differences.

use lacuna::data::{Random, Record};
use lacuna::effect::CandidateEffect;
use lacuna::encoder::{
    Baseline as Known, Encoder, EncoderInitialiser, LinearEncoder, Linearised, Window,
};
use lacuna::lfr::{AugmentedModel, Baseline, Block, Sampled, Scales, Structure};
use lacuna::plugins::systems::Duffing;
use lacuna::system::{Hold, Integrator, Method, Placed, Sampling, System};
use lacuna::train::{Arithmetic, Augmented, MultipleShooting, Shooting};

use super::shelf::{extend, outputs, places, working};

fn duffing(hold: Hold, method: Method) -> System {
    let model = Duffing { mass: 1.0, damping: 2.0, stiffness: 50.0, hardening: 9.0, fixed: vec![] };
    let integrator = Integrator { method, substeps: 2 };
    System::new(model, Sampling { sampling_time: Some(0.05), integrator, hold })
}

/// Rests at 0 first, so that what paths remember is known.
fn record(samples: usize) -> Record {
    let mut random = Random::new(3);
    let mut series = |size: f64| -> Vec<f64> {
        (0..samples).map(|k| if k < 5 { 0.0 } else { size * random.normal() }).collect()
    };
    let (u, y) = (series(1.5), series(0.1));
    Record::new(0.05).input("u", u).unwrap().output("y", y).unwrap()
}

/// All effects at all places of a system.
fn all(system: &System) -> Vec<(&'static str, Placed)> {
    let mut found = vec![];
    for (card, effect) in lacuna::register::effects() {
        let effect: Box<dyn CandidateEffect> = working(effect.as_ref());
        let here = places(system, effect.as_ref()).into_iter();
        found.extend(here.map(|placed| (card.name, placed)));
    }
    assert!(found.len() > 60, "{}", found.len());
    found
}

#[test]
fn a_sampled_system_does_what_the_system_does() {
    for (hold, method) in
        [(Hold::Zero, Method::Rk4), (Hold::First, Method::Rk4), (Hold::Zero, Method::Euler)]
    {
        let system = duffing(hold, method);
        let record = record(120);
        for (name, placed) in all(&system) {
            // a play of time begins to follow at once, and stands at 0 as a state does
            if name == "backlash" && placed.of.as_deref() == Some("time") {
                continue;
            }
            let extended = extend(&system, [placed.clone()]).unwrap();
            let sampled = Sampled::of(&extended, 0.05).unwrap().into_system();
            let (a, b) = (outputs(&extended, &record), outputs(&sampled, &record));
            let size = a[0].iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            for (k, (a, b)) in a[0].iter().zip(&b[0]).enumerate() {
                assert!(
                    (a - b).abs() <= 1e-11 * size,
                    "{name} into {} of {:?}, {hold:?}, {method:?}: sample {k}: {a} but {b}",
                    placed.into,
                    placed.of
                );
            }
        }
    }
}

/// A learned part beside a system with an effect, nothing of it 0, with all numbers free.
fn joined(system: &System, record: &Record) -> Augmented {
    let sampled = Sampled::where_needed(system, 0.05).unwrap();
    let known = Known::new(&sampled, record).unwrap();
    let mut encoder: Box<dyn Encoder> = Box::new(LinearEncoder::new(Window::past(3)));
    known.prepare(encoder.as_mut(), 3).unwrap();
    let count = sampled.signals().parameters.len();
    let free = (0..count).filter(|&i| i == 0 || i > 3).collect();
    let baseline = Baseline { system: sampled, sampling_time: 0.05, free, theta: None };
    let scales = Scales::plain(&baseline);
    let structure = Structure { hidden: vec![3], ..Structure::default() };
    let mut model = structure.build(baseline, &scales, 5).unwrap();
    let mut random = Random::new(17);
    for block in &mut model.blocks {
        if let Block::Network(learned) = block {
            learned.net.weights_mut().iter_mut().for_each(|w| *w += 0.03 * random.normal());
        }
    }
    Augmented::new(model, encoder).unwrap()
}

/// Loss and gradient with one number changed.
struct Bent<'l, 'a> {
    loss: &'l mut MultipleShooting<'a>,
    starts: &'l [usize],
    at: Vec<f64>,
    number: usize,
}

impl Bent<'_, '_> {
    fn value(&mut self, to: f64) -> f64 {
        let kept = std::mem::replace(&mut self.at[self.number], to);
        let value = self.loss.loss(&self.at, self.starts, None).unwrap();
        self.at[self.number] = kept;
        value
    }

    fn slope(&mut self, to: f64) -> f64 {
        let kept = std::mem::replace(&mut self.at[self.number], to);
        let mut slopes = vec![0.0; self.at.len()];
        self.loss.loss(&self.at, self.starts, Some(&mut slopes)).unwrap();
        self.at[self.number] = kept;
        slopes[self.number]
    }

    /// How far differences of fourth order are from the exact slope.
    fn miss(&mut self, here: f64, h: f64, slope: f64) -> f64 {
        let near = 8.0 * (self.value(here + h) - self.value(here - h));
        let far = self.value(here + 2.0 * h) - self.value(here - 2.0 * h);
        ((near - far) / (12.0 * h) - slope).abs()
    }

    /// How far the exact slope is from a straight line within those differences: next to nothing
    /// where there is no kink.
    fn bend(&mut self, here: f64, h: f64, slope: f64) -> f64 {
        (self.slope(here + 2.0 * h) - 2.0 * slope + self.slope(here - 2.0 * h)).abs()
    }
}

#[test]
fn slopes_through_every_effect_meet_differences() {
    let system = duffing(Hold::Zero, Method::Rk4);
    let record = record(60);
    for (name, placed) in all(&system) {
        let place = format!("{name} into {} of {:?}", placed.into, placed.of);
        let model = joined(&extend(&system, [placed]).unwrap(), &record);
        let how = Shooting { length: 8, threads: 1, arithmetic: Arithmetic::Double };
        let mut loss =
            MultipleShooting::new(&model, std::slice::from_ref(&record), how, &[1.0]).unwrap();
        let starts: Vec<usize> = loss.starts().iter().step_by(9).copied().collect();
        let mut slopes = vec![0.0; loss.count()];
        let at = model.parameters();
        loss.loss(&at, &starts, Some(&mut slopes)).unwrap();
        let size = slopes.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
        assert!(size > 0.0 && size.is_finite(), "{place}");
        for number in 0..at.len() {
            let scale = at[number].abs().max(1.0);
            let mut bent = Bent { loss: &mut loss, starts: &starts, at: at.clone(), number };
            // where a curve has a kink within the differences there is no slope for them to meet,
            // and a little aside there is
            let met = [0.0, 1e-3, -1e-3, 2e-3].into_iter().any(|aside| {
                let here = at[number] + aside * scale;
                let slope = if aside == 0.0 { slopes[number] } else { bent.slope(here) };
                // kinks and rounding ask for different steps
                let steps = [2e-5, 4e-6, 1e-6, 1e-4];
                let mut misses = steps.into_iter().map(|h| bent.miss(here, h * scale, slope));
                if misses.any(|miss| miss <= 1e-8 * size) {
                    return true;
                }
                let bend = bent.bend(here, 1e-6 * scale, slope);
                assert!(bend > 1e-9 * size, "{place}, number {number}: {slope} of {size}");
                false
            });
            assert!(met, "{place}, number {number}: a kink everywhere");
        }
    }
}

#[test]
fn encoders_start_from_what_an_extended_model_says() {
    for hold in [Hold::Zero, Hold::First] {
        let system = duffing(hold, Method::Rk4);
        let record = record(600);
        for (name, placed) in all(&system) {
            let place = format!("{name} into {} of {:?}, {hold:?}", placed.into, placed.of);
            let timed = placed.of.as_deref() == Some("time");
            let extended = extend(&system, [placed]).unwrap();
            let sampled = Sampled::where_needed(&extended, 0.05).unwrap();
            let known = Known::new(&sampled, &record).unwrap();
            let mut encoder = LinearEncoder::new(Window::past(8).with_current());
            let started = Linearised::default().initialise(&mut encoder, &known, 1);
            let started = match started {
                Ok(started) => started,
                // nothing rests where a constant drives the states away, and within a play or a dead
                // zone nothing shows
                Err(error) => {
                    let said = error.to_string();
                    assert!(
                        ["no equilibrium", "no finite slope", "cannot be observed", "diverges"]
                            .iter()
                            .any(|reason| said.contains(reason)),
                        "{place}: {said}"
                    );
                    continue;
                }
            };
            let worst = started.states[..2].iter().map(|s| s.nrmse).fold(0.0, f64::max);
            // a linear law is met well; a play or a kink is no line at all
            let line = ["linear", "lag", "delay"].contains(&name) && !timed;
            let limit = if line { 0.1 } else { f64::MAX };
            assert!(worst < limit, "{place}: {worst}\n{started}");
        }
    }
}

#[test]
fn what_was_fitted_beside_an_extended_model_is_a_model_file() {
    for hold in [Hold::Zero, Hold::First] {
        let system = duffing(hold, Method::Rk4);
        let record = record(60);
        for (name, placed) in all(&system).into_iter().step_by(5) {
            let extended = extend(&system, [placed]).unwrap();
            let model = joined(&extended, &record);
            let system = AugmentedModel::new(model.model.clone()).into_system().unwrap();
            let text = lacuna::file::to_json(&system).unwrap();
            let again =
                lacuna::file::parse(&text, "fitted.json", lacuna::file::Format::Json).unwrap();
            assert_eq!(outputs(&system, &record), outputs(&again, &record), "{name}");
        }
    }
}

#[test]
fn a_delay_too_long_to_stand_in_s_is_refused_with_its_length() {
    let mut system = duffing(Hold::Zero, Method::Rk4);
    let delay = lacuna::plugins::effects::delay::Delay { delay: 10.0 };
    system.effects.push(Placed::new(Box::new(delay), "u", Some("u")));
    let error = Sampled::of(&system, 0.05).unwrap_err().to_string();
    assert!(error.contains("400 steps") && error.contains("256"), "{error}");
    let held = lacuna::plugins::effects::delay::Delay { delay: 0.12 };
    system.effects[0].effect = Box::new(held);
    let sampled = Sampled::of(&system, 0.05).unwrap();
    assert_eq!(sampled.held()[0].0, "delay.delay");
}
