//! The dictionary: what every grid point of every candidate does to the outputs, about a model.
//!
//! Tangents (the effect of a gentle probe per unit) of all grid points, secants (the effect of a probe
//! as large as the residual) of the leading ones. Columns are not whitened: any disturbance is a filter
//! that is applied to them later.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

pub(super) use super::item::{About, Item};
use super::leading::Leading;
use super::ranked::ranked;
use crate::candidates::candidate::Candidate;
use crate::candidates::probes::{Probe, Sharing, limit, steer};
use crate::fit::found::LeftOut;
use crate::fit::problem::{Grain, Part, Problem, Span};
use crate::fit::step_size::ROUGH;
use crate::memory::Memory;
use crate::prepare::operating_range::Nominal;
use crate::statistics::{deviation, dot, project, rms};
use crate::watch::Watch;

/// Shares of a budget: columns, whitened columns, everything else.
const SHARES: u64 = 3;
/// Candidates that have secants too, and grid points of each.
const SECANTS: usize = 24;
const POINTS: usize = 2;
/// Size of a gentle probe's effect, as shares of the outputs' spread and of the residual; and of a
/// secant's, as a share of the residual.
const GENTLE: (f64, f64) = (0.02, 0.5);
const LARGE: f64 = 0.7;
/// Probes that are made before it is asked whether to stop.
const AT_ONCE: usize = 8192;

/// Spread of the outputs in units of their scales.
pub(super) fn spread(problem: &Problem<'_>) -> f64 {
    let of = |o: usize| {
        let y = problem.counted(o, &problem.y[o], Part::Fit);
        (deviation(&y) / problem.scale[o]).powi(2)
    };
    ((0..problem.y.len()).map(of).sum::<f64>() / problem.y.len().max(1) as f64).sqrt()
}

/// Grid points, and the laws that memory or time did not allow for.
pub(super) struct Dictionary {
    pub items: Vec<Item>,
    pub left_out: Option<LeftOut>,
    /// The grid points that were looked at, where not all were that were wanted.
    pub looked_at: Option<BTreeSet<(usize, usize)>>,
}

/// Bytes that columns may take; the whitened ones of a metric take as much, and so does the rest.
pub(super) fn room(problem: &Problem<'_>) -> usize {
    problem.memory.part(SHARES)
}

