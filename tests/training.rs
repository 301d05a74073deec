//! The training step: its gradient against differences and against an independent
//! reference, every structure, both precisions, any number of threads.

use lacuna::data::{Random, Record};
use lacuna::encoder::{Baseline as Known, Encoder, LinearEncoder, ResNetEncoder, Window};
use lacuna::lfr::{Baseline, Block, Form, Scales, Sink, Source, Structure};
use lacuna::model::StateSpaceModel;
use lacuna::plugins::systems::{Duffing, MassSpringDamper};
use lacuna::system::{Hold, Integrator, Method, Sampling, System};
use lacuna::train::{Arithmetic, Augmented, MultipleShooting, Shooting};

#[path = "bench/training/oracle.rs"]
mod oracle;

use crate::without_adjoint::WithoutAdjoint;

fn masses() -> MassSpringDamper {
    MassSpringDamper {
        masses: vec![0.5, 0.4],
        stiffness: vec![100.0, 100.0],
        damping: vec![0.5, 0.5],
        hardening: vec![0.0, 1000.0],
        cubic_damping: vec![0.05, 0.0],
        driven: vec![1],
        measured: vec![],
        fixed: vec![],
    }
}

fn sampling(method: Method, substeps: usize, hold: Hold) -> Sampling {
    Sampling { sampling_time: Some(0.1), integrator: Integrator { method, substeps }, hold }
}

/// Any signals will do for a gradient.
fn record(samples: usize, input: f64, output: f64) -> Record {
    let mut random = Random::new(11);
    let mut noise = |size: f64| (0..samples).map(|_| size * random.normal()).collect::<Vec<_>>();
    let (u, y) = (noise(input), noise(output));
    Record::new(0.1).input("u [N]", u).unwrap().output("y [m]", y).unwrap()
}

/// A model whose learned parts are no longer 0, with an encoder.
fn augmented(
    model: impl StateSpaceModel + Clone + 'static,
    sampling: Sampling,
    structure: &Structure,
    record: &Record,
    mut encoder: Box<dyn Encoder>,
    prepare: impl Fn(&mut Baseline),
) -> Augmented {
    let system = System::new(model.clone(), sampling);
    let known = Known::new(&system, record).unwrap().augmented(structure.augmented_states);
    known.prepare(encoder.as_mut(), 3).unwrap();
    let scaling = known.scaling().unwrap();
    let states = system.signals().states.len();
    let pairs = |spreads: &[lacuna::encoder::Spread]| {
        spreads.iter().map(|s| (s.offset, s.scale)).collect::<Vec<_>>()
    };
    let scales = Scales {
        states: pairs(&scaling.states[..states]),
        inputs: pairs(&scaling.inputs),
        outputs: pairs(&scaling.outputs),
    };
    let mut baseline = Baseline::new(model, sampling, 0.1);
    prepare(&mut baseline);
    let mut model = structure.build(baseline, &scales, 5).unwrap();
    let mut random = Random::new(17);
    for block in &mut model.blocks {
        if let Block::Network(learned) = block {
            learned.net.weights_mut().iter_mut().for_each(|w| *w += 0.05 * random.normal());
        }
    }
    Augmented::new(model, encoder).unwrap()
}

fn resnet(n: usize, hidden: &[usize]) -> Box<dyn Encoder> {
    Box::new(ResNetEncoder::new(Window::past(n), hidden))
}

fn shooting(length: usize, threads: usize, arithmetic: Arithmetic) -> Shooting {
    Shooting { length, threads, arithmetic }
}

/// Loss and gradient at the model's parameters.
fn gradient(
    model: &Augmented,
    record: &Record,
    how: Shooting,
    starts: impl Fn(&[usize]) -> Vec<usize>,
) -> (f64, Vec<f64>) {
    let ones = vec![1.0; model.model.outputs];
    let mut loss = MultipleShooting::new(model, std::slice::from_ref(record), how, &ones).unwrap();
    let (parameters, starts) = (model.parameters(), starts(loss.starts()));
    let mut gradient = vec![0.0; loss.count()];
    let value = loss.loss(&parameters, &starts, Some(&mut gradient)).unwrap();
    (value, gradient)
}

