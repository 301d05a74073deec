//! Noise models that compete on the same data by the same criterion.
//!
//! A predictor with noise inside the plant, or a free run whose error is coloured noise: the special
//! case without noise inside the plant (Ljung, "System Identification", 2nd ed., section 4.2: output
//! error with coloured noise). Compared by log L - (numbers) / 2 ln(samples) (Schwarz, Annals of
//! Statistics 6, 1978); the initial states are integrated over the same Gaussian prior in both.

use nalgebra::{DMatrix, DVector};

use super::error::LikelihoodError;
use super::follow::{Start, Wanted};
use super::noise::Noise;
use super::output_noise::OutputNoise;
use super::parametrised::Model;
use super::path::Path;
use super::predictor::{Predictor, column};

/// Renewals of the initial states of a free run at most.
const STARTS: usize = 8;

/// Where the noise is.
#[derive(Debug, Clone, PartialEq)]
pub enum NoiseModel {
    /// Inside the plant and at its sensors: the innovations of a predictor.
    Predictor(Noise),
    /// At the outputs alone: the error of a free run is coloured, noise of its own per output.
    FreeRun(Vec<OutputNoise>),
}

/// A noise model fitted to records.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitted {
    /// The noise model.
    pub noise: NoiseModel,
    /// Log density of all measured outputs.
    pub log_likelihood: f64,
    /// Numbers that were estimated for the noise.
    pub numbers: usize,
    /// Measured outputs, each sample of each counted.
    pub samples: usize,
    /// Output and sample of every isolated innovation that moved nothing.
    pub outliers: Vec<(usize, usize)>,
}

impl Fitted {
    /// log L - (numbers) / 2 ln(samples): the larger the better.
    pub fn criterion(&self) -> f64 {
        self.log_likelihood - 0.5 * self.numbers as f64 * (self.samples as f64).ln()
    }
}

impl Predictor {
    /// The noise that the data call for, inside the plant and at its sensors.
    ///
    /// # Errors
    ///
    /// [`LikelihoodError::Diverges`] if no noise keeps the predictor among the finite numbers.
    pub fn fit_noise(&self) -> Result<Fitted, LikelihoodError> {
        let chosen = self.choose(&self.model)?;
        Ok(Fitted {
            numbers: chosen.noise.count(),
            log_likelihood: chosen.log_likelihood,
            samples: self.observed() as usize,
            outliers: chosen.run.outliers,
            noise: NoiseModel::Predictor(chosen.noise),
        })
    }

    /// A free run with coloured error, its initial states estimated.
    ///
    /// # Errors
    ///
    /// [`LikelihoodError::Diverges`] if the free run leaves the finite numbers.
    pub fn fit_free_run(&self) -> Result<Fitted, LikelihoodError> {
        let mut start = Start { x: self.start.x.clone(), p0: vec![0.0; self.start.p0.len()] };
        start.x.resize(self.drive.segments.len(), self.start.x[0].clone());
        let mut best = self.free_run(&self.model, &start)?;
        for _ in 0..STARTS {
            let moved = self.moved(&best);
            let Ok(next) = self.free_run(&self.model, &moved) else { break };
            let gained = next.value - best.value;
            if gained > 0.0 {
                best = next;
            }
            if !(gained > 0.01) {
                break;
            }
        }
        let numbers = best.noises.iter().map(OutputNoise::numbers).sum();
        Ok(Fitted {
            noise: NoiseModel::FreeRun(best.noises),
            log_likelihood: best.value,
            numbers,
            samples: self.observed() as usize,
            outliers: vec![],
        })
    }

    /// Both noise models, the better by the criterion first. A free run that diverges is left out.
    ///
    /// # Errors
    ///
    /// As [`Predictor::fit_noise`].
    pub fn compete(&self) -> Result<Vec<Fitted>, LikelihoodError> {
        let mut all = vec![self.fit_noise()?];
        all.extend(self.fit_free_run());
        all.sort_by(|a, b| b.criterion().total_cmp(&a.criterion()));
        Ok(all)
    }

