//! How much of the residual each candidate explains: probes, projection, score.

use std::sync::Arc;

use super::candidate::Candidate;
use super::grain::ROUGH;
use super::nuisance::Nuisance;
use super::probes::{Probe, Sharing, limit, steer};
use super::problem::{Grain, Model, Part, Problem, Span};
use crate::statistics::{add_to_basis, deviation, dot, project, rms, wald};

/// Candidates that are probed at the residual's own size too.
const SECANTS: usize = 48;

/// Error of rough steps, as a share of the outputs' spread, beyond which they are not used.
const TOO_ROUGH: f64 = 2.0 * ROUGH;

/// What the screen says of one candidate.
#[derive(Debug, Clone)]
pub(crate) struct Scored {
    pub cause: Arc<Candidate>,
    /// Sum of squares of the residual that it explains, to first order.
    pub explained: f64,
    /// Estimated coefficients, in the order of `linear` (one blend where there are none).
    pub estimate: Vec<f64>,
    /// Grid start that they belong to.
    pub start: usize,
    /// Score of the estimate.
    pub score: f64,
    /// Share of its effect that nothing else can imitate.
    pub kappa: f64,
    /// Effect of one unit of the first coefficient on the output, all samples together,
    /// less what can be imitated.
    pub unit_effect: f64,
    /// Probe size at which the effect was near the residual's size.
    pub probe: f64,
}

/// The screen of one model.
pub(crate) struct Screen {
    /// Best first.
    pub scored: Vec<Scored>,
    /// Sum of squares of the residual after projection.
    pub total: f64,
    /// Residual over spread of the output.
    pub far: f64,
    /// Probe columns tried.
    pub columns: usize,
    /// What the nuisance makes up for to first order, orthonormal.
    pub basis: Vec<Vec<f64>>,
    /// The residual, less that.
    pub left: Vec<f64>,
    /// Every grid point to first order, less that too.
    pub tangents: Vec<Tangent>,
}

/// One grid point of a candidate to first order.
pub(crate) struct Tangent {
    pub cause: Arc<Candidate>,
    pub start: usize,
    /// Sign of the first coefficient; 0 where both are allowed.
    pub sign: f64,
    /// Effect of one unit of each coefficient.
    pub columns: Vec<Vec<f64>>,
}

