//! Starts of stretches, each tried anew by itself. Where errors grow, the cost of a stretch
//! has many minima, and one stretch that is caught in a wrong one spoils the fit of all.

use crate::fit::fitted::Fitted;
use crate::fit::nuisance::{Key, Nuisance, get, set};
use crate::fit::problem::{Grain, Job, Model, Part, Problem};

/// Changes of a state that are tried, in units of its spread.
const TRIED: [f64; 10] = [-0.3, -0.1, -0.03, -0.01, -0.003, 0.003, 0.01, 0.03, 0.1, 0.3];
/// Rounds over all states.
const ROUNDS: usize = 2;
/// Fall of a stretch's sum of squares that counts.
const LESS: f64 = 0.99;

/// The models with better starts, everything else as it is; `None` where none is better.
pub(crate) fn restarted(
    problem: &Problem<'_>,
    nuisance: &Nuisance,
    fits: &[&Fitted],
    (grain, part): (Grain, Part),
) -> Vec<Option<Model>> {
    let of: Vec<usize> = problem.segments_of(part).collect();
    // sums of squares over every stretch
    let squares = |residuals: &[f64]| {
        let mut sums = vec![0.0; nuisance.segments];
        for r in residuals.chunks(of.len().max(1)) {
            for (&s, r) in of.iter().zip(r) {
                sums.get_mut(s).into_iter().for_each(|sum| *sum += r * r);
            }
        }
        sums
    };
    let mut better = vec![false; fits.len()];
    let mut best: Vec<Model> = fits.iter().map(|fit| fit.model.clone()).collect();
    let mut least: Vec<Vec<f64>> = fits.iter().map(|fit| squares(&fit.residuals)).collect();
    for state in (0..ROUNDS).flat_map(|_| 0..nuisance.spread.len()) {
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
        let jobs: Vec<Option<Job>> = tried.iter().map(|m| problem.job(m, grain)).collect();
        let answers = problem.run_built(&jobs, part.span());
        for (i, (tried, y)) in tried.iter().zip(answers).enumerate() {
            let (Some(y), m) = (y, i / TRIED.len()) else { continue };
            let sums = squares(&problem.residual(&y, part));
            for (s, (sum, least)) in sums.into_iter().zip(&mut least[m]).enumerate() {
                if sum < LESS * *least {
                    (*least, better[m]) = (sum, true);
                    best[m].starts[s][state] = tried.starts[s][state];
                }
            }
        }
    }
    best.into_iter().zip(better).map(|(model, better)| better.then_some(model)).collect()
}
