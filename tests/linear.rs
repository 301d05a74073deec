//! Linear models from records alone: random systems found back, their orders, records of real
//! machines.

use std::path::{Path, PathBuf};

use lacuna::data::{Random, Record};
use lacuna::estimate::{LinearEstimate, linear};
use lacuna::evaluate::{Init, Simulation};
use lacuna::fault::{Explain, render};
use nalgebra::{DMatrix, DVector};

mod accuracy;
mod gaps;
mod orders;
mod real_records;
mod refusals;

/// x_{k+1} = A x_k + B u_k, y_k = C x_k + D u_k.
struct Truth {
    a: DMatrix<f64>,
    b: DMatrix<f64>,
    c: DMatrix<f64>,
    d: DMatrix<f64>,
}

/// Noise on the outputs: how large against each output's spread, and the pole of its filter.
#[derive(Clone, Copy)]
struct Noise {
    share: f64,
    pole: f64,
}

impl Truth {
    /// Poles between 0.2 and 0.95, or pairs of modulus 0.6 to 0.97, every state with at least a
    /// twentieth of the largest Hankel singular value.
    fn random(random: &mut Random, order: usize, nu: usize, ny: usize) -> Self {
        loop {
            let mut a = DMatrix::zeros(order, order);
            let mut k = 0;
            while k < order {
                if order - k >= 2 && random.uniform() < 0.6 {
                    let size = 0.6 + 0.37 * random.uniform();
                    let (sin, cos) = (0.1 + 2.5 * random.uniform()).sin_cos();
                    let block = [[cos, sin], [-sin, cos]];
                    for i in 0..4 {
                        a[(k + i / 2, k + i % 2)] = size * block[i / 2][i % 2];
                    }
                    k += 2;
                } else {
                    a[(k, k)] = 0.2 + 0.75 * random.uniform();
                    k += 1;
                }
            }
            let mut normal =
                |rows, columns| DMatrix::from_fn(rows, columns, |_, _| random.normal());
            let truth =
                Self { b: normal(order, nu), c: normal(ny, order), d: DMatrix::zeros(ny, nu), a };
            let sizes = truth.hankel();
            if sizes.first() <= sizes.last().map(|last| 20.0 * last).as_ref() {
                return truth;
            }
        }
    }

    /// Hankel singular values, largest first.
    fn hankel(&self) -> Vec<f64> {
        let sum = |a: &DMatrix<f64>, q: DMatrix<f64>| {
            let (mut sum, mut power) = (q, a.clone());
            for _ in 0..12 {
                sum += &power * &sum * power.transpose();
                power = &power * &power;
            }
            sum
        };
        let reach = sum(&self.a, &self.b * self.b.transpose());
        let sight = sum(&self.a.transpose(), self.c.tr_mul(&self.c));
        let Some(root) = reach.cholesky().map(|c| c.l()) else { return vec![0.0, 1.0] };
        let squares = (root.tr_mul(&sight) * root).symmetric_eigen().eigenvalues;
        let mut sizes: Vec<f64> = squares.iter().map(|v| v.max(0.0).sqrt()).collect();
        sizes.sort_by(|a, b| b.total_cmp(a));
        sizes
    }

    fn impulse(&self, k: usize) -> DMatrix<f64> {
        match k {
            0 => self.d.clone(),
            _ => &self.c * self.a.pow(k as u32 - 1) * &self.b,
        }
    }

    /// A record of the system: inputs filtered by `lowpass`, from a random state.
    fn record(&self, random: &mut Random, samples: usize, lowpass: f64, noise: Noise) -> Record {
        let (nu, ny) = (self.b.ncols(), self.c.nrows());
        let mut filtered = |pole: f64| -> Vec<f64> {
            let mut value = 0.0;
            let mut one = || {
                value = pole * value + random.normal();
                value
            };
            (0..samples).map(|_| one()).collect()
        };
        let u: Vec<Vec<f64>> = (0..nu).map(|_| filtered(lowpass)).collect();
        let mut noises: Vec<Vec<f64>> = (0..ny).map(|_| filtered(noise.pole)).collect();
        let mut x = DVector::from_fn(self.a.nrows(), |_, _| random.normal());
        let mut y = vec![vec![]; ny];
        for k in 0..samples {
            let now = DVector::from_fn(nu, |j, _| u[j][k]);
            let out = &self.c * &x + &self.d * &now;
            for (y, out) in y.iter_mut().zip(out.iter()) {
                y.push(*out);
            }
            x = &self.a * x + &self.b * now;
        }
        let size = |v: &[f64]| (v.iter().map(|v| v * v).sum::<f64>() / v.len() as f64).sqrt();
        let mut record = Record::new(0.1);
        for (j, u) in u.into_iter().enumerate() {
            record = record.input(&format!("u{}", j + 1), u).unwrap();
        }
        for (i, (mut y, e)) in y.into_iter().zip(noises.iter_mut()).enumerate() {
            let by = noise.share * size(&y) / size(e);
            y.iter_mut().zip(e.iter()).for_each(|(y, e)| *y += by * e);
            record = record.output(&format!("y{}", i + 1), y).unwrap();
        }
        record
    }

    /// Error of a model's impulse response over 200 samples, as a share of this one's.
    fn off(&self, found: &LinearEstimate) -> f64 {
        let other = matrices(found);
        let (mut off, mut all) = (0.0, 0.0);
        for k in 0..200 {
            let own = self.impulse(k);
            off += (other.impulse(k) - &own).norm_squared();
            all += own.norm_squared();
        }
        (off / all).sqrt()
    }
}

/// The matrices of a model, as its file states them.
fn matrices(found: &LinearEstimate) -> Truth {
    let text = lacuna::file::to_json(&found.system).unwrap();
    let tree: serde_json::Value = serde_json::from_str(&text).unwrap();
    let lti = &tree["model"]["lti"];
    let table = |key: &str, rows: usize, columns: usize| {
        DMatrix::from_fn(rows, columns, |i, j| lti[key][i][j].as_f64().unwrap_or(0.0))
    };
    let count = |key: &str| lti[key].as_array().unwrap().len();
    let (n, ny, nu) = (count("A"), count("C"), lti["B"][0].as_array().unwrap().len());
    Truth { a: table("A", n, n), b: table("B", n, nu), c: table("C", ny, n), d: table("D", ny, nu) }
}

/// RMSE of each output on a record, by the simulation that every command uses.
fn rmse(found: &LinearEstimate, record: &Record, init: usize) -> Vec<f64> {
    let run = Simulation::of(&found.system, record, Init::Samples(init)).unwrap();
    run.metrics.iter().map(|(_, metrics)| metrics.rmse).collect()
}

/// A folder of measured records beside the project.
fn measured(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data").join(name)
}
