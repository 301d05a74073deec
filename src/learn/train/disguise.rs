//! How much of a learned part is parameters in disguise: the share of what it adds that other values
//! of the baseline's parameters would do as well.
//!
//! ```text
//! share = 1 - min_b |d - C b|^2 / |d|^2,   C_j = df_base / dtheta_j along the record
//! ```
//!
//! with states in units of their spreads: the projection on the baseline's sensitivities
//! (orthogonal augmentation, arXiv 2511.01321). What lies in their span is not identified: the
//! parameters could have taken it over.

use nalgebra::{DMatrix, DVector};

use super::TrainError;
use super::added::stepped;
use super::{Augmented, entered::Visited};
use crate::data::Record;
use crate::encoder::Spread;
use crate::lfr::{Block, Interconnection};

/// Step of the differences along a parameter, over its value: the root of the rounding error,
/// cubed, is where central differences are best.
const STEP: f64 = 6e-6;

/// Rounding over the size of a sensitivity beyond which it is no sensitivity.
const BLURRED: f64 = 0.1;
/// Share that is more than 0 %.
const SAID: f64 = 0.005;

/// What a learned part does in the place of parameters.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Disguise {
    /// Share of the mean square of what is added, between 0 and 1.
    pub share: f64,
    /// The change of each parameter that would do the same, in its unit.
    pub changes: Vec<Change>,
}

/// A change of a parameter.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Change {
    /// Its name.
    pub parameter: String,
    /// Its unit.
    pub unit: String,
    /// The value in the model.
    pub value: f64,
    /// What would have to be added to it.
    pub change: f64,
}

impl std::fmt::Display for Disguise {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{:.0} % of what the learned part adds is what other parameters would do",
            100.0 * self.share
        )?;
        // what nothing would do needs no values
        if self.share < SAID {
            return Ok(());
        }
        let mut join = ": ";
        for Change { parameter, unit, value, change } in &self.changes {
            let space = if unit.is_empty() { "" } else { " " };
            write!(
                f,
                "{join}{parameter} {:.4}{space}{unit} instead of {value:.4}",
                value + change
            )?;
            join = ", ";
        }
        Ok(())
    }
}

impl Augmented {
    /// The share of the learned part that is parameters in disguise, along a record; nothing
    /// without a baseline that has parameters, or where nothing is added.
    ///
    /// # Errors
    ///
    /// As [`Augmented::simulate`].
    pub fn disguise(&self, record: &Record) -> Result<Option<Disguise>, TrainError> {
        let place = self.model.blocks.iter().position(|b| matches!(b, Block::Baseline(_)));
        let Some(Block::Baseline(baseline)) = place.map(|p| &self.model.blocks[p]) else {
            return Ok(None);
        };
        let visited = self.visited(record)?;
        let bare = self.bare();
        let scales = scales(&visited);
        let (with, without) = (stepped(&self.model, &visited)?, stepped(&bare, &visited)?);
        let added = spread(&with, &without, &scales);
        let total: f64 = added.iter().map(|d| d * d).sum();
        let (theta, signals) = (baseline.theta(), baseline.system.signals());
        let columns = sensitivities(&bare, &visited, &scales)?;
        let Some(c) = columns.filter(|_| total > 0.0) else { return Ok(None) };
        // parameters that do nothing here, and those that others make up for, change nothing, as far
        // as differences of rounded states can tell
        let rounded =
            f64::EPSILON * DVector::from_vec(spread(&without, &nothing(&without), &scales)).norm();
        let sizes: Vec<f64> = c.column_iter().map(|c| c.norm().max(f64::MIN_POSITIVE)).collect();
        let steps = theta.iter().map(|&value| step(value));
        let noise: Vec<f64> =
            steps.zip(&sizes).map(|(h, size)| rounded / (2.0 * h * size)).collect();
        let unit = DMatrix::from_fn(c.nrows(), c.ncols(), |i, j| match noise[j] < BLURRED {
            true => c[(i, j)] / sizes[j],
            false => 0.0,
        });
        let seen = noise.iter().filter(|noise| **noise < BLURRED);
        let cutoff = 10.0 * seen.map(|noise| noise * noise).sum::<f64>().sqrt();
        let d = DVector::from_vec(added);
        let solved = unit.clone().svd(true, true).solve(&d, cutoff.max(1e-8));
        let Ok(found) = solved else { return Ok(None) };
        let left = (&d - unit * &found).norm_squared();
        let changes = signals.parameters.iter().zip(&theta).zip(found.iter().zip(&sizes));
        let changes = changes.map(|((parameter, &value), (found, size))| Change {
            parameter: parameter.name.clone(),
            unit: parameter.unit.clone(),
            value,
            change: found / size,
        });
        let share = (1.0 - left / total).clamp(0.0, 1.0);
        Ok(Some(Disguise { share, changes: changes.collect() }))
    }
}

/// Next states along the parameters of the baseline, at every sample and state (in units of its
/// spread); nothing without parameters.
pub(super) fn sensitivities(
    bare: &Interconnection,
    visited: &Visited,
    scales: &[f64],
) -> Result<Option<DMatrix<f64>>, TrainError> {
    let place = bare.blocks.iter().position(|block| matches!(block, Block::Baseline(_)));
    let Some((place, Block::Baseline(baseline))) = place.map(|p| (p, &bare.blocks[p])) else {
        return Ok(None);
    };
    let (theta, mut columns) = (baseline.theta(), vec![]);
    for (j, value) in theta.iter().enumerate() {
        let step = step(*value);
        let at = |to: f64| stepped(&changed(bare, place, &theta, j, to), visited);
        let (above, below) = (at(value + step)?, at(value - step)?);
        columns.push(DVector::from_vec(spread(&above, &below, scales)) / (2.0 * step));
    }
    Ok((!columns.is_empty()).then(|| DMatrix::from_columns(&columns)))
}

/// Step of the differences along a parameter of this value.
fn step(value: f64) -> f64 {
    STEP * if value == 0.0 { 1.0 } else { value.abs() }
}

/// The same steps, with all states at 0.
fn nothing(of: &[[Vec<f64>; 2]]) -> Vec<[Vec<f64>; 2]> {
    of.iter().map(|pair| pair.clone().map(|states| vec![0.0; states.len()])).collect()
}

/// How far next states are apart, sample by sample and state by state.
fn spread(a: &[[Vec<f64>; 2]], b: &[[Vec<f64>; 2]], scales: &[f64]) -> Vec<f64> {
    let pairs = a.iter().zip(b).flat_map(|(a, b)| a[0].iter().zip(&b[0]));
    pairs.zip(scales.iter().cycle()).map(|((a, b), scale)| (a - b) / scale).collect()
}

/// A model with one parameter of its baseline changed.
fn changed(
    model: &Interconnection,
    place: usize,
    theta: &[f64],
    which: usize,
    to: f64,
) -> Interconnection {
    let mut model = model.clone();
    if let Some(Block::Baseline(baseline)) = model.blocks.get_mut(place) {
        let mut theta = theta.to_vec();
        theta[which] = to;
        baseline.theta = Some(theta);
    }
    model
}

/// Spread of every state along the samples.
pub(super) fn scales(visited: &Visited) -> Vec<f64> {
    let states = visited.x.first().map_or(0, Vec::len);
    let series = |i: usize| visited.x.iter().map(|x| x[i]).collect::<Vec<f64>>();
    (0..states).map(|i| Spread::of(&series(i)).scale).collect()
}
