//! What each supposed cause does to the outputs (and to a sensor more), in sizes of the noise.

use std::sync::Arc;

use rayon::prelude::*;

use crate::candidates::candidate::Candidate;
use crate::candidates::probes::Sharing;
use crate::fit::nuisance::{Nuisance, set};
use crate::fit::problem::{Grain, Job, Model, Part, Problem, Span};
use crate::statistics::{add_to_basis, dot, project};
use crate::system::Track;

/// A cause at the parameters and of the size by which its effect is looked at.
#[derive(Debug, Clone)]
pub(super) struct Asked {
    pub cause: Arc<Candidate>,
    pub parameters: Vec<f64>,
    pub blend: f64,
    /// What effects are divided by; `None` where no size shows.
    pub size: Option<f64>,
}

/// Effects per unit of every cause, and what may be imitated by what is not known anyway.
pub(super) struct Look {
    pub columns: Vec<Option<Vec<f64>>>,
    /// Orthonormal effects of initial states, and of these and the free parameters.
    pub trusted: Vec<Vec<f64>>,
    pub free: Vec<Vec<f64>>,
}

/// The same with what cannot be told from initial states (and parameters) taken out.
pub(super) struct Left {
    columns: Vec<Option<Vec<f64>>>,
    /// Sizes of the columns before and after.
    pub before: Vec<f64>,
    pub after: Vec<f64>,
}

/// Share of an effect below which rounding is all that is left of it.
const NOTHING: f64 = 1e-6;

impl Look {
    /// By the outputs.
    pub fn outputs(
        problem: &Problem<'_>,
        start: &Model,
        asked: &[Asked],
        (trusted, free): (&Nuisance, &Nuisance),
    ) -> Option<Self> {
        let base = problem.job(start, Grain::Coarse)?;
        let y0 = problem.run(&[base], Span::Fit).swap_remove(0)?;
        let r0 = problem.residual(&y0, Part::Fit);
        let answers = problem.run_built(&jobs(problem, start, asked), Span::Fit);
        let columns = answers.into_iter().zip(asked).map(|(y, asked)| {
            let r = problem.residual(&y?, Part::Fit);
            unit(r0.iter().zip(&r).map(|(a, b)| a - b), asked.size?)
        });
        Some(Self {
            columns: columns.collect(),
            trusted: trusted.basis(problem, start, &y0),
            free: free.basis(problem, start, &y0),
        })
    }

    /// What is left of the effects on one track.
    pub fn left(&self, basis: &[Vec<f64>]) -> Left {
        let size = |column: &Option<Vec<f64>>| column.as_ref().map_or(0.0, |c| dot(c, c).sqrt());
        let before: Vec<f64> = self.columns.iter().map(size).collect();
        let columns: Vec<Option<Vec<f64>>> = self
            .columns
            .par_iter()
            .map(|column| {
                let mut column = column.clone()?;
                project(basis, &mut column);
                Some(column)
            })
            .collect();
        let after = columns.iter().map(size).zip(&before);
        let after = after.map(|(after, before)| if after > NOTHING * before { after } else { 0.0 });
        Left { after: after.collect(), before, columns }
    }
}

impl Left {
    /// Correlation of two effects, without sign; 1 where nothing is left of either.
    pub fn rho(&self, i: usize, j: usize) -> f64 {
        match (&self.columns[i], &self.columns[j]) {
            (Some(a), Some(b)) if self.after[i] * self.after[j] > 0.0 => {
                (dot(a, b) / (self.after[i] * self.after[j])).abs().min(1.0)
            }
            _ => 1.0,
        }
    }

    /// Square of what tells two effects of given sizes apart, over the noise.
    pub fn separation(&self, i: usize, j: usize, sizes: &[f64]) -> f64 {
        self.strength(i, j, sizes) * (1.0 - self.rho(i, j).powi(2))
    }

    /// Square of the weaker of two effects of given sizes, over the noise.
    pub fn strength(&self, i: usize, j: usize, sizes: &[f64]) -> f64 {
        (sizes[i] * self.after[i]).min(sizes[j] * self.after[j]).powi(2)
    }
}

