//! Training: it learns, it goes on where it was broken off, it turns back from infinity.

use std::ops::ControlFlow;
use std::path::PathBuf;

use lacuna::data::{Random, Record};
use lacuna::encoder::{Baseline as Known, Encoder, LinearEncoder, Spread, Window};
use lacuna::fault::Explain;
use lacuna::lfr::{Baseline, Form, Scales, Structure};
use lacuna::optimise::Adam;
use lacuna::plugins::systems::Duffing;
use lacuna::system::{Integrator, Method, Sampling, System};
use lacuna::train::{
    Arithmetic, Augmented, Checkpoint, Ended, Epoch, Follow, TrainError, Trainer, Validation,
};

const T_S: f64 = 0.05;

fn duffing(damping: f64, hardening: f64) -> Duffing {
    Duffing { mass: 1.0, damping, stiffness: 40.0, hardening, fixed: vec![] }
}

fn sampling() -> Sampling {
    let integrator = Integrator { method: Method::Rk4, substeps: 1 };
    Sampling { sampling_time: Some(T_S), integrator, ..Sampling::default() }
}

/// What the true machine does: Runge-Kutta by hand, a little noise.
fn measured(truth: &Duffing, samples: usize, seed: u64, noise: f64) -> Record {
    let mut random = Random::new(seed);
    let (mut p, mut v, mut u) = (0.0, 0.0, 0.0);
    let (mut us, mut ys) = (vec![], vec![]);
    for k in 0..samples {
        if k % 5 == 0 {
            u = 20.0 * random.normal();
        }
        us.push(u);
        ys.push(p + noise * random.normal());
        let f = |p: f64, v: f64| {
            let force = u - truth.damping * v - (truth.stiffness + truth.hardening * p * p) * p;
            (v, force / truth.mass)
        };
        let (a, b, h) = (p, v, T_S);
        let k1 = f(a, b);
        let k2 = f(a + 0.5 * h * k1.0, b + 0.5 * h * k1.1);
        let k3 = f(a + 0.5 * h * k2.0, b + 0.5 * h * k2.1);
        let k4 = f(a + h * k3.0, b + h * k3.1);
        p += h / 6.0 * (k1.0 + 2.0 * k2.0 + 2.0 * k3.0 + k4.0);
        v += h / 6.0 * (k1.1 + 2.0 * k2.1 + 2.0 * k3.1 + k4.1);
    }
    Record::new(T_S).input("force [N]", us).unwrap().output("position [m]", ys).unwrap()
}

fn start(model: &Duffing, record: &Record, free: &[usize]) -> Augmented {
    with_structure(model, record, free, Structure::default())
}

fn with_structure(
    model: &Duffing,
    record: &Record,
    free: &[usize],
    structure: Structure,
) -> Augmented {
    let system = System::new(model.clone(), sampling());
    let known = Known::new(&system, record).unwrap();
    let mut encoder: Box<dyn Encoder> = Box::new(LinearEncoder::new(Window::past(5)));
    known.prepare(encoder.as_mut(), 1).unwrap();
    let scaling = known.scaling().unwrap();
    let pairs = |s: &[Spread]| s.iter().map(|s| (s.offset, s.scale)).collect::<Vec<_>>();
    let scales = Scales {
        states: pairs(&scaling.states),
        inputs: pairs(&scaling.inputs),
        outputs: pairs(&scaling.outputs),
    };
    let mut baseline = Baseline::new(model.clone(), sampling(), T_S);
    baseline.free = free.to_vec();
    let structure = Structure { hidden: vec![8], ..structure };
    Augmented::new(structure.build(baseline, &scales, 2).unwrap(), encoder).unwrap()
}

fn trainer(epochs: usize) -> Trainer {
    Trainer {
        length: 20,
        batch: 100,
        epochs,
        seed: 4,
        optimiser: Adam { rate: 5e-3, ..Adam::default() }.into(),
        validation: Validation { lengths: vec![5, 20], sections: 200, ..Validation::default() },
        ..Trainer::default()
    }
}

struct Task {
    model: Augmented,
    training: Vec<Record>,
    validation: Vec<Record>,
}

