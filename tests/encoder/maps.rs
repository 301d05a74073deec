//! Reconstructability maps: noise-free recursions have to come out exactly.

// nalgebra's `stack!` expands to such a pattern; one segment is one range
#![allow(clippy::toplevel_ref_arg, clippy::single_range_in_vec_init)]

use lacuna::data::Random;
use lacuna::encoder::{About, EncoderError, Reconstruction, SampledLinear, Window};
use lacuna::plugins::systems::Duffing;
use lacuna::system::{Integrator, Method, Sampling, System};
use nalgebra::{DMatrix, DVector};

/// A stable system with random matrices.
fn system(seed: u64, [n, nu, ny]: [usize; 3], constants: bool, gain: bool) -> SampledLinear {
    let mut random = Random::new(seed);
    let mut matrix = |rows, columns| DMatrix::from_fn(rows, columns, |_, _| random.normal());
    let a = matrix(n, n);
    let radius = a.complex_eigenvalues().iter().map(|z| z.norm()).fold(0.0, f64::max);
    let (b, c, d) = (matrix(n, nu), matrix(ny, n), matrix(ny, nu));
    let k = 0.1 * matrix(n, ny);
    let size = if constants { 1.0 } else { 0.0 };
    let (f, h) = (matrix(n, 1).column(0) * size, matrix(ny, 1).column(0) * size);
    SampledLinear { a: a * (0.9 / radius), b, f, c, d, h, k: gain.then_some(k) }
}

/// States, outputs and inputs along random inputs; with innovations where there is a gain.
struct Course {
    x: Vec<DVector<f64>>,
    y: Vec<Vec<f64>>,
    u: Vec<Vec<f64>>,
}

fn run(system: &SampledLinear, samples: usize, seed: u64, noise: f64) -> Course {
    let (n, nu, ny) = (system.a.nrows(), system.b.ncols(), system.c.nrows());
    let mut random = Random::new(seed);
    let mut x = DVector::from_fn(n, |_, _| random.normal());
    let mut course = Course { x: vec![], y: vec![vec![]; ny], u: vec![vec![]; nu] };
    for _ in 0..samples {
        let u = DVector::from_fn(nu, |_, _| random.normal());
        let e = DVector::from_fn(ny, |_, _| noise * random.normal());
        let y = &system.c * &x + &system.d * &u + &system.h + &e;
        course.x.push(x.clone());
        course.y.iter_mut().zip(y.iter()).for_each(|(series, v)| series.push(*v));
        course.u.iter_mut().zip(u.iter()).for_each(|(series, v)| series.push(*v));
        x = &system.a * &x + &system.b * &u + &system.f;
        if let Some(k) = &system.k {
            x += k * e;
        }
    }
    course
}

/// Largest distance of the map's states from the true ones, over the size of the states.
fn off(found: &Reconstruction, window: Window, course: &Course) -> f64 {
    let y: Vec<&[f64]> = course.y.iter().map(|y| &y[..]).collect();
    let u: Vec<&[f64]> = course.u.iter().map(|u| &u[..]).collect();
    let size = course.x.iter().map(|x| x.amax()).fold(0.0, f64::max);
    let ks = window.starts(&[0..course.x.len()], &y, 1);
    assert!(ks.len() > 10);
    let each = ks.iter().map(|&k| {
        let vector = DVector::from_vec(window.gather(&y, &u, &[k]));
        (&found.map.weights * vector + &found.map.bias - &course.x[k]).amax()
    });
    each.fold(0.0, f64::max) / size
}

fn names(n: usize) -> Vec<String> {
    (0..n).map(|i| format!("x{}", i + 1)).collect()
}

#[test]
fn a_linear_system_without_noise_is_reconstructed_exactly() {
    // eq. final_noiseless: SISO and MIMO, n_a != n_b, current sample and not, constants
    let sizes = [[4, 1, 1], [3, 2, 1], [5, 2, 3], [2, 0, 1], [4, 1, 2]];
    for (seed, sizes) in sizes.into_iter().enumerate() {
        for (n_a, n_b) in [(9, 9), (7, 12), (12, 7)] {
            for current_sample in [false, true] {
                for constants in [false, true] {
                    let system = system(seed as u64, sizes, constants, false);
                    let window = Window { n_a, n_b, current_sample };
                    let found = Reconstruction::of(&system, window, &names(sizes[0])).unwrap();
                    let off = off(&found, window, &run(&system, 60, 100, 0.0));
                    assert!(off < 1e-10, "{sizes:?} {window:?} constants {constants}: {off:e}");
                    assert_eq!(found.rank, sizes[0]);
                    assert!(found.condition >= 1.0);
                }
            }
        }
    }
}