/// All grid points about a model, or those that are `wanted`. Where memory does not hold them, they are
/// made some candidates at a time and those stay that explain most of the residual, each alone. Where
/// simulating them is too much work, those are made that are ranked first. Where somebody asks to stop,
/// the rest is not made.
pub(super) fn dictionary(
    (problem, nominal): (&Problem<'_>, &Nominal),
    about: &About<'_>,
    candidates: &[Arc<Candidate>],
    wanted: Option<&BTreeSet<(usize, usize)>>,
    watch: &dyn Watch,
) -> Dictionary {
    let (model, residual) = (about.model, about.residual);
    let spread = spread(problem);
    // probes are compared with the same steps without them
    let rough = problem.job(model, Grain::Rough).and_then(|job| {
        let y = problem.run(&[job], Span::Fit).swap_remove(0)?;
        let rough = problem.residual(&y, Part::Fit);
        let off: Vec<f64> = rough.iter().zip(residual).map(|(a, b)| a - b).collect();
        (rms(&off) < 2.0 * ROUGH * spread).then_some(rough)
    });
    let grain = if rough.is_some() { Grain::Rough } else { Grain::Coarse };
    let present = rough.unwrap_or_else(|| residual.to_vec());
    let size = rms(residual);
    let gentle = (GENTLE.0 * spread).min(GENTLE.1 * size);
    let mut sharing = Sharing { problem, model, kinds: vec![], grain, watch };
    let mut probes = vec![];
    for (candidate, cause) in candidates.iter().enumerate() {
        for start in 0..cause.starts.len() {
            if wanted.is_some_and(|wanted| !wanted.contains(&(candidate, start))) {
                continue;
            }
            for which in 0..cause.linear.len().max(1) {
                let sign = if cause.sign < 0.0 && which == 0 { -1.0 } else { 1.0 };
                let size = cause.probe * sign;
                probes.push(Probe { candidate, start, which, size, done: false, failed: false });
            }
        }
    }
    let (room, column) = (room(problem), 8 * residual.len());
    let of = wanted_laws(&probes);
    let looked_at = ranked((problem, nominal), about, candidates, &probes, watch).map(|ranked| {
        // what a unit does is known: probes begin in the size that is wanted
        let wanted = gentle * (residual.len() as f64).sqrt();
        for (probe, squares) in probes.iter_mut().zip(&ranked.squares) {
            let size = (wanted / squares.sqrt()).copysign(probe.size);
            let most = limit(&candidates[probe.candidate], probe.which, size);
            if size.is_finite() && size != 0.0 {
                probe.size = size.clamp(-most, most);
            }
        }
        probes.retain(|probe| ranked.leading.contains(&(probe.candidate, probe.start)));
        ranked.leading
    });
    let unseen = of - wanted_laws(&probes);
    let all = probes.len();
    let at_once = match all * column > room {
        true => (room / 4 / column.max(1)).max(1),
        false => all.min(AT_ONCE),
    };
    let mut kept = Leading::new(about, room);
    let mut rest = &mut probes[..];
    while !rest.is_empty() && !watch.stopped() {
        let (block, after) = rest.split_at_mut(block(rest, at_once));
        let hits = steer(problem, &mut sharing, candidates, block, &present, (1e-6, gentle), true);
        kept.take(tangents(candidates, hits));
        rest = after;
    }
    let laws = kept.left_out();
    let whole = Memory::of((SHARES as usize * all * column) as u64);
    let whole = (laws > 0).then_some(whole);
    let left_out = (laws + unseen > 0).then_some(LeftOut { laws: laws + unseen, of, whole });
    let mut items = kept.items;
    if size > 2.0 * gentle {
        let mut probes = secants(about, &items, LARGE * size / gentle);
        let target = LARGE * size;
        let hits =
            steer(problem, &mut sharing, candidates, &mut probes, &present, (0.3, target), false);
        items.extend(hits.into_iter().map(|(probe, column)| Item {
            candidate: probe.candidate,
            cause: candidates[probe.candidate].clone(),
            start: probe.start,
            sign: probe.size.signum(),
            columns: vec![column],
            probe: probe.size,
        }));
    }
    items.retain(Item::is_finite);
    Dictionary { items, left_out, looked_at }
}

/// Grid points whose probes hit, by candidate.
fn tangents(candidates: &[Arc<Candidate>], hits: Vec<(Probe, Vec<f64>)>) -> Vec<Item> {
    let mut of_start: BTreeMap<(usize, usize), Vec<(Vec<f64>, f64)>> = BTreeMap::new();
    for (probe, column) in hits {
        of_start.entry((probe.candidate, probe.start)).or_default().push((column, probe.size));
    }
    let mut items = vec![];
    for ((candidate, start), found) in of_start {
        let cause = &candidates[candidate];
        if found.len() < cause.linear.len() {
            continue;
        }
        let probe = found[0].1;
        let columns: Vec<Vec<f64>> = found.into_iter().map(|(column, _)| column).collect();
        let sign = if cause.blended() { 1.0 } else { cause.sign };
        items.push(Item { candidate, cause: cause.clone(), start, sign, columns, probe });
    }
    items
}

/// How many laws some probes are of.
fn wanted_laws(probes: &[Probe]) -> usize {
    probes.chunk_by(|a, b| a.candidate == b.candidate).count()
}

/// How many of the first probes make whole candidates and are `at_once` or a few more.
fn block(probes: &[Probe], at_once: usize) -> usize {
    let last = probes[at_once.min(probes.len()) - 1].candidate;
    probes.partition_point(|probe| probe.candidate <= last)
}

/// Probes that are larger by a factor, of the candidates that explain most to first order.
fn secants(about: &About<'_>, items: &[Item], factor: f64) -> Vec<Probe> {
    let mut left = about.residual.to_vec();
    project(about.basis, &mut left);
    let mut ranked: BTreeMap<usize, Vec<(f64, &Item)>> = BTreeMap::new();
    for item in items.iter().filter(|item| item.columns.len() == 1) {
        let mut own = item.columns[0].clone();
        project(about.basis, &mut own);
        let explained = dot(&own, &left).powi(2) / dot(&own, &own).max(1e-300);
        ranked.entry(item.candidate).or_default().push((explained, item));
    }
    let mut order: Vec<Vec<(f64, &Item)>> = ranked.into_values().collect();
    order.iter_mut().for_each(|own| own.sort_by(|a, b| b.0.total_cmp(&a.0)));
    order.sort_by(|a, b| b[0].0.total_cmp(&a[0].0));
    order.truncate(SECANTS);
    let mut probes = vec![];
    for (_, item) in order.iter().flat_map(|own| own.iter().take(POINTS)) {
        let signs: &[f64] = match item.cause.sign {
            _ if item.cause.blended() => &[1.0],
            s if s > 0.0 => &[1.0],
            s if s < 0.0 => &[-1.0],
            _ => &[1.0, -1.0],
        };
        for sign in signs {
            let size = (item.probe.abs() * factor).min(limit(&item.cause, 0, *sign)) * sign;
            let (candidate, start) = item.place();
            probes.push(Probe { candidate, start, which: 0, size, done: false, failed: false });
        }
    }
    probes
}