fn task() -> Task {
    let truth = duffing(2.0, 30.0);
    let training = vec![measured(&truth, 500, 1, 1e-3), measured(&truth, 400, 2, 1e-3)];
    let validation = vec![measured(&truth, 500, 3, 1e-3)];
    let model = start(&duffing(2.0, 0.0), &training[0], &[]);
    Task { model, training, validation }
}

fn bits(model: &Augmented) -> Vec<u64> {
    model.parameters().iter().map(|p| p.to_bits()).collect()
}

fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("lacuna_trainer_{name}_{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    folder
}

#[test]
fn learns_what_the_baseline_lacks_and_keeps_the_best_model() {
    let Task { model, training, validation } = task();
    let fit = trainer(60).fit(&model, &training, &validation, &mut ()).unwrap();
    let (first, last) = (&fit.history[0], &fit.history[fit.epoch]);
    let of = |epoch: &Epoch| epoch.score.as_ref().unwrap().simulation[0];
    assert!(of(last) < 0.3 * of(first), "{} -> {}", of(first), of(last));
    assert!(
        last.best
            && fit
                .history
                .iter()
                .all(|e| e.score.as_ref().is_none_or(|s| s.simulation[0] >= of(last)))
    );
    // the model handed back is the one that was scored
    let run = fit.model.simulate(&validation[0]).unwrap();
    assert!((run.rmse[0] - of(last)).abs() < 1e-15);
    assert_eq!((fit.ended, fit.rollbacks, fit.history.len()), (Ended::Budget, 0, 61));
    let ahead = |epoch: &Epoch, i: usize| epoch.score.as_ref().unwrap().ahead[i][0];
    assert!((0..2).all(|i| ahead(last, i) < 0.3 * ahead(first, i)));
}

#[test]
fn threads_change_no_bit_and_single_precision_learns_too() {
    let Task { model, training, validation } = task();
    let one = trainer(3).fit(&model, &training, &validation, &mut ()).unwrap();
    let two = Trainer { threads: 2, ..trainer(3) };
    let two = two.fit(&model, &training, &validation, &mut ()).unwrap();
    assert_eq!(bits(&one.model), bits(&two.model));
    assert_eq!(one.history, two.history);
    let single = Trainer { arithmetic: Arithmetic::Single, ..trainer(3) };
    let single = single.fit(&model, &training, &validation, &mut ()).unwrap();
    let loss = |fit: &lacuna::train::Fit| fit.history[3].loss.unwrap();
    assert_ne!(loss(&one), loss(&single));
    assert!((loss(&one) / loss(&single) - 1.0).abs() < 1e-2);
}

/// Stops after so many steps, as if the program had been killed.
struct After(usize);

