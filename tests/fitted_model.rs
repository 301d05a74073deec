//! A fitted model is a model like any other: it saves, loads, simulates the same, can be
//! estimated and extended.

use lacuna::data::{Random, Record};
use lacuna::encoder::{Baseline as Known, Encoder, ResNetEncoder, Spread, Window};
use lacuna::estimate::estimate;
use lacuna::evaluate::{Init, Simulation};
use lacuna::file::{Format, parse, to_json, to_toml};
use lacuna::lfr::{AugmentedModel, Baseline, Block, Form, Scales, Sink, Source, Structure};
use lacuna::plugins::systems::Duffing;
use lacuna::system::{Hold, Integrator, Method, Sampling, System};
use lacuna::train::Augmented;

const T_S: f64 = 0.05;

fn system(hold: Hold) -> System {
    let model = Duffing { mass: 1.0, damping: 2.0, stiffness: 40.0, hardening: 9.0, fixed: vec![] };
    let integrator = Integrator { method: Method::Rk4, substeps: 2 };
    System::new(model, Sampling { sampling_time: Some(T_S), integrator, hold })
}

fn record() -> Record {
    let mut random = Random::new(3);
    let mut noise = |size: f64| (0..600).map(|_| size * random.normal()).collect::<Vec<_>>();
    let (u, y) = (noise(20.0), noise(0.3));
    Record::new(T_S).input("force [N]", u).unwrap().output("position [m]", y).unwrap()
}

/// A model with learned parts that are not 0.
fn augmented(structure: &Structure, record: &Record) -> Augmented {
    let system = system(Hold::Zero);
    let known = Known::new(&system, record).unwrap().augmented(structure.augmented_states);
    let mut encoder: Box<dyn Encoder> = Box::new(ResNetEncoder::new(Window::past(4), &[6]));
    known.prepare(encoder.as_mut(), 1).unwrap();
    let scaling = known.scaling().unwrap();
    let pairs = |s: &[Spread]| s.iter().map(|s| (s.offset, s.scale)).collect::<Vec<_>>();
    let scales = Scales {
        states: pairs(&scaling.states[..2]),
        inputs: pairs(&scaling.inputs),
        outputs: pairs(&scaling.outputs),
    };
    let baseline = Baseline { system, sampling_time: T_S, free: vec![], theta: None };
    let mut model = structure.build(baseline, &scales, 2).unwrap();
    let mut random = Random::new(5);
    for block in &mut model.blocks {
        if let Block::Network(learned) = block {
            learned.net.weights_mut().iter_mut().for_each(|w| *w += 0.03 * random.normal());
        }
    }
    Augmented::new(model, encoder).unwrap()
}

fn forms() -> impl Iterator<Item = Structure> {
    let forms =
        [Form::Parallel, Form::SeriesIn, Form::SeriesOut, Form::InputBlock, Form::OutputBlock];
    forms.into_iter().flat_map(|form| {
        [0, 1].map(|augmented_states| Structure {
            form,
            augmented_states,
            output_equation: augmented_states > 0,
            hidden: vec![5],
            ..Structure::default()
        })
    })
}

#[test]
fn every_structure_simulates_the_same_as_a_model_file() {
    let record = record();
    for structure in forms() {
        let trained = augmented(&structure, &record);
        let run = trained.simulate(&record).unwrap();
        let start = run.starts[0];
        let saved = AugmentedModel::new(trained.model.clone()).into_system().unwrap();
        // what one says is what the other measures: only the start has to be found
        let part = record.slice(start..record.len());
        let measured = Record::new(T_S)
            .input("force [N]", part.inputs[0].values.clone())
            .and_then(|r| r.output("position [m]", &run.outputs[0][start..]))
            .unwrap();
        let simulated = Simulation::of(&saved, &measured, Init::Forgotten).unwrap();
        let metrics = &simulated.metrics[0].1;
        assert!(metrics.nrmse < 1e-4, "{structure:?}: {}", metrics.nrmse);
        // to the last bit through both kinds of file
        for (text, format) in
            [(to_toml(&saved).unwrap(), Format::Toml), (to_json(&saved).unwrap(), Format::Json)]
        {
            let read = parse(&text, "model", format).unwrap_or_else(|e| panic!("{}", e.pretty()));
            let again = Simulation::of(&read, &measured, Init::Samples(0)).unwrap();
            let first = Simulation::of(&saved, &measured, Init::Samples(0)).unwrap();
            assert_eq!(first.outputs, again.outputs);
        }
    }
}

#[test]
fn its_parameters_are_the_baselines_and_can_be_estimated() {
    let record = record();
    let trained = augmented(&Structure { hidden: vec![5], ..Structure::default() }, &record);
    let saved = AugmentedModel::new(trained.model.clone()).into_system().unwrap();
    let y = Simulation::of(&saved, &record, Init::Samples(0)).unwrap().outputs[0].1.clone();
    let measured = Record::new(T_S)
        .input("force [N]", record.inputs[0].values.clone())
        .and_then(|r| r.output("position [m]", y))
        .unwrap();
    // another damping, fitted beside the network, is written into the baseline
    let mut moved = trained.model.clone();
    if let Block::Baseline(baseline) = &mut moved.blocks[0] {
        let mut theta = baseline.theta();
        theta[1] = 2.6;
        baseline.theta = Some(theta);
    }
    let wrong = AugmentedModel::new(moved).into_system().unwrap();
    assert_eq!(wrong.signals().parameters[1].value, 2.6);
    let found = estimate(&wrong, &[measured], 0).unwrap();
    let damping = &found.system.signals().parameters[1];
    assert!((damping.value - 2.0).abs() < 1e-3, "{} = {}", damping.name, damping.value);
}

#[test]
fn what_is_no_model_by_itself_is_refused() {
    let record = record();
    let mut looped =
        augmented(&Structure { hidden: vec![5], ..Structure::default() }, &record).model;
    // the network sees what it gives
    looped.s.scale(Sink::Block(1, 0), Source::Block(1, 0), 0.1);
    let error = AugmentedModel::new(looped).into_system().unwrap_err();
    assert!(error.to_string().contains("loop"), "{error}");
    // a first-order hold is turned into a model of whole samples
    let mut held = augmented(&Structure { hidden: vec![5], ..Structure::default() }, &record).model;
    if let Block::Baseline(baseline) = &mut held.blocks[0] {
        baseline.system = system(Hold::First);
    }
    assert!(AugmentedModel::new(held).into_system().is_ok());
}