/// Screens all candidates on top of a model; whether the tangents are `kept`.
pub(crate) fn screen(
    problem: &Problem<'_>,
    nuisance: &Nuisance,
    model: &Model,
    candidates: &[Arc<Candidate>],
    kept: bool,
) -> Option<Screen> {
    let job = problem.job(model, Grain::Coarse)?;
    let y0 = problem.run(&[job], Span::Fit).swap_remove(0)?;
    let r = problem.residual(&y0, Part::Fit);
    let basis = nuisance.basis(problem, model, &y0);
    let mut left = r.clone();
    project(&basis, &mut left);
    let spread = {
        let of = |o: usize| {
            let y = problem.counted(o, &problem.y[o], Part::Fit);
            (deviation(&y) / problem.scale[o]).powi(2)
        };
        let sum: f64 = (0..problem.y.len()).map(of).sum();
        (sum / problem.y.len() as f64).sqrt()
    };
    // probes are compared with the same steps without them; steps that were fine about the
    // baseline may be too rough about this model
    let rough = problem.job(model, Grain::Rough).and_then(|job| {
        let y = problem.run(&[job], Span::Fit).swap_remove(0)?;
        let rough = problem.residual(&y, Part::Fit);
        let off: Vec<f64> = rough.iter().zip(&r).map(|(a, b)| a - b).collect();
        (rms(&off) < TOO_ROUGH * spread).then_some(rough)
    });
    let grain = if rough.is_some() { Grain::Rough } else { Grain::Coarse };
    let rough = rough.unwrap_or_else(|| r.clone());
    let residual = rms(&r);
    let gentle = (0.02 * spread).min(0.5 * residual);
    let mut sharing = Sharing { problem, model, kinds: vec![], grain };
    let at = Looking { problem, basis: &basis, r0: &r, left: &left };
    let mut best: Vec<Option<Scored>> = vec![None; candidates.len()];
    let mut per_start: Vec<Vec<(f64, usize, f64)>> = vec![vec![]; candidates.len()];
    // gentle probes of every grid point: the tangent
    let mut probes = vec![];
    for (c, cause) in candidates.iter().enumerate() {
        for start in 0..cause.starts.len() {
            for which in 0..cause.linear.len().max(1) {
                let sign = if cause.sign < 0.0 && which == 0 { -1.0 } else { 1.0 };
                let size = cause.probe * sign;
                probes.push(Probe { candidate: c, start, which, size, done: false, failed: false });
            }
        }
    }
    let columns = probes.len();
    let hits = steer(problem, &mut sharing, candidates, &mut probes, &rough, (1e-6, gentle), true);
    let mut of_start: std::collections::BTreeMap<(usize, usize), Vec<(Vec<f64>, f64)>> =
        Default::default();
    for (probe, column) in hits {
        of_start.entry((probe.candidate, probe.start)).or_default().push((column, probe.size));
    }
    let mut tangents = vec![];
    for ((c, start), columns) in of_start {
        let cause = &candidates[c];
        if columns.len() < cause.linear.len() {
            continue;
        }
        let Some(own) = at.own(&columns) else { continue };
        let scored = at.score(cause, start, &own, None);
        if kept {
            let sign = if cause.blended() { 1.0 } else { cause.sign };
            tangents.push(Tangent { cause: cause.clone(), start, sign, columns: own.columns });
        }
        let Some(scored) = scored else { continue };
        per_start[c].push((scored.explained, start, scored.probe));
        keep(&mut best[c], scored);
    }
    // probes as large as what is to be explained: the secant
    if residual > 2.0 * gentle {
        let mut probes = vec![];
        let target = 0.7 * residual;
        // those that explain next to nothing to first order are not looked at again
        let mut order: Vec<usize> = (0..candidates.len()).filter(|&c| best[c].is_some()).collect();
        let explained = |c: usize| best[c].as_ref().map_or(0.0, |b| b.explained);
        order.sort_by(|&a, &b| explained(b).total_cmp(&explained(a)));
        order.truncate(SECANTS);
        for c in order {
            let cause = &candidates[c];
            if cause.linear.len() > 1 {
                continue;
            }
            per_start[c].sort_by(|a, b| b.0.total_cmp(&a.0));
            for &(_, start, size) in per_start[c].iter().take(2) {
                let signs: &[f64] = match cause.sign {
                    _ if cause.blended() => &[1.0],
                    s if s > 0.0 => &[1.0],
                    s if s < 0.0 => &[-1.0],
                    _ => &[1.0, -1.0],
                };
                for sign in signs {
                    // as large as the tangent says
                    let size = (size.abs() * target / gentle).min(limit(cause, 0, *sign)) * sign;
                    probes.push(Probe {
                        candidate: c,
                        start,
                        which: 0,
                        size,
                        done: false,
                        failed: false,
                    });
                }
            }
        }
        for (probe, column) in
            steer(problem, &mut sharing, candidates, &mut probes, &rough, (0.3, target), false)
        {
            let cause = &candidates[probe.candidate];
            let (sign, start) = (probe.size.signum(), probe.start);
            let Some(own) = at.own(&[(column, probe.size)]) else { continue };
            if let Some(scored) = at.score(cause, start, &own, Some(sign)) {
                keep(&mut best[probe.candidate], scored);
            }
            if kept {
                tangents.push(Tangent { cause: cause.clone(), start, sign, columns: own.columns });
            }
        }
    }
    let mut scored: Vec<Scored> = best.into_iter().flatten().collect();
    scored.sort_by(|a, b| b.explained.total_cmp(&a.explained));
    Some(Screen {
        scored,
        total: dot(&left, &left),
        far: residual / spread.max(1e-300),
        columns,
        basis,
        left,
        tangents,
    })
}