/// Every `step`-th start.
fn every(step: usize) -> impl Fn(&[usize]) -> Vec<usize> {
    move |all| all.iter().step_by(step).copied().collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |a, b| a.max(b.abs()))
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / largest(a)
}

/// The gradient of every parameter against fourth-order central differences.
fn meets_differences(model: &Augmented, record: &Record, length: usize, limit: f64) {
    let how = shooting(length, 1, Arithmetic::Double);
    let (_, slopes) = gradient(model, record, how, every(7));
    let ones = vec![1.0; model.model.outputs];
    let mut loss = MultipleShooting::new(model, std::slice::from_ref(record), how, &ones).unwrap();
    let starts = every(7)(loss.starts());
    let mut parameters = model.parameters();
    let size = largest(&slopes);
    assert!(size > 0.0 && size.is_finite(), "{size} {:?}", model.model.s);
    for i in 0..parameters.len() {
        let here = parameters[i];
        let mut at = |by: f64| {
            parameters[i] = here + by;
            let value = loss.loss(&parameters, &starts, None).unwrap();
            parameters[i] = here;
            value
        };
        // the better of two step sizes: one errs by its length, the other by rounding
        let mut miss = |h: f64| {
            let slope = (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
            (slope - slopes[i]).abs()
        };
        let scale = here.abs().max(1.0);
        let least = miss(1e-4 * scale).min(miss(2e-5 * scale));
        assert!(least < limit * size, "parameter {i}: {} is off by {least}, of {size}", slopes[i]);
    }
}

#[test]
fn all_weights_meet_differences() {
    let record = record(300, 10.0, 0.2);
    let rk4 = sampling(Method::Rk4, 10, Hold::Zero);
    let structure = Structure::default();
    let model = augmented(masses(), rk4, &structure, &record, resnet(9, &[16, 16]), |_| {});
    assert_eq!(model.parameters().len(), 460 + 712);
    meets_differences(&model, &record, 40, 1e-8);
}

#[test]
fn every_structure_meets_differences() {
    let record = record(200, 2.0, 0.2);
    let rk4 = sampling(Method::Rk4, 10, Hold::Zero);
    for form in
        [Form::Parallel, Form::SeriesIn, Form::SeriesOut, Form::InputBlock, Form::OutputBlock]
    {
        for augmented_states in [0, 2] {
            let structure = Structure {
                form,
                augmented_states,
                output_equation: true,
                hidden: vec![5, 3],
                ..Structure::default()
            };
            let model = augmented(masses(), rk4, &structure, &record, resnet(4, &[5]), |_| {});
            meets_differences(&model, &record, 12, 1e-8);
        }
    }
}

#[test]
fn integrators_and_holds_meet_differences() {
    let record = record(200, 3.0, 0.2);
    let structure = Structure { hidden: vec![4], ..Structure::default() };
    let linear = || -> Box<dyn Encoder> { Box::new(LinearEncoder::new(Window::past(3))) };
    let duffing =
        Duffing { mass: 1.0, damping: 2.0, stiffness: 50.0, hardening: 9.0, fixed: vec![] };
    for (method, hold) in
        [(Method::Euler, Hold::Zero), (Method::Euler, Hold::First), (Method::Rk4, Hold::First)]
    {
        let how = sampling(method, 4, hold);
        let model = augmented(duffing.clone(), how, &structure, &record, linear(), |_| {});
        meets_differences(&model, &record, 10, 1e-8);
    }
}

#[test]
fn free_parameters_of_the_baseline_meet_differences() {
    let record = record(200, 10.0, 0.2);
    let structure = Structure { hidden: vec![4], ..Structure::default() };
    let rk4 = sampling(Method::Rk4, 3, Hold::Zero);
    let free = |baseline: &mut Baseline| baseline.free = vec![0, 1, 3, 4, 5, 7, 8];
    let model = augmented(masses(), rk4, &structure, &record, resnet(4, &[4]), free);
    meets_differences(&model, &record, 12, 1e-7);
}

#[test]
fn the_error_column_and_learned_entries_meet_differences() {
    let record = record(200, 10.0, 0.2);
    let rk4 = sampling(Method::Rk4, 3, Hold::Zero);
    let structure = Structure { hidden: vec![4], ..Structure::default() };
    let mut model = augmented(masses(), rk4, &structure, &record, resnet(4, &[4]), |_| {});
    let s = &mut model.model.s;
    s.learn(Sink::State(1), Source::Error(0), 0.3);
    s.scale(Sink::State(3), Source::Error(0), -0.2);
    s.learn(Sink::State(2), Source::Block(1, 2), 0.9);
    s.learn(Sink::State(0), Source::State(1), 0.01);
    s.learn(Sink::Output(0), Source::Input(0), 1e-3);
    model.model.check().unwrap();
    meets_differences(&model, &record, 12, 1e-8);
}

#[test]
fn algebraic_loops_are_solved_and_differentiated() {
    let record = record(200, 10.0, 0.2);
    let rk4 = sampling(Method::Rk4, 3, Hold::Zero);
    let structure = Structure {
        form: Form::SeriesOut,
        output_equation: true,
        hidden: vec![4],
        ..Structure::default()
    };
    let mut model = augmented(masses(), rk4, &structure, &record, resnet(4, &[4]), |_| {});
    // the two networks see each other's results in the same sample
    let s = &mut model.model.s;
    assert!(model.model.blocks.len() == 3);
    s.scale(Sink::Block(1, 1), Source::Block(2, 0), 0.5);
    s.learn(Sink::Block(2, 2), Source::Block(1, 1), 0.3);
    s.scale(Sink::Block(2, 3), Source::Block(1, 0), -0.2);
    assert_eq!(model.model.algebraic_loops().len(), 1);
    meets_differences(&model, &record, 8, 1e-8);
}

#[test]
fn agrees_with_plain_nalgebra_one_section_at_a_time() {
    let record = record(2000, 10.0, 0.2);
    let rk4 = sampling(Method::Rk4, 10, Hold::Zero);
    let structure = Structure::default();
    let model = augmented(masses(), rk4, &structure, &record, resnet(9, &[16, 16]), |_| {});
    let (loss, slopes) = gradient(&model, &record, shooting(60, 1, Arithmetic::Double), every(27));
    let reference = common::oracle(&model, &record, 60);
    let ones = [1.0];
    let how = shooting(60, 1, Arithmetic::Double);
    let starts = every(27)(
        MultipleShooting::new(&model, std::slice::from_ref(&record), how, &ones).unwrap().starts(),
    );
    let (expected, expected_slopes) = reference.run(&starts);
    assert!((loss - expected).abs() < 1e-12 * expected);
    assert!(apart(&expected_slopes, &slopes) < 1e-12, "{}", apart(&expected_slopes, &slopes));
}

#[test]
fn dual_numbers_and_the_own_adjoint_agree_and_so_do_the_precisions() {
    let record = record(2000, 10.0, 0.2);
    let rk4 = sampling(Method::Rk4, 10, Hold::Zero);
    let structure = Structure::default();
    let own = augmented(masses(), rk4, &structure, &record, resnet(9, &[16, 16]), |_| {});
    let dual =
        augmented(WithoutAdjoint(masses()), rk4, &structure, &record, resnet(9, &[16, 16]), |_| {});
    let double = shooting(50, 1, Arithmetic::Double);
    let (loss, slopes) = gradient(&own, &record, double, every(27));
    let (same, by_duals) = gradient(&dual, &record, double, every(27));
    assert!((loss - same).abs() < 1e-12 * loss);
    assert!(apart(&slopes, &by_duals) < 1e-12, "{}", apart(&slopes, &by_duals));
    for model in [&own, &dual] {
        let single = shooting(50, 1, Arithmetic::Single);
        let (rough, rough_slopes) = gradient(model, &record, single, every(27));
        assert!((loss - rough).abs() < 1e-5 * loss);
        assert!(apart(&slopes, &rough_slopes) < 1e-4, "{}", apart(&slopes, &rough_slopes));
        assert_ne!(loss, rough);
    }
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let record = record(2500, 10.0, 0.2);
    let rk4 = sampling(Method::Rk4, 2, Hold::Zero);
    let structure = Structure { hidden: vec![6], ..Structure::default() };
    let model = augmented(masses(), rk4, &structure, &record, resnet(5, &[6]), |_| {});
    for arithmetic in [Arithmetic::Double, Arithmetic::Single] {
        let one = gradient(&model, &record, shooting(20, 1, arithmetic), every(1));
        for threads in [2, 3, 5] {
            let more = gradient(&model, &record, shooting(20, threads, arithmetic), every(1));
            assert_eq!(one.0.to_bits(), more.0.to_bits());
            let bits = |g: &[f64]| g.iter().map(|g| g.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&one.1), bits(&more.1));
        }
    }
}