#[test]
fn the_map_is_the_printed_one_entry_for_entry() {
    // O, T, r as in eq. y_k_k+n for n = 2 with the current sample, newest sample on top
    let s = system(3, [2, 1, 1], false, false);
    let (a, b, c, d) = (&s.a, &s.b, &s.c, &s.d);
    let o = nalgebra::stack![c * a * a; c * a; c];
    let zero = DMatrix::zeros(1, 1);
    let t = nalgebra::stack![
        d, c * b, c * a * b;
        zero.clone(), d, c * b;
        zero.clone(), zero, d
    ];
    let r = nalgebra::stack![DMatrix::zeros(2, 1), b, a * b];
    let inverse = o.clone().pseudo_inverse(1e-14).unwrap();
    let w_y = a * a * &inverse;
    let w_u = -a * a * inverse * t + r;
    let window = Window::past(2).with_current();
    let found = Reconstruction::of(&s, window, &names(2)).unwrap();
    let printed = nalgebra::stack![w_y, w_u];
    assert!((&found.map.weights - &printed).amax() < 1e-12 * printed.amax());
    assert_eq!(found.map.bias.amax(), 0.0);
}

#[test]
fn a_noise_model_makes_the_map_the_conditional_expectation() {
    // eq. noisy:final, printed matrices for n = 2 with the current sample
    let s = system(4, [2, 1, 1], false, true);
    let k = s.k.clone().unwrap();
    let a = &s.a - &k * &s.c;
    let b = &s.b - &k * &s.d;
    let (c, d) = (&s.c, &s.d);
    let zero = DMatrix::zeros(1, 1);
    let o = nalgebra::stack![c * &a * &a; c * &a; c];
    let t = nalgebra::stack![
        d, c * &b, c * &a * &b;
        zero.clone(), d, c * &b;
        zero.clone(), zero.clone(), d
    ];
    let lambda = nalgebra::stack![
        zero.clone(), c * &k, c * &a * &k;
        zero.clone(), zero.clone(), c * &k;
        zero.clone(), zero.clone(), zero
    ];
    let blank = DMatrix::zeros(2, 1);
    let r = nalgebra::stack![blank.clone(), b.clone(), &a * &b];
    let small = nalgebra::stack![blank, k.clone(), &a * &k];
    let inverse = o.pseudo_inverse(1e-14).unwrap();
    let back = &a * &a * inverse;
    let w_y = &back * (DMatrix::identity(3, 3) - lambda) + small;
    let w_u = -back * t + r;
    let window = Window::past(2).with_current();
    let found = Reconstruction::of(&s, window, &names(2)).unwrap();
    let printed = nalgebra::stack![w_y, w_u];
    assert!((&found.map.weights - &printed).amax() < 1e-12 * printed.amax());
}

#[test]
fn with_a_noise_model_states_are_exact_without_noise_and_better_with_it() {
    for (seed, sizes) in [[3, 1, 1], [4, 2, 2]].into_iter().enumerate() {
        let with = system(10 + seed as u64, sizes, true, true);
        let without = SampledLinear { k: None, ..with.clone() };
        for window in [Window::past(12), Window::past(12).with_current()] {
            let names = names(sizes[0]);
            let [k, plain] =
                [&with, &without].map(|s| Reconstruction::of(s, window, &names).unwrap());
            let quiet = run(&with, 60, 5, 0.0);
            assert!(off(&k, window, &quiet) < 1e-10);
            // innovations of size 1: the mean square error, over many samples
            let course = run(&with, 4000, 6, 1.0);
            let (k, plain) =
                (mean_square(&k, window, &course), mean_square(&plain, window, &course));
            assert!(k < 0.9 * plain, "with K {k}, without {plain}");
        }
    }
}

fn mean_square(found: &Reconstruction, window: Window, course: &Course) -> f64 {
    let y: Vec<&[f64]> = course.y.iter().map(|y| &y[..]).collect();
    let u: Vec<&[f64]> = course.u.iter().map(|u| &u[..]).collect();
    let ks = window.starts(&[0..course.x.len()], &y, 1);
    let each = ks.iter().map(|&k| {
        let vector = DVector::from_vec(window.gather(&y, &u, &[k]));
        (&found.map.weights * vector + &found.map.bias - &course.x[k]).norm_squared()
    });
    each.sum::<f64>() / ks.len() as f64
}

