//! Starts of many stretches, each tried anew by itself. Where errors grow, the cost of a stretch
//! has many minima, and one stretch that is caught in a wrong one spoils the fit of all.

use super::nuisance::{Key, Nuisance, get, set};
use super::problem::{Job, Model, Problem};
use super::refit::Refit;

/// Changes of a state that are tried, in units of its spread.
const TRIED: [f64; 10] = [-0.3, -0.1, -0.03, -0.01, -0.003, 0.003, 0.01, 0.03, 0.1, 0.3];
/// Rounds over all states.
const ROUNDS: usize = 2;
/// Fall of a stretch's sum of squares that counts.
const LESS: f64 = 0.99;

/// The models with better starts, everything else as it is; `None` where none is better.
pub(super) fn restarted(
    problem: &Problem<'_>,
    nuisance: &Nuisance,
    models: Vec<Model>,
    how: Refit,
) -> Vec<Option<Model>> {
    let mut better = vec![false; models.len()];
    let mut best = models;
    let mut least = squares(problem, nuisance, &best, how);
    for state in (0..ROUNDS).flat_map(|_| 0..nuisance.initial.len()) {
        let moved = |model: &Model, by: f64| {
            let mut moved = model.clone();
            for key in (0..nuisance.segments).map(|s| Key::Start(s, state)) {
                set(&mut moved, key, get(model, key) + by * nuisance.spread[state]);
            }
            moved
        };
        // a run moves the state in all stretches at once: each takes what is best for it
        let tried: Vec<Model> =
            best.iter().flat_map(|model| TRIED.map(|by| moved(model, by))).collect();
        let sums = squares(problem, nuisance, &tried, how);
        for (i, (tried, sums)) in tried.iter().zip(&sums).enumerate() {
            let m = i / TRIED.len();
            for (s, (sum, least)) in sums.iter().zip(&mut least[m]).enumerate() {
                if *sum < LESS * *least {
                    (*least, better[m]) = (*sum, true);
                    best[m].starts[s][state] = tried.starts[s][state];
                }
            }
        }
    }
    best.into_iter().zip(better).map(|(model, better)| better.then_some(model)).collect()
}

/// Sums of squares of every model over every stretch; infinite where it diverges.
fn squares(
    problem: &Problem<'_>,
    nuisance: &Nuisance,
    models: &[Model],
    how: Refit,
) -> Vec<Vec<f64>> {
    let segments = &problem.drive.segments;
    let of: Vec<usize> = problem
        .samples(how.part())
        .map(|k| segments.partition_point(|segment| segment.end <= k))
        .collect();
    let jobs: Vec<Option<Job>> = models.iter().map(|model| problem.job(model, how.grain)).collect();
    let known: Vec<Job> = jobs.iter().flatten().cloned().collect();
    let mut answers = problem.run(&known, how.span()).into_iter();
    let each = |job: Option<Job>| {
        let Some(y) = job.and_then(|_| answers.next().flatten()) else {
            return vec![f64::INFINITY; nuisance.segments];
        };
        let mut sums = vec![0.0; segments.len()];
        for r in problem.residual(&y, how.part()).chunks(of.len().max(1)) {
            of.iter().zip(r).for_each(|(&s, r)| sums[s] += r * r);
        }
        sums.truncate(nuisance.segments);
        sums
    };
    jobs.into_iter().map(each).collect()
}