/// A column per unit, if all of it is finite.
fn unit(change: impl Iterator<Item = f64>, size: f64) -> Option<Vec<f64>> {
    let column: Vec<f64> = change.map(|v| v / size).collect();
    column.iter().all(|v| v.is_finite()).then_some(column)
}

fn jobs(problem: &Problem<'_>, start: &Model, asked: &[Asked]) -> Vec<Option<Job>> {
    let (kinds, grain) = (vec![], Grain::Coarse);
    let mut sharing = Sharing { problem, model: start, kinds, grain, watch: &() };
    let job = |asked: &Asked| {
        asked.size?;
        sharing.job(&asked.cause, &asked.parameters, asked.blend)
    };
    asked.iter().map(job).collect()
}

/// A sensor that the machine does not have yet.
#[derive(Debug, Clone)]
pub(super) struct Sensor {
    pub name: String,
    pub unit: String,
    /// Entry of the source table.
    pub entry: usize,
    /// Its noise.
    pub noise: f64,
}

/// Looks with each of some sensors beside the outputs.
pub(super) fn with_sensors(
    problem: &Problem<'_>,
    start: &Model,
    asked: &[Asked],
    (trusted, free): (&Nuisance, &Nuisance),
    sensors: &[Sensor],
) -> Option<Vec<Look>> {
    let samples: Vec<usize> = problem.samples(Part::Fit).collect();
    let seen = |job: &Job| {
        let track: Track = problem.system.run_seen(&job.plan, &problem.drive, &job.lane);
        track.is_finite().then_some(track)
    };
    let base = seen(&problem.job(start, Grain::Coarse)?)?;
    let r0 = problem.residual(&base.y, Part::Fit);
    // the change of the outputs, then that of each sensor
    let change = |job: &Job| -> Option<Vec<Vec<f64>>> {
        let track = seen(job)?;
        let r = problem.residual(&track.y, Part::Fit);
        let outputs: Vec<f64> = r0.iter().zip(&r).map(|(a, b)| a - b).collect();
        let of = |sensor: &Sensor| {
            let (now, before) = (&track.seen[sensor.entry], &base.seen[sensor.entry]);
            samples.iter().map(|&k| (now[k] - before[k]) / sensor.noise).collect()
        };
        Some(std::iter::once(outputs).chain(sensors.iter().map(of)).collect())
    };
    let effects: Vec<Option<Vec<Vec<f64>>>> =
        jobs(problem, start, asked).par_iter().map(|job| job.as_ref().and_then(&change)).collect();
    let bases = [trusted, free].map(|nuisance| -> Vec<Vec<Vec<f64>>> {
        let moved: Vec<Job> = moved(nuisance, problem, start);
        moved.par_iter().filter_map(&change).collect()
    });
    let stacked = |change: &[Vec<f64>], s: usize| [&change[0][..], &change[s + 1]].concat();
    let looks = (0..sensors.len()).map(|s| {
        let [trusted, free] = [0, 1].map(|i| {
            let mut basis = vec![];
            for change in &bases[i] {
                add_to_basis(&mut basis, stacked(change, s));
            }
            basis
        });
        let columns = effects
            .iter()
            .zip(asked)
            .map(|(change, asked)| unit(stacked(change.as_ref()?, s).into_iter(), asked.size?));
        Look { columns: columns.collect(), trusted, free }
    });
    Some(looks.collect())
}

/// A model moved a little along each thing that is not known.
fn moved(nuisance: &Nuisance, problem: &Problem<'_>, start: &Model) -> Vec<Job> {
    let step = |key| {
        let unknown = nuisance.unknown(problem, start, key);
        let (step, room) = (2e-3 * unknown.scale, unknown.bounds.1 - unknown.start);
        let mut model = start.clone();
        set(&mut model, key, unknown.start + if room < step { -step } else { step });
        problem.job(&model, Grain::Coarse)
    };
    nuisance.keys(start).into_iter().filter_map(step).collect()
}
