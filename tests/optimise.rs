//! Every optimiser on the shelf of problems with known answers, and what they promise.

use std::ops::ControlFlow;

use lacuna::fault::Explain;
use lacuna::optimise::*;

/// Lowers a problem and says how far above the minimum it ended.
fn gap(optimiser: &dyn Optimiser, problem: &shelf::Problem) -> (f64, Outcome) {
    let mut theta = problem.start.clone();
    let outcome = optimiser.minimise(problem, &mut theta, &mut ()).unwrap();
    let mut gradient = vec![0.0; theta.len()];
    let value = problem.value_and_gradient(&theta, &mut gradient);
    assert_eq!(value, outcome.loss, "{}: the vector handed back is not the best one", problem.name);
    if let Some(bounds) = Objective::bounds(problem) {
        let mut inside = theta.clone();
        bounds.project(&mut inside);
        assert_eq!(inside, theta, "{}: out of bounds", problem.name);
    }
    (value - problem.minimum, outcome)
}

#[test]
fn every_optimiser_solves_the_shelf() {
    let adam = Adam {
        rate: 0.05,
        schedule: Schedule::Cosine { steps: 30_000.0, last: 1e-3 },
        stop: Stop::after(30_000),
        ..Adam::default()
    };
    let all: [(&dyn Optimiser, f64); 3] =
        [(&Lbfgs::default(), 1e-11), (&LevenbergMarquardt::default(), 1e-9), (&adam, 1e-6)];
    for (optimiser, tolerance) in all {
        for problem in shelf::all() {
            let (gap, outcome) = gap(optimiser, &problem);
            println!("{:22} {:28} {gap:9.1e} {outcome:?}", optimiser.typetag_name(), problem.name);
            assert!(gap.abs() <= tolerance, "{optimiser:?} on {}: {gap:e}", problem.name);
        }
    }
}

#[test]
fn slopes_of_the_shelf_agree_with_differences() {
    for problem in shelf::all() {
        let mut at = problem.start.clone();
        at.iter_mut().enumerate().for_each(|(i, t)| *t += 0.1 + 0.01 * i as f64);
        let mut gradient = vec![0.0; at.len()];
        let mut unused = gradient.clone();
        problem.value_and_gradient(&at, &mut gradient);
        for i in 0..at.len() {
            let mut value = |step: f64| {
                let mut moved = at.clone();
                moved[i] += step;
                problem.value_and_gradient(&moved, &mut unused)
            };
            let h = 1e-5;
            let difference = (value(h) - value(-h)) / (2.0 * h);
            assert!(
                (difference - gradient[i]).abs() < 1e-6 * (1.0 + difference.abs()),
                "{}[{i}]: {difference} against {}",
                problem.name,
                gradient[i]
            );
        }
    }
}

#[test]
fn steps_off_the_cliff_are_taken_back_and_told() {
    let cliff = shelf::cliff();
    let adam = Adam { rate: 20.0, clip: Some(1.0), stop: Stop::after(2000), ..Adam::default() };
    let mut told = 0;
    let mut observer = |progress: &Progress| {
        told += usize::from(progress.rolled_back);
        ControlFlow::Continue(())
    };
    let mut theta = cliff.start.clone();
    let outcome = adam.minimise(&cliff, &mut theta, &mut observer).unwrap();
    assert!(outcome.rollbacks > 0 && told == outcome.rollbacks, "{outcome:?}");
    assert!((theta[0] - 1.0).abs() < 1e-2, "{theta:?}");
    let lbfgs = Lbfgs { first_step: 50.0, ..Lbfgs::default() };
    let mut theta = cliff.start.clone();
    let outcome = lbfgs.minimise(&cliff, &mut theta, &mut ()).unwrap();
    assert!(outcome.rollbacks > 0 && (theta[0] - 1.0).abs() < 1e-6, "{outcome:?} {theta:?}");
}

/// Finite only at the start.
struct Pit;

impl Objective for Pit {
    fn len(&self) -> usize {
        1
    }
    fn value_and_gradient(&self, theta: &[f64], gradient: &mut [f64]) -> f64 {
        gradient[0] = 1.0;
        if theta[0] == 3.0 { 7.0 } else { f64::NAN }
    }
}

#[test]
fn no_way_out_is_an_error_that_keeps_the_start() {
    let mut theta = [3.0];
    let error = Adam::default().minimise(&Pit, &mut theta, &mut ()).unwrap_err();
    assert!(matches!(error, OptimiseError::NotFinite { best, .. } if best == 7.0), "{error}");
    assert_eq!(theta, [3.0]);
    assert!(error.hint().is_some());
    let outcome = Lbfgs::default().minimise(&Pit, &mut theta, &mut ()).unwrap();
    assert_eq!((outcome.stopped, theta), (Stopped::Stuck, [3.0]));
    for optimiser in [&Adam::default() as &dyn Optimiser, &Lbfgs::default()] {
        let error = optimiser.minimise(&Pit, &mut [4.0], &mut ()).unwrap_err();
        assert!(matches!(error, OptimiseError::NotFiniteStart { .. }), "{error}");
    }
}