impl Follow for After {
    fn on_epoch(&mut self, _: &Epoch) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
    fn on_step(&mut self, _: usize, _: usize) -> ControlFlow<()> {
        self.0 -= 1;
        if self.0 == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

#[test]
fn a_resumed_run_ends_with_the_same_bits() {
    let Task { model, training, validation } = task();
    let whole = trainer(4).fit(&model, &training, &validation, &mut ()).unwrap();
    let folder = folder("resume");
    let path = folder.join("checkpoint.json");
    let checkpoint = Some(Checkpoint { path: path.clone(), every: 3 });
    let with = Trainer { checkpoint, ..trainer(4) };
    // 9 batches an epoch: broken off in the second epoch, then in the third
    for steps in [13, 9] {
        let part = with.fit(&model, &training, &validation, &mut After(steps)).unwrap();
        assert_eq!(part.ended, Ended::Asked);
    }
    // a program killed while it writes leaves a broken new file, not a broken checkpoint
    std::fs::write(folder.join("checkpoint.json.new"), "{").unwrap();
    let rest = with.fit(&model, &training, &validation, &mut ()).unwrap();
    assert_eq!(rest.resumed, Some(2));
    assert_eq!(bits(&whole.model), bits(&rest.model));
    assert_eq!(whole.history, rest.history);
    // what was written down at a step in between goes on to the same end as well
    std::fs::remove_file(&path).unwrap();
    let mut kept = None;
    let mut count = 0;
    struct Spy<'a>(&'a mut dyn FnMut());
    impl Follow for Spy<'_> {
        fn on_epoch(&mut self, _: &Epoch) -> ControlFlow<()> {
            ControlFlow::Continue(())
        }
        fn on_step(&mut self, _: usize, _: usize) -> ControlFlow<()> {
            (self.0)();
            ControlFlow::Continue(())
        }
    }
    let mut spy = || {
        count += 1;
        if count == 17 {
            kept = std::fs::read(&path).ok();
        }
    };
    with.fit(&model, &training, &validation, &mut Spy(&mut spy)).unwrap();
    std::fs::write(&path, kept.unwrap()).unwrap();
    let again = with.fit(&model, &training, &validation, &mut ()).unwrap();
    assert_eq!(again.resumed, Some(1));
    assert_eq!(bits(&whole.model), bits(&again.model));
    // another run's checkpoint is refused
    let other = Trainer { seed: 5, ..with };
    let error = other.fit(&model, &training, &validation, &mut ()).unwrap_err();
    assert!(matches!(error, TrainError::OtherRun { .. }), "{error}");
    assert!(error.hint().is_some());
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn turns_back_from_infinity_and_says_so() {
    let Task { training, validation, .. } = task();
    // steps so long that the model explodes: its spring is cubic
    let model = start(&duffing(2.0, 30.0), &training[0], &[]);
    let optimiser = Adam { rate: 1e3, ..Adam::default() }.into();
    let wild = Trainer { optimiser, ..trainer(6) };
    let fit = wild.fit(&model, &training, &validation, &mut ()).unwrap();
    assert!(fit.rollbacks > 0);
    let told: usize = fit.history.iter().map(|epoch| epoch.rolled_back).sum();
    assert_eq!(told, fit.rollbacks);
    assert!(fit.history.last().unwrap().rate < 1e3);
    assert!(fit.model.parameters().iter().all(|p| p.is_finite()));
}

#[test]
fn stops_when_nothing_is_gained_any_more() {
    let Task { model, training, validation } = task();
    let optimiser = Adam { rate: 0.3, ..Adam::default() }.into();
    let eager = Trainer { optimiser, patience: Some(3), ..trainer(200) };
    let fit = eager.fit(&model, &training, &validation, &mut ()).unwrap();
    assert_eq!(fit.ended, Ended::Patience);
    assert_eq!(fit.history.len() - 1, fit.epoch + 4);
}

#[test]
fn a_wrong_parameter_is_found_and_the_penalty_holds_it() {
    let truth = duffing(2.0, 30.0);
    let training = vec![measured(&truth, 900, 1, 1e-3)];
    let validation = vec![measured(&truth, 500, 3, 1e-3)];
    // position of `damping` among the parameters
    // the learned part is where it cannot take the damping's place: at the output
    let structure = Structure { form: Form::OutputBlock, ..Structure::default() };
    let model = with_structure(&duffing(3.0, 30.0), &training[0], &[1], structure);
    let damping = |penalty: f64| {
        let trainer = Trainer { penalty, ..trainer(40) };
        let fit = trainer.fit(&model, &training, &validation, &mut ()).unwrap();
        fit.model.model.parameters()[0]
    };
    let (free, held) = (damping(0.0), damping(1e4));
    assert!((free - 2.0).abs() < 0.3, "{free}");
    // the steps do not shrink: what is held still trembles
    assert!((held - 3.0).abs() < 0.1, "{held}");
}

#[test]
fn settings_and_records_that_cannot_be_right_are_refused() {
    let Task { model, training, validation } = task();
    let refused = |trainer: Trainer, training: &[Record]| {
        let error = trainer.fit(&model, training, &validation, &mut ()).unwrap_err();
        assert!(error.hint().is_some());
        error
    };
    let zero = Trainer { batch: 0, ..trainer(1) };
    assert!(matches!(refused(zero, &training), TrainError::Setting { name: "batch", .. }));
    let long = Trainer { length: 1000, ..trainer(1) };
    assert!(matches!(refused(long, &training), TrainError::TooShort { .. }));
    let lone = [Record::new(T_S).input("force [N]", vec![0.0; 100]).unwrap()];
    assert!(matches!(refused(trainer(1), &lone), TrainError::NoSignal { role: "output", .. }));
}
