//! The likelihood against closed forms: the multivariate normal density, its slopes by differences.

use nalgebra::{DMatrix, DVector};

use super::plants::{GANTRY, OSCILLATOR, Sizes, excitation, simulate, system};
use crate::Predictor;
use crate::layout::Layout;
use crate::noise::{Component, Noise, Slow};
use crate::path::Path;
use crate::replay::Pass;

/// Mean and covariance of all augmented states (first) and outputs of a frozen path, by writing
/// every sample as a linear function of the independent noises.
pub fn joint(path: &Path, noise: &Noise) -> (DVector<f64>, DMatrix<f64>) {
    let layout = Layout::of(path, noise);
    let (na, n, ny, nf) = (layout.len(), path.n, path.outputs, path.forces);
    let len = path.len;
    let sources = na + len * (nf + na - n + ny);
    // a column of 1 carries the mean
    let mut x = DMatrix::<f64>::zeros(na, sources + 1);
    let mut rows = DMatrix::<f64>::zeros(len * (na + ny), sources + 1);
    for i in 0..n {
        x[(i, i)] = path.p0[i].sqrt();
    }
    for (i, part) in layout.parts(noise) {
        x[(i, i)] = (part.variance * part.start()).sqrt();
    }
    let mut next = na;
    for k in 0..len {
        rows.rows_mut(k * na, na).copy_from(&x);
        for o in 0..ny {
            let mut row = vec![0.0; na];
            layout.row(path.rows(k, o), o, &mut row);
            let mut y = DMatrix::from_row_slice(1, na, &row) * &x;
            y[(0, next)] += noise.measurement[o].sqrt();
            next += 1;
            rows.rows_mut(len * na + k * ny + o, 1).copy_from(&y);
        }
        let mut f = DMatrix::<f64>::zeros(na, na);
        for i in 0..n {
            for j in 0..n {
                f[(i, j)] = path.a(k)[i * n + j];
            }
            for (l, &c) in layout.forces.iter().enumerate() {
                f[(i, n + l)] = path.g(k)[i * nf + c];
            }
        }
        for (i, part) in layout.parts(noise) {
            f[(i, i)] = part.pole * part.turn.cos();
        }
        for (i, j, over) in layout.turns(noise) {
            (f[(i, j)], f[(j, i)]) = (over, -over);
        }
        for i in 0..n {
            x[(i, sources)] -= path.jump[k * n + i];
        }
        x = f * x;
        for i in 0..n {
            for c in 0..nf {
                x[(i, sources)] -= path.g(k)[i * nf + c] * path.force[k * nf + c];
            }
        }
        for c in (0..nf).filter(|_| layout.lets_white_in()) {
            for i in 0..n {
                x[(i, next)] += path.g(k)[i * nf + c] * noise.white[c].sqrt();
            }
            next += 1;
        }
        for (i, part) in layout.parts(noise) {
            x[(i, next)] += part.variance.sqrt();
            next += 1;
        }
    }
    let mean = rows.column(sources).into_owned();
    let rows = rows.columns(0, sources).into_owned();
    (mean, &rows * rows.transpose())
}

/// All kinds of noise at once on a path of a plant that is not linear.
pub fn noisy(len: usize) -> (Path, Noise) {
    let system = system(GANTRY);
    let sizes = Sizes {
        white: vec![2.0, 0.0, 1.0],
        measurement: vec![0.01, 0.02],
        wander: vec![0.0, 0.005],
        slow: vec![0.0, 0.1],
        ..Sizes::default()
    };
    let record = simulate(&system, &excitation(len, 0.02, 20.0, 2), &sizes, 3);
    let predictor = Predictor::new(&system, &[record]).unwrap();
    let mut noise = predictor.white(vec![1e-4, 4e-4]);
    noise.white = vec![4.0, 0.0, 1.0];
    noise.slow[0] = Slow { variance: 0.05, pole: 0.95, turn: 0.4 };
    noise.slow[1] = Slow::walk(0.01);
    noise.wander[1] = Slow::fading(2e-5, 0.9);
    let mut path = predictor.run(&predictor.model, &noise, Default::default()).unwrap().path;
    path.e[7] = f64::NAN; // one that was not measured
    (path, noise)
}

/// Asserts that the likelihood of a path is the multivariate normal density.
pub fn is_the_normal_density((path, noise): (Path, Noise)) {
    let (mean, covariance) = joint(&path, &noise);
    let states = path.len * Layout::of(&path, &noise).len();
    let kept: Vec<usize> = (0..path.e.len()).filter(|&i| path.e[i].is_finite()).collect();
    let part = DMatrix::from_fn(kept.len(), kept.len(), |i, j| {
        covariance[(states + kept[i], states + kept[j])]
    });
    let off = DVector::from_fn(kept.len(), |i, _| path.e[kept[i]] - mean[states + kept[i]]);
    let root = part.cholesky().unwrap();
    let whitened = root.l().solve_lower_triangular(&off).unwrap();
    let determinant: f64 = root.l().diagonal().iter().map(|d| 2.0 * d.ln()).sum();
    let n = kept.len() as f64;
    let exact = -0.5 * (n * std::f64::consts::TAU.ln() + determinant + whitened.norm_squared());
    let pass = Pass::of(&path, &noise, false);
    assert!(
        (pass.log_likelihood - exact).abs() < 1e-7 * exact.abs(),
        "{} {exact}",
        pass.log_likelihood
    );
    // sequential innovations are those of the Cholesky factor
    for (at, white) in kept.iter().zip(whitened.iter()) {
        assert!((pass.z[*at] - white).abs() < 1e-6, "{} {white}", pass.z[*at]);
    }
}

#[test]
fn the_likelihood_is_the_multivariate_normal_density() {
    is_the_normal_density(noisy(14));
}

