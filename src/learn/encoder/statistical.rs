//! Statistical linearisation: the linear model with the least mean square error along a record.
//!
//! ```text
//! min E |f(z) - f0 - J (z - z0)|^2   over f0 and J:   J = E[f(z) (z - z0)'] E[(z - z0) (z - z0)']^-1
//! ```
//!
//! with z = [x; u] along the baseline's simulation and z0 its mean (Booton, IRE Trans. Circuit Theory
//! 1, 1954; Roberts and Spanos, *Random Vibration and Statistical Linearization*, 1990, ch. 5). For
//! normal z it is the mean slope, J = E\[df/dz\] (Bussgang 1952); of dry friction of level F at a speed
//! of deviation s it makes a damper of F sqrt(2/pi)/s, where the slope at rest is F over a width.
//! Directions that the record does not move along keep the slopes at z0. A linear f is met exactly.

use nalgebra::{DMatrix, DVector};

use super::baseline::Examples;
use super::initialise::solve_within;
use super::sampled::{Lead, SampledLinear};
use super::slopes::{Map, Slopes, There, ramps};
use super::{About, Baseline, EncoderError};

/// Share of the largest variance, signals over their spreads, below which a record does not move
/// along a direction: the square root of the rounding error.
const MOVED: f64 = 1e-8;

impl Baseline<'_> {
    /// The baseline, sampled and linear as its simulation along the record has it.
    ///
    /// # Errors
    ///
    /// If it diverges, has no finite slope at its mean, or the record has too few samples.
    pub(crate) fn linear_along(&self) -> Result<Lead, EncoderError> {
        let (system, plan) = (self.system, self.plan());
        if let Some(exact) = SampledLinear::exactly(system, plan) {
            return Ok(exact);
        }
        let scaling = self.scaling()?;
        let (n, nu) = (plan.sizes.x, plan.sizes.u);
        let known = scaling.states[..n].iter().chain(&scaling.inputs);
        let scales: Vec<f64> = known.map(|spread| spread.scale).collect();
        let offsets = |spreads: &[super::Spread]| spreads.iter().map(|s| s.offset).collect();
        let about = About::Point { x: offsets(&scaling.states[..n]), u: offsets(&scaling.inputs) };
        let There { x, u, next, output } = Map::new(system, plan, &scales).there(&about)?;
        let pairs = Pairs::of(self, n, nu, ramps(system, plan))?;
        let middle: Vec<f64> = x.iter().chain(&u).copied().collect();
        let (a, b, ahead, f) = pairs.meet(next, &middle, n, &pairs.next);
        let (c, d, _, h) = pairs.meet(output, &middle, n, &pairs.outputs);
        let linear =
            SampledLinear { a, b: b.clone(), f, c, d, h, k: system.model.innovation_gain() };
        Ok(match ahead {
            Some(ahead) => Lead::of(linear, &b, ahead),
            None => Lead::none(linear),
        })
    }
}

/// Samples of a simulation with the ones after them: rows of states, inputs now and, where they move
/// along lines, inputs next; one column per sample.
struct Pairs {
    rows: Vec<Vec<f64>>,
    /// States one sample later.
    next: Vec<Vec<f64>>,
    outputs: Vec<Vec<f64>>,
}

impl Pairs {
    fn of(baseline: &Baseline<'_>, n: usize, nu: usize, ramps: bool) -> Result<Self, EncoderError> {
        let course = baseline.simulate()?;
        let (inputs, segments) = baseline.driven();
        let ks: Vec<usize> = segments.iter().flat_map(|s| s.start..s.end.max(1) - 1).collect();
        let needed = 2 * (n + nu * (1 + usize::from(ramps)) + 1);
        if ks.len() < needed {
            let (record, windows) = (baseline.record.source.clone(), ks.len());
            return Err(EncoderError::TooShort { record, windows, reach: 1, needed });
        }
        let at = |series: &[Vec<f64>], later: usize| -> Vec<Vec<f64>> {
            series.iter().map(|s| ks.iter().map(|&k| s[k + later]).collect()).collect()
        };
        let mut rows = [at(&course.states, 0), at(inputs, 0)].concat();
        if ramps {
            rows.extend(at(inputs, 1));
        }
        Ok(Self { rows, next: at(&course.states, 1), outputs: at(&course.outputs, 0) })
    }

    /// Slopes at a point, and what least squares adds to them: along states, along inputs now and
    /// next, and the constant part.
    fn meet(&self, at: Slopes, middle: &[f64], n: usize, targets: &[Vec<f64>]) -> Met {
        let nu = middle.len() - n;
        let mut slopes = DMatrix::zeros(at.value.len(), n + at.along_u.ncols());
        slopes.columns_mut(0, n).copy_from(&at.along_x);
        slopes.columns_mut(n, at.along_u.ncols()).copy_from(&at.along_u);
        // inputs next have the same middle as inputs now
        let mut about = DVector::from_column_slice(middle);
        if at.along_u.ncols() > nu {
            about = DVector::from_iterator(n + 2 * nu, middle.iter().chain(&middle[n..]).copied());
        }
        let rows = &self.rows[..slopes.ncols()];
        let mut constant = &at.value - &slopes * &about;
        let samples = rows.first().map_or(0, Vec::len);
        let rest = targets.iter().enumerate().flat_map(|(i, target)| {
            let (slopes, constant) = (&slopes, constant[i]);
            (0..samples).map(move |k| {
                let linear: f64 = rows.iter().enumerate().map(|(j, r)| slopes[(i, j)] * r[k]).sum();
                target[k] - constant - linear
            })
        });
        let examples = Examples { states: rest.collect(), windows: rows.concat(), samples };
        let more = solve_within(&examples, MOVED).map;
        slopes += more.weights;
        constant += more.bias;
        let along = |from: usize, count: usize| slopes.columns(from, count).into_owned();
        let ahead = (slopes.ncols() > n + nu).then(|| along(n + nu, nu));
        (along(0, n), along(n, nu), ahead, constant)
    }
}

/// A, B, what leads, and the constant part.
type Met = (DMatrix<f64>, DMatrix<f64>, Option<DMatrix<f64>>, DVector<f64>);
