//! Initialisers on baselines and records.

use lacuna::data::{Random as Numbers, Record};
use lacuna::encoder::*;
use lacuna::fault::{Explain, Kind};
use lacuna::model::linearised;
use lacuna::model::lti::{Lti, LtiTime};
use lacuna::plugins::systems::Duffing;
use lacuna::system::{Hold, Integrator, Method, Sampling, System};

fn lti(k: bool) -> Lti {
    Lti {
        a: vec![vec![0.8, 0.3, 0.0], vec![-0.3, 0.7, 0.1], vec![0.0, 0.2, 0.5]],
        b: vec![vec![0.0, 1.0], vec![1.0, 0.0], vec![0.5, -0.5]],
        c: vec![vec![1.0, 0.0, 0.2], vec![0.0, 1.0, 0.0]],
        d: vec![vec![0.1, 0.0], vec![0.0, 0.0]],
        offset: vec![],
        k: if k { vec![vec![0.3, 0.1], vec![0.0, 0.3], vec![0.1, 0.0]] } else { vec![] },
        time: LtiTime::Discrete,
        inputs: vec![],
        states: vec![],
        outputs: vec![],
        fixed: vec![],
    }
}

fn discrete(model: Lti) -> System {
    System::new(model, Sampling { sampling_time: Some(0.1), ..Sampling::default() })
}

fn duffing(hardening: f64) -> Duffing {
    Duffing { mass: 0.7, damping: 1.5, stiffness: 40.0, hardening, fixed: vec![] }
}

fn sampled(model: impl lacuna::model::StateSpaceModel + 'static) -> System {
    let integrator = Integrator { method: Method::Rk4, substeps: 4 };
    System::new(model, Sampling { integrator, ..Sampling::default() })
}

fn noise(n: usize, seed: u64, size: f64, mean: f64) -> Vec<f64> {
    let mut numbers = Numbers::new(seed);
    (0..n).map(|_| mean + size * numbers.normal()).collect()
}

/// A record with inputs alone.
fn driven(inputs: usize, n: usize, size: f64, mean: f64) -> Record {
    let mut record = Record::new(0.1);
    for i in 0..inputs {
        let name = if inputs == 1 { "u".into() } else { format!("u{}", i + 1) };
        record = record.input(&name, noise(n, 50 + i as u64, size, mean)).unwrap();
    }
    record
}

/// The same with the system's own outputs and white noise on them.
fn measured(system: &System, mut record: Record, size: f64) -> Record {
    let baseline = Baseline::new(system, &record).unwrap().simulate().unwrap().outputs.clone();
    let signals = system.signals();
    for (i, (y, signal)) in baseline.into_iter().zip(&signals.outputs).enumerate() {
        let e = noise(y.len(), 90 + i as u64, size, 0.0);
        let y: Vec<f64> = y.iter().zip(&e).map(|(y, e)| y + e).collect();
        record = record.output(&signal.name, y).unwrap();
    }
    record
}

fn worst(states: &[StateError]) -> f64 {
    states.iter().map(|s| s.nrmse).fold(0.0, f64::max)
}

fn encoders(window: Window) -> [Box<dyn Encoder>; 2] {
    [Box::new(LinearEncoder::new(window)), Box::new(ResNetEncoder::new(window, &[6, 5]))]
}

#[test]
fn linear_baselines_start_exactly() {
    let record = driven(2, 300, 1.0, 0.4);
    let (plain, with_gain) = (discrete(lti(false)), discrete(lti(true)));
    let methods: [(&System, &dyn EncoderInitialiser, f64); 5] = [
        (&plain, &Reconstruct {}, 1e-10),
        (&plain, &Linearised::default(), 1e-10),
        (&with_gain, &Innovation::default(), 1e-10),
        (&with_gain, &Reconstruct {}, 1e-10),
        (&plain, &LeastSquares::default(), 1e-9),
    ];
    for (system, initialiser, limit) in methods {
        let baseline = Baseline::new(system, &record).unwrap();
        for window in [Window::past(6), Window { n_a: 5, n_b: 8, current_sample: true }] {
            for mut encoder in encoders(window) {
                let started = initialiser.initialise(encoder.as_mut(), &baseline, 1).unwrap();
                let name = initialiser.typetag_name();
                assert_eq!(started.initialiser, name);
                assert_eq!(started.states.len(), 3);
                assert!(worst(&started.states) < limit, "{name} {window:?}: {started}");
                assert!(started.rank.unwrap() >= 3 && started.condition.unwrap() >= 1.0);
                assert!(started.squared_error() < limit);
                assert!(started.to_string().contains("x3 off by"), "{started}");
            }
        }
    }
}