#[test]
fn what_was_not_measured_does_not_count() {
    let whole = record(300, 10.0, 0.2);
    let rk4 = sampling(Method::Rk4, 2, Hold::Zero);
    let structure = Structure { hidden: vec![4], ..Structure::default() };
    let model = augmented(masses(), rk4, &structure, &whole, resnet(4, &[4]), |_| {});
    let mut gappy = whole.clone();
    gappy.outputs[0].values[30] = f64::NAN;
    // one section of ten samples: leaving out its last sample shortens it to nine
    let first = |all: &[usize]| vec![*all.iter().find(|&&k| k == 21).unwrap()];
    let how = |length| shooting(length, 1, Arithmetic::Double);
    let (missing, slopes) = gradient(&model, &gappy, how(10), first);
    let (shorter, expected) = gradient(&model, &whole, how(9), first);
    assert!((missing - shorter).abs() < 1e-15);
    assert!(apart(&expected, &slopes) < 1e-12);
    meets_differences(&model, &gappy, 10, 1e-8);
}

#[test]
fn a_simulation_is_a_long_section() {
    let record = record(300, 10.0, 0.2);
    let rk4 = sampling(Method::Rk4, 2, Hold::Zero);
    let structure = Structure { hidden: vec![4], augmented_states: 1, ..Structure::default() };
    let model = augmented(masses(), rk4, &structure, &record, resnet(4, &[4]), |_| {});
    let run = model.simulate(&record).unwrap();
    assert_eq!(run.starts, [4]);
    assert!(run.outputs[0][..4].iter().all(|y| y.is_nan()));
    let length = 296;
    let (loss, _) =
        gradient(&model, &record, shooting(length, 1, Arithmetic::Double), |all| all[..1].to_vec());
    assert!((run.rmse[0] - (2.0 * loss).sqrt()).abs() < 1e-12);
    // saved and loaded it gives the same bits
    let text = serde_json::to_string(&model).unwrap();
    let loaded: Augmented = serde_json::from_str(&text).unwrap();
    let again = loaded.simulate(&record).unwrap();
    assert_eq!(run.outputs[0][4..], again.outputs[0][4..]);
}