    fn free_run(&self, model: &Model, start: &Start) -> Result<FreeRun, LikelihoodError> {
        let noise = self.white(self.spread.iter().map(|s| s * s + f64::MIN_POSITIVE).collect());
        let run = self.run_from(model, start, &noise, Wanted::default())?;
        if let Some(sample) = run.diverged_at {
            let time = sample as f64 * model.plan.sampling_time;
            return Err(LikelihoodError::Diverges { sample, time });
        }
        let ny = run.path.outputs;
        let errors: Vec<Vec<f64>> = (0..ny).map(|o| column(&run.path.e, ny, o)).collect();
        let noises: Vec<_> = errors.iter().map(|e| OutputNoise::of(e)).collect();
        let fit: f64 = noises.iter().zip(&errors).map(|(p, e)| p.log_density(e)).sum();
        let mut found =
            FreeRun { path: run.path, start: start.clone(), noises, errors, value: fit };
        found.value -= self.start_cost(&found);
        Ok(found)
    }

    /// What the initial states cost: prior and width of their posterior (Laplace), per segment.
    fn start_cost(&self, run: &FreeRun) -> f64 {
        (0..run.path.segments.len())
            .map(|s| {
                let (square, _) = run.normal(s, &self.start.p0);
                let n = self.start.p0.len();
                let width = (DMatrix::identity(n, n) + square).determinant().ln();
                let off = self.off(run, s);
                0.5 * (width + off.norm_squared())
            })
            .sum()
    }

    /// Initial states less their expectation, in units of their prior deviations.
    fn off(&self, run: &FreeRun, segment: usize) -> DVector<f64> {
        let expected = self.start.x.get(segment).unwrap_or(&self.start.x[0]);
        let x = &run.start.x[segment];
        let p0 = &self.start.p0;
        DVector::from_fn(p0.len(), |i, _| (x[i] - expected[i]) / p0[i].sqrt())
    }

    /// The most likely initial states on the linearisation about a free run.
    fn moved(&self, run: &FreeRun) -> Start {
        let mut start = run.start.clone();
        let n = self.start.p0.len();
        for s in 0..run.path.segments.len() {
            let (square, slope) = run.normal(s, &self.start.p0);
            let slope = slope - self.off(run, s);
            let Some(step) = (DMatrix::identity(n, n) + square).lu().solve(&slope) else {
                continue;
            };
            for i in 0..n {
                start.x[s][i] += step[i] * self.start.p0[i].sqrt();
            }
        }
        start
    }
}

/// A free run, its errors and their noises.
struct FreeRun {
    path: Path,
    start: Start,
    noises: Vec<OutputNoise>,
    errors: Vec<Vec<f64>>,
    value: f64,
}

impl FreeRun {
    /// Normal equations of a segment's initial states, in units of their prior deviations.
    fn normal(&self, segment: usize, p0: &[f64]) -> (DMatrix<f64>, DVector<f64>) {
        let (n, nx, ny) = (self.path.n, p0.len(), self.path.outputs);
        let range = self.path.segments[segment].clone();
        // columns of the outputs along the initial states
        let mut d = DMatrix::from_fn(n, nx, |i, j| if i == j { p0[j].sqrt() } else { 0.0 });
        let mut columns = vec![vec![f64::NAN; range.len()]; ny * nx];
        for (at, k) in range.clone().enumerate() {
            for o in 0..ny {
                if self.path.e[k * ny + o].is_finite() {
                    let c = DMatrix::from_row_slice(1, n, self.path.c(k, o)) * &d;
                    (0..nx).for_each(|j| columns[o * nx + j][at] = c[(0, j)]);
                }
            }
            d = DMatrix::from_row_slice(n, n, self.path.a(k)) * d;
        }
        let (mut square, mut slope) = (DMatrix::zeros(nx, nx), DVector::zeros(nx));
        for o in 0..ny {
            let noise = &self.noises[o];
            let white = |series: &[f64]| noise.whitened(series);
            let e = white(&self.errors[o][range.clone()]);
            let own: Vec<Vec<f64>> = (0..nx).map(|j| white(&columns[o * nx + j])).collect();
            let dot = |a: &[f64], b: &[f64]| -> f64 {
                let products = a.iter().zip(b).map(|(a, b)| a * b);
                products.filter(|p| p.is_finite()).sum::<f64>()
            };
            for i in 0..nx {
                slope[i] += dot(&own[i], &e);
                for j in 0..nx {
                    square[(i, j)] += dot(&own[i], &own[j]);
                }
            }
        }
        (square, slope)
    }
}