#[test]
fn states_that_outputs_do_not_show_are_named() {
    // x3 drives nothing that is measured; x4 and x5 show only as their sum
    let mut s = system(8, [5, 1, 1], false, false);
    s.a = DMatrix::from_diagonal(&nalgebra::dvector![0.9, 0.5, 0.3, 0.7, 0.7]);
    s.c = nalgebra::dmatrix![1.0, 1.0, 0.0, 1.0, 1.0];
    let names: Vec<String> = ["a", "b", "alone", "one", "other"].map(String::from).to_vec();
    let error = Reconstruction::of(&s, Window::past(9), &names).unwrap_err();
    let EncoderError::Unobservable { hidden, rank, states, samples } = &error else {
        panic!("{error}")
    };
    assert_eq!(hidden, &["alone", "one", "other"]);
    assert_eq!((*rank, *states, *samples), (3, 5, 9));
    assert!(error.to_string().contains("not `alone`, `one` and `other`"), "{error}");
    // too short a window is told apart by its hint
    let s = system(8, [5, 1, 1], false, false);
    let error = Reconstruction::of(&s, Window::past(3), &names).unwrap_err();
    let hint = lacuna::fault::Explain::hint(&error).unwrap();
    assert!(hint.contains("at least 5"), "{hint}");
}

fn duffing(hardening: f64) -> System {
    let model = Duffing { mass: 0.7, damping: 0.9, stiffness: 40.0, hardening, fixed: vec![] };
    let integrator = Integrator { method: Method::Rk4, substeps: 5 };
    System::new(model, Sampling { integrator, ..Sampling::default() })
}

#[test]
fn slopes_of_the_sampled_map_are_exact() {
    // against the integrator written out, far from an equilibrium
    let system = duffing(300.0);
    let about = About::Point { x: vec![0.3, -1.0], u: vec![2.0] };
    let found = SampledLinear::about(&system, 0.05, &about, &[]).unwrap();
    // affine: it meets the nonlinear map at the point itself
    let x = nalgebra::dvector![0.3, -1.0];
    let there = &found.a * &x + &found.b * 2.0 + &found.f;
    let by_hand = rk4([0.3, -1.0], 2.0, 300.0);
    assert!((there[0] - by_hand[0]).abs() < 1e-13 && (there[1] - by_hand[1]).abs() < 1e-12);
    for i in 0..2 {
        let moved = |by: f64| {
            let mut x = [0.3, -1.0];
            x[i] += by;
            rk4(x, 2.0, 300.0)
        };
        let h = 1e-3;
        for row in 0..2 {
            let slope = (8.0 * (moved(h)[row] - moved(-h)[row]) - moved(2.0 * h)[row]
                + moved(-2.0 * h)[row])
                / (12.0 * h);
            assert!((slope - found.a[(row, i)]).abs() < 1e-9, "{slope} {}", found.a[(row, i)]);
        }
    }
}

/// One sample of the Duffing system in the letters of the textbook.
fn rk4([p, v]: [f64; 2], u: f64, hardening: f64) -> [f64; 2] {
    let rate = |[p, v]: [f64; 2]| [v, (u - 0.9 * v - (40.0 + hardening * p * p) * p) / 0.7];
    let (mut x, h) = ([p, v], 0.01);
    for _ in 0..5 {
        let along = |k: [f64; 2], by: f64| [x[0] + by * k[0], x[1] + by * k[1]];
        let k1 = rate(x);
        let k2 = rate(along(k1, 0.5 * h));
        let k3 = rate(along(k2, 0.5 * h));
        let k4 = rate(along(k3, h));
        x = [0, 1].map(|i| x[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
    }
    x
}

#[test]
fn the_equilibrium_of_given_inputs_is_found() {
    let system = duffing(300.0);
    let at = About::EquilibriumAt { u: vec![5.0] };
    let found = SampledLinear::about(&system, 0.05, &at, &[]).unwrap();
    // k p + a p^3 = 5
    let mut p: f64 = 0.1;
    for _ in 0..50 {
        p -= (40.0 * p + 300.0 * p.powi(3) - 5.0) / (40.0 + 900.0 * p * p);
    }
    let x = nalgebra::dvector![p, 0.0];
    let next = &found.a * &x + &found.b * 5.0 + &found.f;
    assert!((next - x).amax() < 1e-12);
}