mod common {
    use super::oracle::{Net, Oracle, TwoMasses};
    use lacuna::data::Record;
    use lacuna::lfr::Block;
    use lacuna::train::Augmented;

    /// The reference for the two masses with networks of two layers of 16.
    pub fn oracle<'a>(model: &Augmented, record: &'a Record, length: usize) -> Oracle<'a> {
        let Block::Network(learned) = &model.model.blocks[1] else { panic!("a network") };
        let (encoder, scaling) =
            (model.encoder.network().unwrap(), model.encoder.scaling().unwrap());
        let pair = |s: &lacuna::encoder::Spread| (s.offset, s.scale);
        let lags = model.encoder.window().n_a;
        let past = [vec![pair(&scaling.outputs[0]); lags], vec![pair(&scaling.inputs[0]); lags]];
        Oracle {
            physics: TwoMasses {
                m: [0.5, 0.4],
                k: [100.0, 100.0],
                c: [0.5, 0.5],
                a: [0.0, 1000.0],
                d: [0.05, 0.0],
            },
            substeps: 10,
            step: 0.01,
            augmentation: Net::new(
                learned.net.weights(),
                [5, 16, 16, 4],
                learned.input_scales.clone(),
                learned.output_scales.clone(),
            ),
            encoder: Net::new(
                encoder.weights(),
                [2 * lags, 16, 16, 4],
                past.concat(),
                scaling.states.iter().map(pair).collect(),
            ),
            lags,
            length,
            u: &record.inputs[0].values,
            y: &record.outputs[0].values,
        }
    }
}