#[test]
fn a_continuous_linear_baseline_is_discretised_exactly() {
    let record = driven(1, 300, 1.0, 0.0);
    let mut model = lti(false);
    model.time = LtiTime::Continuous;
    model.a = vec![vec![0.0, 1.0], vec![-30.0, -0.8]];
    model.b = vec![vec![0.0], vec![2.0]];
    model.c = vec![vec![1.0, 0.0]];
    model.d = vec![];
    let system = System::new(model, Sampling::default());
    let baseline = Baseline::new(&system, &record).unwrap();
    let mut encoder = LinearEncoder::new(Window::past(4));
    let started = Reconstruct {}.initialise(&mut encoder, &baseline, 0).unwrap();
    assert!(worst(&started.states) < 1e-10, "{started}");
}

#[test]
fn an_affine_baseline_puts_its_constants_into_the_bias() {
    // the linearisation at a point that is no equilibrium (footnote of Sec. 3.1.3)
    let at = linearised::Point { x: vec![0.2, -0.5], u: vec![3.0] };
    let affine = linearised::Linearised::new(Box::new(duffing(400.0)), Some(at));
    let system = sampled(affine);
    let record = driven(1, 300, 1.0, 0.0);
    let baseline = Baseline::new(&system, &record).unwrap();
    for window in [Window::past(4), Window::past(4).with_current()] {
        let mut encoder = ResNetEncoder::new(window, &[4]);
        let started = Linearised::default().initialise(&mut encoder, &baseline, 0).unwrap();
        assert!(worst(&started.states) < 1e-10, "{started}");
        // with everything at 0 only the bias is left, and there is one
        let bias = encoder.estimate(&vec![0.0; window.rows(1, 1)], 1).unwrap();
        assert!(bias.iter().any(|b| b.abs() > 1e-3), "{bias:?}");
    }
}

#[test]
fn a_nonlinear_baseline_is_met_best_where_it_is_linearised() {
    // small motion about the state that 8 N hold
    let system = sampled(duffing(2000.0));
    let mut p: f64 = 0.1;
    for _ in 0..50 {
        p -= (40.0 * p + 2000.0 * p.powi(3) - 8.0) / (40.0 + 6000.0 * p * p);
    }
    let record = driven(1, 600, 0.05, 8.0);
    let baseline = Baseline::new(&system, &record).unwrap();
    let off = |about: About| {
        let mut encoder = LinearEncoder::new(Window::past(4));
        let method = Linearised { about: Some(about), gain: None };
        method.initialise(&mut encoder, &baseline, 0).unwrap();
        // after the motion from 0 to there has died out
        let Course { outputs: y, states: x } = baseline.simulate().unwrap();
        let u = &record.inputs[0].values;
        let ks: Vec<usize> = (200..600).collect();
        let windows = encoder.window().gather(&[&y[0]], &[u], &ks);
        let estimated = encoder.estimate(&windows, 400).unwrap();
        let each = (0..400).map(|i| (estimated[i] - x[0][200 + i]).abs());
        each.fold(0.0, f64::max)
    };
    let (at_zero, there) = (off(About::Equilibrium), off(About::EquilibriumAt { u: vec![8.0] }));
    let beside = off(About::Point { x: vec![p + 0.002, 0.01], u: vec![8.1] });
    println!(
        "largest error of the position in m: at 0 {at_zero:.1e}, there {there:.1e}, beside {beside:.1e}"
    );
    assert!(there < 1e-4 && beside < 3e-4 && at_zero > 20.0 * beside);
}

