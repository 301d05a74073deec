//! Which grid points of a very large library are simulated: those that explain most to first order.
//!
//! Where simulating every law at every place is more than a stated amount of [`work`](crate::fit::affordable),
//! all are ranked by one [`Adjoint`] run first, each by (r'dy)^2 / dy'dy, and only the leading ones are
//! simulated (sure independence screening: Fan and Lv, JRSS B 70, 2008).

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use rayon::prelude::*;

use super::item::About;
use super::open_loop::open_loop;
use crate::candidates::candidate::{Candidate, Wire};
use crate::candidates::probes::Probe;
use crate::effect::Mechanism;
use crate::fit::adjoint::{Adjoint, Extent};
use crate::fit::affordable::{affordable, room};
use crate::fit::explained::{Effect, Place};
use crate::fit::problem::Problem;
use crate::prepare::operating_range::Nominal;
use crate::system::Origin;
use crate::watch::Watch;

/// Sums with random signs: the size of a change is known within a third.
const SIGNS: usize = 16;
/// Grid points of one law that are simulated.
const POINTS: usize = 3;
/// Grid points that are ranked before it is asked whether to stop.
const AT_ONCE: usize = 4096;

/// Something that enters a place.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Entering<'a> {
    effect: &'a str,
    source: usize,
    /// Entry and factor of the rate of the source.
    rate: Option<(usize, u64)>,
    /// Parameters, as bits.
    parameters: Vec<u64>,
}

/// How a grid point is ranked.
enum Way<'a> {
    Law(Entering<'a>, Place),
    Parameter(usize, bool),
    /// It is simulated whatever it explains.
    Not,
}

/// Which grid points are simulated, and what is known of them.
pub(super) struct Ranked {
    /// Candidates and their grid points.
    pub leading: BTreeSet<(usize, usize)>,
    /// Per probe the sum of squares of what a unit of it does, about; 0 where it was not asked.
    pub squares: Vec<f64>,
}