#[test]
fn wrong_calls_are_errors() {
    let problem = shelf::rosenbrock(2);
    let all: [&dyn Optimiser; 3] =
        [&Adam::default(), &Lbfgs::default(), &LevenbergMarquardt::default()];
    for optimiser in all {
        let error = optimiser.minimise(&problem, &mut [0.0; 3], &mut ()).unwrap_err();
        assert!(matches!(error, OptimiseError::Length { expected: 2, found: 3, .. }), "{error}");
    }
    let error = LevenbergMarquardt::default().minimise(&Pit, &mut [3.0], &mut ()).unwrap_err();
    assert!(matches!(error, OptimiseError::NotLeastSquares { .. }), "{error}");
    for adam in [
        Adam { rate: 0.0, ..Adam::default() },
        Adam { rate: f64::NAN, ..Adam::default() },
        Adam { beta2: 1.0, ..Adam::default() },
        Adam { clip: Some(-1.0), ..Adam::default() },
    ] {
        let error = adam.minimise(&problem, &mut [0.0; 2], &mut ()).unwrap_err();
        assert!(matches!(error, OptimiseError::Setting { .. }), "{error}");
    }
    let mut state = AdamState::new(2);
    let error = Adam::default().step(&mut state, &mut [0.0; 2], &[1.0, f64::INFINITY]).unwrap_err();
    assert!(matches!(error, OptimiseError::Gradient { entry: 1, .. }), "{error}");
    assert_eq!(state, AdamState::new(2));
}

#[test]
fn the_first_step_of_adam_is_the_rate_and_decay_is_apart_from_it() {
    let adam = Adam { rate: 0.1, weight_decay: 0.5, clip: Some(1.0), ..Adam::default() };
    let mut theta = [4.0, -2.0];
    let step = adam.step(&mut AdamState::new(2), &mut theta, &[30.0, -40.0]).unwrap();
    assert_eq!((step.norm, step.clipped), (50.0, true));
    // theta (1 - rate decay) -+ rate
    assert!((theta[0] - (4.0 * 0.95 - 0.1)).abs() < 1e-7, "{theta:?}");
    assert!((theta[1] - (-2.0 * 0.95 + 0.1)).abs() < 1e-7, "{theta:?}");
}

#[test]
fn a_run_driven_by_hand_and_resumed_is_the_same_run() {
    let problem = shelf::rosenbrock(10);
    let adam = Adam { rate: 0.01, ..Adam::default() };
    let run = |theta: &mut Vec<f64>, state: &mut AdamState, steps: usize| {
        let mut gradient = vec![0.0; 10];
        for _ in 0..steps {
            problem.value_and_gradient(theta, &mut gradient);
            adam.step(state, theta, &gradient).unwrap();
        }
    };
    let (mut whole, mut state) = (problem.start.clone(), AdamState::new(10));
    run(&mut whole, &mut state, 200);
    let (mut half, mut state) = (problem.start.clone(), AdamState::new(10));
    run(&mut half, &mut state, 90);
    let saved = serde_json::to_string(&(&half, &state)).unwrap();
    let (mut half, mut state): (Vec<f64>, AdamState) = serde_json::from_str(&saved).unwrap();
    run(&mut half, &mut state, 110);
    assert_eq!(half, whole);
}

#[test]
fn optimisers_survive_their_own_file() {
    for text in [
        "[adam]\nrate = 0.01\nschedule = { cosine = { steps = 100.0 } }\nclip = 1.0",
        "[lbfgs]\nmemory = 20\nstop = { steps = 200 }",
        "[levenberg_marquardt]\ndifference = 1e-5",
    ] {
        let optimiser: Box<dyn Optimiser> = toml::from_str(text).unwrap();
        let again: Box<dyn Optimiser> =
            toml::from_str(&toml::to_string(&optimiser).unwrap()).unwrap();
        assert_eq!(format!("{optimiser:?}"), format!("{again:?}"));
    }
    let error = toml::from_str::<Box<dyn Optimiser>>("[adam]\nrat = 0.1").unwrap_err().to_string();
    assert!(error.contains("rat"), "{error}");
}

#[test]
fn the_change_of_variable_goes_there_and_back() {
    struct Sum;
    impl Objective for Sum {
        fn len(&self) -> usize {
            4
        }
        fn value_and_gradient(&self, theta: &[f64], gradient: &mut [f64]) -> f64 {
            gradient.copy_from_slice(theta);
            0.5 * theta.iter().map(|t| t * t).sum::<f64>()
        }
    }
    let inf = f64::INFINITY;
    let bounds = Bounds { lower: vec![-1.0, 2.0, -inf, -inf], upper: vec![3.0, inf, -1.0, inf] };
    let free = Transformed::new(&Sum, &bounds);
    let point = [0.3, 5.0, -4.0, 0.7];
    let z = free.free(&point);
    for (a, b) in free.bound(&z).iter().zip(point) {
        assert!((a - b).abs() < 1e-12);
    }
    let mut theta = point;
    let outcome = Lbfgs::default().minimise(&BoundedSum(Sum, bounds), &mut theta, &mut ()).unwrap();
    assert!((outcome.loss - 0.5 * (4.0 + 1.0)).abs() < 1e-9, "{outcome:?} {theta:?}");

    struct BoundedSum(Sum, Bounds);
    impl Objective for BoundedSum {
        fn len(&self) -> usize {
            4
        }
        fn value_and_gradient(&self, theta: &[f64], gradient: &mut [f64]) -> f64 {
            self.0.value_and_gradient(theta, gradient)
        }
        fn bounds(&self) -> Option<&Bounds> {
            Some(&self.1)
        }
    }
}