fn keep(best: &mut Option<Scored>, scored: Scored) {
    if best.as_ref().is_none_or(|b| scored.explained > b.explained) {
        *best = Some(scored);
    }
}

/// What scores are made against.
struct Looking<'a, 'b> {
    problem: &'a Problem<'b>,
    basis: &'a [Vec<f64>],
    r0: &'a [f64],
    left: &'a [f64],
}

/// The columns of one grid start, less what the nuisance makes up for.
struct Own {
    columns: Vec<Vec<f64>>,
    /// Size of the first column's probe.
    probe: f64,
    /// Share of them that is left.
    kappa: f64,
}

impl Looking<'_, '_> {
    /// What is a start's own of its columns, each with its probe's size; `None` where nothing is.
    fn own(&self, columns: &[(Vec<f64>, f64)]) -> Option<Own> {
        let probe = columns.first()?.1;
        let before: f64 = columns.iter().map(|(c, _)| dot(c, c)).sum();
        let own = |(column, _): &(Vec<f64>, f64)| {
            let mut column = column.clone();
            project(self.basis, &mut column);
            column
        };
        let columns: Vec<Vec<f64>> = columns.iter().map(own).collect();
        let after: f64 = columns.iter().map(|c| dot(c, c)).sum();
        let is_there = after > 1e-6 * before && after.is_finite();
        is_there.then(|| Own { columns, probe, kappa: (after / before).sqrt() })
    }

    /// Scores the columns of one grid start; `sign` is that of a secant probe, which only
    /// counts for estimates of its own sign.
    fn score(
        &self,
        cause: &Arc<Candidate>,
        start: usize,
        own: &Own,
        sign: Option<f64>,
    ) -> Option<Scored> {
        debug_assert_eq!(self.r0.len(), self.left.len());
        let Own { columns, probe, kappa } = own;
        let (estimate, fitted) = if columns.len() == 1 {
            let c = dot(&columns[0], self.left) / dot(&columns[0], &columns[0]);
            (vec![c], columns[0].iter().map(|s| c * s).collect::<Vec<f64>>())
        } else {
            let mut basis = vec![];
            for column in columns {
                add_to_basis(&mut basis, column.clone());
            }
            let mut rest = self.left.to_vec();
            project(&basis, &mut rest);
            let fitted: Vec<f64> = self.left.iter().zip(&rest).map(|(a, b)| a - b).collect();
            (solve(columns, self.left)?, fitted)
        };
        let first = estimate[0];
        if cause.sign * first < 0.0 || cause.blended() && first < 0.0 {
            return None;
        }
        if sign.is_some_and(|sign| sign * first < 0.0) {
            return None;
        }
        let explained = dot(&fitted, self.left);
        let ff = self.problem.per_sample(&fitted, &fitted);
        let fr = self.problem.per_sample(&fitted, self.left);
        Some(Scored {
            cause: cause.clone(),
            explained,
            estimate,
            start,
            score: wald(&ff, &fr),
            kappa: *kappa,
            unit_effect: dot(&columns[0], &columns[0]).sqrt(),
            probe: *probe,
        })
    }
}

/// Least squares with a few columns.
pub(super) fn solve(columns: &[Vec<f64>], y: &[f64]) -> Option<Vec<f64>> {
    let n = columns.len();
    let normal = nalgebra::DMatrix::from_fn(n, n, |i, j| dot(&columns[i], &columns[j]));
    let right = nalgebra::DVector::from_fn(n, |i, _| dot(&columns[i], y));
    let solution = normal.svd(true, true).solve(&right, 1e-9 * right.len() as f64).ok()?;
    Some(solution.iter().copied().collect())
}