#[test]
fn friction_at_rest_does_not_make_the_damper_of_a_record() {
    use lacuna::plugins::effects::coulomb_friction::CoulombFriction;
    use lacuna::system::Placed;
    let mut system = sampled(duffing(0.0));
    let friction = CoulombFriction { level: -2.0, width: 0.05 };
    system.effects = vec![Placed::new(Box::new(friction), "force", Some("v"))];
    let record = driven(1, 4000, 20.0, 0.0);
    let baseline = Baseline::new(&system, &record).unwrap();
    let start = |method: &dyn EncoderInitialiser| {
        let mut encoder = LinearEncoder::new(Window::past(4));
        method.initialise(&mut encoder, &baseline, 0).unwrap()
    };
    let at_rest = Linearised { about: Some(About::Equilibrium), gain: None };
    let [along, at_rest] = [start(&Linearised::default()), start(&at_rest)];
    let least = start(&LeastSquares::default());
    println!("{along}\n{at_rest}\n{least}");
    assert!(worst(&along.states) < 0.1 * worst(&at_rest.states));
    // not far from the best linear map there is
    assert!(worst(&along.states) < 2.0 * worst(&least.states));
}

#[test]
fn hidden_states_are_named_as_the_model_names_them() {
    let mut model = lti(false);
    model.a = vec![vec![0.8, 0.3, 0.0], vec![-0.3, 0.7, 0.0], vec![0.0, 0.2, 0.5]];
    model.c = vec![vec![1.0, 0.0, 0.0], vec![0.0, 1.0, 0.0]];
    let names = ["level", "flow", "heat"].map(|n| lacuna::model::lti::Named::Name(n.into()));
    model.states = names.to_vec();
    let system = discrete(model);
    let record = driven(2, 300, 1.0, 0.0);
    let baseline = Baseline::new(&system, &record).unwrap();
    let mut encoder = LinearEncoder::new(Window::past(6));
    let error = Reconstruct {}.initialise(&mut encoder, &baseline, 0).unwrap_err();
    let EncoderError::Unobservable { hidden, rank: 2, states: 3, .. } = &error else {
        panic!("{error}")
    };
    assert_eq!(hidden, &["heat"]);
    assert_eq!(error.kind(), Kind::Work);
    assert!(error.hint().unwrap().contains("measure another output"));
}

#[test]
fn what_a_method_cannot_do_it_says() {
    let record = driven(1, 300, 1.0, 0.0);
    let nonlinear = sampled(duffing(100.0));
    let baseline = Baseline::new(&nonlinear, &record).unwrap();
    let mut encoder = LinearEncoder::new(Window::past(4));
    let error = Reconstruct {}.initialise(&mut encoder, &baseline, 0).unwrap_err();
    assert!(
        matches!(&error, EncoderError::NotLinear { model, .. } if model == "duffing"),
        "{error}"
    );
    let error = LeastSquares { outputs: Outputs::Measured }.initialise(&mut encoder, &baseline, 0);
    assert!(matches!(&error, Err(EncoderError::NoSignal { role: "output", .. })), "{error:?}");
    let mut nothing = LinearEncoder::new(Window::past(0));
    for method in [&Random {} as &dyn EncoderInitialiser, &Linearised::default()] {
        let error = method.initialise(&mut nothing, &baseline, 0).unwrap_err();
        assert!(matches!(error, EncoderError::EmptyWindow { .. }), "{error}");
    }
    let mut long = LinearEncoder::new(Window::past(299));
    let error = Random {}.initialise(&mut long, &baseline, 0).unwrap_err();
    assert!(matches!(error, EncoderError::TooShort { windows: 1, .. }), "{error}");
    let mut along = sampled(duffing(100.0));
    along.sampling.hold = Hold::First;
    let line = Baseline::new(&along, &record).unwrap();
    // a first-order hold is no hindrance
    let started = Linearised::default().initialise(&mut encoder, &line, 0).unwrap();
    assert!(started.states.iter().all(|state| state.nrmse.is_finite()), "{started}");

    let two = driven(2, 300, 1.0, 0.0);
    let plain = discrete(lti(false));
    let linear = Baseline::new(&plain, &two).unwrap();
    let error = Innovation::default().initialise(&mut encoder, &linear, 0).unwrap_err();
    assert!(matches!(error, EncoderError::NoGain { .. }), "{error}");
    let wrong = Innovation { gain: Some(vec![vec![0.1]; 3]) };
    let error = wrong.initialise(&mut encoder, &linear, 0).unwrap_err();
    assert!(matches!(error, EncoderError::Count { expected: 2, found: 1, .. }), "{error}");
    let error = Baseline::new(&plain, &record).unwrap_err();
    assert!(matches!(&error, EncoderError::NoSignal { name, .. } if name == "u1"), "{error}");
    assert!(encoder.estimate(&[0.0; 3], 1).is_err());
}