#[test]
fn the_filter_and_its_replay_agree() {
    let system = system(GANTRY);
    let sizes = Sizes { white: vec![2.0], measurement: vec![0.01, 0.02], ..Sizes::default() };
    let record = simulate(&system, &excitation(200, 0.02, 20.0, 2), &sizes, 3);
    let predictor = Predictor::new(&system, &[record]).unwrap();
    let mut noise = predictor.white(vec![1e-4, 4e-4]);
    noise.white[0] = 4.0;
    noise.slow[1] = Slow { variance: 1e-3, pole: 0.98, turn: 0.2 };
    noise.wander[0] = Slow::walk(1e-7);
    let run = predictor.run(&predictor.model, &noise, Default::default()).unwrap();
    let pass = Pass::of(&run.path, &noise, false);
    let off = (run.log_likelihood - pass.log_likelihood).abs();
    assert!(
        off < 1e-7 * run.log_likelihood.abs(),
        "{} {}",
        run.log_likelihood,
        pass.log_likelihood
    );
}

/// The textbook's filter of a linear system, written out with matrices.
#[test]
fn a_linear_plant_gets_the_kalman_filter() {
    let system = system(OSCILLATOR);
    let sizes = Sizes { white: vec![0.5], measurement: vec![0.02], ..Sizes::default() };
    let record = simulate(&system, &excitation(400, 0.05, 1.0, 5), &sizes, 7);
    let predictor = Predictor::new(&system, std::slice::from_ref(&record)).unwrap();
    let mut noise = predictor.white(vec![4e-4]);
    noise.white[0] = 0.25;
    let run = predictor.run(&predictor.model, &noise, Default::default()).unwrap();
    // x[k+1] = A x + b u + g w, exactly or by the classical Runge-Kutta step, which is linear too
    let (a, b) = (run.path.a(0), run.path.g(0));
    let a = DMatrix::from_row_slice(2, 2, a);
    let (g, b) = (DVector::from_vec(vec![b[0], b[2]]), DVector::from_vec(vec![b[1], b[3]]));
    let c = DMatrix::from_row_slice(1, 2, &[1.0, 0.0]);
    let mut x = DVector::from_vec(predictor.start.x[0].clone());
    let mut p = DMatrix::from_diagonal(&DVector::from_vec(predictor.start.p0.clone()));
    let mut exact = 0.0;
    for k in 0..400 {
        let e = record.outputs[0].values[k] - x[0];
        let s = (&c * &p * c.transpose())[(0, 0)] + 4e-4;
        exact -= 0.5 * ((std::f64::consts::TAU * s).ln() + e * e / s);
        let gain = &p * c.transpose() / s;
        x += &gain * e;
        p -= &gain * &c * &p;
        x = &a * x + &b * record.inputs[0].values[k];
        p = &a * p * a.transpose() + 0.25 * &g * g.transpose();
    }
    assert!(
        (run.log_likelihood - exact).abs() < 1e-8 * exact.abs(),
        "{} {exact}",
        run.log_likelihood
    );
}

/// What the likelihood of a path does along the variance of each component of its noise.
pub struct Sloped {
    pub component: Component,
    pub variance: f64,
    /// By the score, and by a central difference.
    pub slope: f64,
    pub difference: f64,
}

/// The slopes of a path's likelihood, with differences over this share of each variance.
pub fn sloped((path, noise): &(Path, Noise), share: f64) -> Vec<Sloped> {
    let along = noise.components();
    let mut pass = Pass::new(path, Layout::of(path, noise), false);
    pass.forward(path, noise);
    let mut slopes = vec![0.0; along.len()];
    pass.gradient(path, noise, &along, &mut slopes);
    let one = |(component, slope): (Component, f64)| {
        let variance = noise.variance(component);
        let mut at = |factor: f64| {
            let mut moved = noise.clone();
            moved.set(component, variance * factor);
            pass.forward(path, &moved)
        };
        let difference = (at(1.0 + share) - at(1.0 - share)) / (2.0 * share * variance);
        Sloped { component, variance, slope, difference }
    };
    along.into_iter().zip(slopes).map(one).collect()
}

#[test]
fn slopes_of_the_likelihood_are_those_of_differences() {
    let all = sloped(&noisy(60), 1e-4);
    assert_eq!(all.len(), 7);
    for Sloped { component, variance, slope, difference } in all {
        assert!(
            (slope - difference).abs() < 1e-4 * difference.abs().max(1e-3 / variance),
            "{component:?} {slope} {difference}"
        );
    }
}

#[test]
fn an_isolated_spike_moves_nothing_and_is_listed() {
    let system = system(OSCILLATOR);
    let sizes = Sizes { white: vec![0.5], measurement: vec![0.02], ..Sizes::default() };
    let clean = simulate(&system, &excitation(400, 0.05, 1.0, 5), &sizes, 7);
    let mut spiked = clean.clone();
    spiked.outputs[0].values[200] += 5.0;
    let innovations = |record, robust| {
        let predictor = Predictor::new(&system, &[record]).unwrap();
        let mut noise = predictor.white(vec![4e-4]);
        noise.white[0] = 0.25;
        predictor.innovations(&noise, robust).unwrap()
    };
    let (before, gated) = (innovations(clean, true), innovations(spiked.clone(), true));
    assert!(before.outliers.is_empty());
    assert_eq!(gated.outliers, [(0, 200)]);
    let off = (before.values[0][220] - gated.values[0][220]).abs();
    assert!(off < 0.02, "{off}");
    let hit = innovations(spiked, false);
    assert!(hit.log_likelihood < gated.log_likelihood - 100.0);
    assert!((hit.values[0][201]).abs() > 0.1);
}