/// The grid points that are simulated, where there are too many for all of them.
pub(super) fn ranked(
    (problem, nominal): (&Problem<'_>, &Nominal),
    about: &About<'_>,
    candidates: &[Arc<Candidate>],
    probes: &[Probe],
    watch: &dyn Watch,
) -> Option<Ranked> {
    let most = affordable(problem, probes.len())?;
    watch.report(0.06, "ranking candidates by their first order");
    let by = Ranker { problem, nominal };
    let ways: Vec<Way<'_>> = probes.iter().map(|probe| by.way(candidates, probe)).collect();
    let parameters = ways.iter().any(|way| matches!(way, Way::Parameter(..)));
    let of = Extent { signs: SIGNS, parameters, room: room(problem) };
    let adjoint = Adjoint::new(problem, about, of, watch)?;
    let effects = by.effects(&adjoint, (candidates, probes), &ways, watch);
    let scores: Vec<f64> = effects.iter().map(|effect| effect.explained).collect();
    let squares = effects.iter().map(|effect| effect.squares).collect();
    Some(Ranked { leading: leading(probes, &scores, most), squares })
}

/// Of every law the best grid points, of all of these the best.
fn leading(probes: &[Probe], scores: &[f64], most: usize) -> BTreeSet<(usize, usize)> {
    // a grid point with several coefficients has a probe of each
    let mut points: BTreeMap<(usize, usize), (f64, usize)> = BTreeMap::new();
    for (probe, score) in probes.iter().zip(scores) {
        let own = points.entry((probe.candidate, probe.start)).or_default();
        *own = (own.0 + score, own.1 + 1);
    }
    let mut of_law: BTreeMap<usize, Vec<(f64, usize, usize)>> = BTreeMap::new();
    for ((candidate, start), (score, count)) in points {
        of_law.entry(candidate).or_default().push((score, start, count));
    }
    let mut all = vec![];
    for (candidate, mut own) in of_law {
        own.sort_by(|a, b| b.0.total_cmp(&a.0));
        let unranked = own.iter().filter(|(score, ..)| score.is_infinite()).count();
        own.truncate(POINTS.max(unranked));
        all.extend(own.into_iter().map(|(score, start, count)| (score, (candidate, start), count)));
    }
    all.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut taken = 0;
    let stays = |(score, _, count): &(f64, (usize, usize), usize)| {
        taken += if score.is_infinite() { 0 } else { *count };
        taken <= most
    };
    all.into_iter().take_while(stays).map(|(_, place, _)| place).collect()
}

/// What grid points are ranked with.
struct Ranker<'a, 'b> {
    problem: &'a Problem<'b>,
    nominal: &'a Nominal,
}

impl Ranker<'_, '_> {
    /// How a grid point is ranked: laws of what is there at that instant by what enters, parameters by
    /// what they change; what remembers a path is simulated.
    fn way<'c>(&self, candidates: &'c [Arc<Candidate>], probe: &Probe) -> Way<'c> {
        let cause = &candidates[probe.candidate];
        let base = &self.problem.base;
        let (source, target, rate) = match &cause.wire {
            Wire::Parameter(p) => return Way::Parameter(*p, false),
            Wire::Drift(p) => return Way::Parameter(*p, true),
            Wire::Stage(route) => {
                let rate = (route.rate.1 != 0.0).then_some((route.rate.0, route.rate.1.to_bits()));
                (Some(route.source), Some(route.target), rate)
            }
            Wire::Path => {
                let entries = &base.targets.entries;
                let target = entries.iter().position(|(signal, origin)| {
                    signal.name == cause.into && !matches!(origin, Origin::Own(_))
                });
                (target.and_then(|t| base.sources.at(entries[t].1)), target, None)
            }
        };
        let is_path = cause.wire == Wire::Path;
        let both = (self.problem, self.nominal);
        let place = target.and_then(|target| Place::of(both, target, is_path));
        let is_plain = cause.also_into.is_empty() && cause.also_of.is_empty();
        let is_law = cause.card.mechanism == Mechanism::Law && is_plain;
        let (Some(source), Some(place), true) = (source, place, is_law) else { return Way::Not };
        let mut parameters = cause.starts[probe.start].clone();
        if let Some(&own) = cause.linear.get(probe.which) {
            cause.linear.iter().for_each(|&other| parameters[other] = 0.0);
            parameters[own] = 1.0;
        }
        let parameters = parameters.iter().map(|v| v.to_bits()).collect();
        Way::Law(Entering { effect: cause.effect, source, rate, parameters }, place)
    }

    /// What each grid point does; it explains infinitely much where that is not asked.
    fn effects(
        &self,
        adjoint: &Adjoint,
        (candidates, probes): (&[Arc<Candidate>], &[Probe]),
        ways: &[Way<'_>],
        watch: &dyn Watch,
    ) -> Vec<Effect> {
        let unknown = Effect { explained: f64::INFINITY, squares: 0.0 };
        let mut effects = vec![unknown; probes.len()];
        // the same law of the same coordinate enters many places
        let mut series: BTreeMap<&Entering<'_>, Vec<usize>> = BTreeMap::new();
        for (i, way) in ways.iter().enumerate() {
            match way {
                Way::Law(entering, _) => series.entry(entering).or_default().push(i),
                Way::Parameter(p, grows) => effects[i] = adjoint.parameter_explains(*p, *grows),
                Way::Not => {}
            }
        }
        let series: Vec<(&Entering<'_>, Vec<usize>)> = series.into_iter().collect();
        for block in series.chunks(AT_ONCE) {
            let one = |(entering, own): &(&Entering<'_>, Vec<usize>)| {
                let cause = &candidates[probes[own[0]].candidate];
                let parameters: Vec<f64> =
                    entering.parameters.iter().map(|&bits| f64::from_bits(bits)).collect();
                let rate = entering.rate.map(|(entry, factor)| {
                    let factor = f64::from_bits(factor);
                    adjoint.seen[entry].iter().map(|v| factor * v).collect::<Vec<f64>>()
                });
                let z = (&adjoint.seen[entering.source][..], rate.as_deref());
                let w =
                    open_loop(cause.shape.as_ref(), &parameters, z, &adjoint.begins, self.problem);
                let explains = |&i: &usize| match &ways[i] {
                    Way::Law(_, place) => (i, adjoint.explains(*place, &w)),
                    _ => (i, unknown),
                };
                own.iter().map(explains).collect::<Vec<(usize, Effect)>>()
            };
            if watch.stopped() {
                break;
            }
            let found: Vec<Vec<(usize, Effect)>> = block.par_iter().map(one).collect();
            found.into_iter().flatten().for_each(|(i, effect)| effects[i] = effect);
        }
        effects
    }
}

#[cfg(test)]
#[path = "ranked_tests.rs"]
mod tests;