#[test]
fn least_squares_is_the_best_linear_map_on_measured_outputs() {
    let system = sampled(duffing(800.0));
    let record = measured(&system, driven(1, 2000, 6.0, 0.0), 0.01);
    let baseline = Baseline::new(&system, &record).unwrap();
    let start = |method: &dyn EncoderInitialiser| {
        let mut encoder = LinearEncoder::new(Window::past(8));
        method.initialise(&mut encoder, &baseline, 0).unwrap()
    };
    let linearised = start(&Linearised::default());
    let simulated = start(&LeastSquares::default());
    let measured = start(&LeastSquares { outputs: Outputs::Measured });
    for i in 0..2 {
        assert!(simulated.states[i].rmse < linearised.states[i].rmse);
        assert!(measured.measured[i].rmse <= simulated.measured[i].rmse);
        assert!(measured.measured[i].rmse <= linearised.measured[i].rmse);
    }
    assert!(measured.measured[0].rmse < 0.9 * linearised.measured[0].rmse);
}

#[test]
fn a_prefit_sees_what_no_linear_map_can() {
    let system = sampled(duffing(800.0));
    let record = driven(1, 2000, 6.0, 0.0);
    let baseline = Baseline::new(&system, &record).unwrap().augmented(1);
    let mut linear = LinearEncoder::new(Window::past(5));
    let best = LeastSquares::default().initialise(&mut linear, &baseline, 0).unwrap();
    for start in [PrefitStart::Random, PrefitStart::LeastSquares] {
        let prefit = Prefit { start, lbfgs_steps: 100, ..Prefit::default() };
        let fit = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let mut encoder = ResNetEncoder::new(Window::past(5), &[8]);
            let started = pool.install(|| prefit.initialise(&mut encoder, &baseline, 3).unwrap());
            (started, encoder.weights().to_vec())
        };
        let (started, weights) = fit(1);
        println!("{start:?}: {:.2e} against {:.2e}", started.squared_error(), best.squared_error());
        assert!(started.squared_error() < 0.2 * best.squared_error(), "{started}");
        assert_eq!(started.optimised.len(), 2);
        assert_eq!(weights, fit(3).1, "the number of threads shows");
    }
}

#[test]
fn seeds_decide_what_is_random() {
    let system = discrete(lti(false));
    let record = driven(2, 300, 1.0, 0.0);
    let baseline = Baseline::new(&system, &record).unwrap().augmented(2);
    let weights = |seed| {
        let mut encoder = ResNetEncoder::new(Window::past(4), &[5]);
        Random {}.initialise(&mut encoder, &baseline, seed).unwrap();
        assert_eq!(encoder.shape().unwrap().states(), 5);
        encoder.weights().to_vec()
    };
    assert_eq!(weights(1), weights(1));
    assert_ne!(weights(1), weights(2));
    // a map for the baseline's states leaves the augmented ones as they were
    let mut encoder = ResNetEncoder::new(Window::past(4), &[5]);
    Random {}.initialise(&mut encoder, &baseline, 1).unwrap();
    let window = noise(16, 7, 1.0, 0.0);
    let before = encoder.estimate(&window, 1).unwrap();
    let mut same = ResNetEncoder::new(Window::past(4), &[5]);
    Reconstruct {}.initialise(&mut same, &baseline, 1).unwrap();
    let after = same.estimate(&window, 1).unwrap();
    assert_eq!(before[3..], after[3..]);
    assert_ne!(before[..3], after[..3]);
}

#[test]
fn initialisers_survive_their_own_file() {
    for text in [
        "[random]",
        "[reconstruct]",
        "[innovation]\ngain = [[0.1], [0.2]]",
        "[linearised]\nabout = { point = { x = [0.1, 0.0], u = [1.0] } }",
        "[linearised]\nabout = \"equilibrium\"",
        "[linearised]",
        "[least_squares]\noutputs = \"measured\"",
        "[prefit]\nadam_steps = 0\nstart = \"least_squares\"",
    ] {
        let method: Box<dyn EncoderInitialiser> = toml::from_str(text).unwrap();
        let again: Box<dyn EncoderInitialiser> =
            toml::from_str(&toml::to_string(&method).unwrap()).unwrap();
        assert_eq!(format!("{method:?}"), format!("{again:?}"));
        let unknown = toml::from_str::<Box<dyn EncoderInitialiser>>(&format!("{text}\nlags = 3"));
        assert!(unknown.is_err(), "{text}");
    }
}
