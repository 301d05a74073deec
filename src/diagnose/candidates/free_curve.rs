//! Free curves of every coordinate into every channel, to first order.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::candidates::candidate::Candidate;
use crate::candidates::leading_places::{Asked, Terms, leading};
use crate::candidates::library::{Builder, Spot};
use crate::candidates::smoothing::{Smoothed, bends, smoothed};
use crate::effect::{Effect, View, curve};
use crate::fit::adjoint::About;
use crate::fit::nuisance::Nuisance;
use crate::fit::problem::{Grain, Job, Model, Part, Problem, Span};
use crate::plugins::effects::free_form::FreeForm;
use crate::prepare::operating_range::Nominal;
use crate::statistics::project;
use crate::system::Origin;
use crate::watch::Watch;

/// The effect's name.
pub(crate) const NAME: &str = "free_form";
/// Knots of a curve, fewer first.
const KNOTS: [usize; 3] = [9, 13, 19];
/// Knots that a curve needs to be one.
const FEWEST: usize = 4;
/// Places that are looked at with other knots too.
const LEADING: usize = 8;
/// Probe, as a share of what moves the model as it moves anyway.
pub(crate) const PROBE: f64 = 0.01;

/// What curves are drawn from.
pub(crate) struct Drawing<'a, 'b> {
    pub problem: &'a Problem<'b>,
    pub nominal: &'a Nominal,
    pub nuisance: &'a Nuisance,
    pub watch: &'a dyn Watch,
}

/// Where a curve may be.
struct Place {
    spot: Spot,
    /// Channels that push the same way, with their factors.
    others: Vec<(usize, f64)>,
    /// Knots, fewer first.
    knots: Arc<[Vec<f64>]>,
}

/// A curve to first order.
pub(crate) struct Sketch {
    pub cause: Arc<Candidate>,
    pub values: Vec<f64>,
    /// Standard errors of the values.
    pub errors: Vec<f64>,
    /// Share of what is left that it predicts where it was not fitted.
    pub share: f64,
}

/// A model, what it leaves, and what nuisance makes up for.
pub(crate) struct At<'a> {
    pub model: &'a Model,
    pub now: Vec<f64>,
    pub basis: Vec<Vec<f64>>,
}

impl At<'_> {
    pub(super) fn about(&self) -> About<'_> {
        About { model: self.model, residual: &self.now, basis: &self.basis }
    }
}

impl Drawing<'_, '_> {
    /// The curves that predict most of what a model leaves, given its outputs; best first, one
    /// per place.
    pub fn sketches(&self, model: &Model, y: &[Vec<f64>]) -> Vec<Sketch> {
        let now = self.problem.residual(y, Part::Fit);
        let basis = self.nuisance.basis(self.problem, model, y);
        let at = At { model, now, basis };
        let best = |causes: &[Arc<Candidate>]| {
            let drawn = causes.iter().filter_map(|cause| self.sketch(&at, cause));
            drawn.max_by(|a, b| a.share.total_cmp(&b.share))
        };
        let mut builder = Builder::new(self.problem, self.nominal, vec![]);
        let spots = self.spots(&builder);
        let wanted = self.leading_spots(&at, &spots);
        let is_wanted = |i: &usize| wanted.as_ref().is_none_or(|wanted| wanted.contains(i));
        let chosen = (0..spots.len()).filter(is_wanted).take_while(|_| !self.watch.stopped());
        let places = chosen.filter_map(|i| self.curves(&mut builder, &spots[i]));
        let places: Vec<Vec<Arc<Candidate>>> = places.collect();
        // all places with few knots, the leading ones with others too
        let mut leading: Vec<(Sketch, &[Arc<Candidate>])> = places
            .iter()
            .take_while(|_| !self.watch.stopped())
            .filter_map(|causes| Some((best(&causes[..1])?, &causes[1..])))
            .collect();
        leading.sort_by(|a, b| b.0.share.total_cmp(&a.0.share));
        leading.truncate(LEADING);
        let finer = leading.into_iter().map(|(few, causes)| match best(causes) {
            Some(more) if more.share > few.share => more,
            _ => few,
        });
        let mut sketches: Vec<Sketch> = finer.collect();
        sketches.sort_by(|a, b| b.share.total_cmp(&a.share));
        sketches
    }

    /// Every coordinate into every channel, and the paths of inputs and outputs.
    fn spots(&self, builder: &Builder<'_, '_>) -> Vec<Place> {
        let base = self.problem.base.clone();
        let mut spots: Vec<(Spot, Vec<(usize, f64)>)> = vec![];
        let groups = builder.channels();
        let sources = builder.sources();
        for group in &groups {
            let target = group[0].0;
            for &source in sources.iter().filter(|&&source| builder.may_see(target, source)) {
                if !builder.is_own_path(group, source) {
                    let spot = Spot { target, source: Some(source), own_path: false };
                    spots.push((spot, group[1..].to_vec()));
                }
            }
        }
        for (target, (_, origin)) in base.targets.entries.iter().enumerate() {
            if matches!(origin, Origin::Input(_) | Origin::Output(_)) {
                let source = base.sources.at(*origin);
                spots.push((Spot { target, source, own_path: true }, vec![]));
            }
        }
        let mut known: BTreeMap<usize, Arc<[Vec<f64>]>> = BTreeMap::new();
        let place = |(spot, others): (Spot, Vec<(usize, f64)>)| {
            let knots = known.entry(spot.source?).or_insert_with_key(|&source| self.knots(source));
            (!knots.is_empty()).then(|| Place { spot, others, knots: knots.clone() })
        };
        spots.into_iter().filter_map(place).collect()
    }

    /// Knots of curves of a source, fewer first; none where it does not move.
    fn knots(&self, source: usize) -> Arc<[Vec<f64>]> {
        let view = View::new(self.nominal.series(source), self.problem.base.sampling_time);
        let counts = if view.range() > 0.0 { &KNOTS[..] } else { &[] };
        let all = counts.iter().map(|&count| knots(&view, count));
        all.filter(|knots| knots.len() >= FEWEST).collect()
    }

    /// The places that are drawn, where drawing all of them is too much work.
    fn leading_spots(&self, at: &At<'_>, places: &[Place]) -> Option<BTreeSet<usize>> {
        let first = |place: &Place| place.knots[0].clone();
        let mut sources: BTreeMap<usize, (usize, Vec<f64>)> = BTreeMap::new();
        let mut asked = vec![];
        for place in places {
            let Spot { target, source, own_path } = place.spot;
            let next = sources.len();
            let law = sources.entry(source?).or_insert_with(|| (next, first(place))).0;
            asked.push(Asked { target, own_path, law, simulations: place.knots[0].len() });
        }
        let all = asked.iter().map(|asked| asked.simulations).sum();
        let terms = |seen: &[Vec<f64>]| {
            let mut terms: Vec<(usize, Terms)> = sources
                .iter()
                .map(|(&source, (law, knots))| {
                    let unit = |j: usize| {
                        let values = (0..knots.len()).map(|i| f64::from(u8::from(i == j)));
                        let values: Vec<f64> = values.collect();
                        let shape = FreeForm { knots: knots.clone(), values: values.clone() };
                        curve(&shape, &values, &seen[source])
                    };
                    (*law, Terms::new(&(0..knots.len()).map(unit).collect::<Vec<_>>()))
                })
                .collect();
            terms.sort_by_key(|(law, _)| *law);
            terms.into_iter().map(|(_, terms)| terms).collect()
        };
        leading((self.problem, self.nominal), &at.about(), &asked, all, terms, self.watch)
    }

    /// Curves without a value at a place; they differ in their knots.
    fn curves(&self, builder: &mut Builder<'_, '_>, place: &Place) -> Option<Vec<Arc<Candidate>>> {
        let (base, spot) = (&self.problem.base, place.spot);
        let of = base.sources.entries[spot.source?].0.name.clone();
        let twin = |&(t, by): &(usize, f64)| {
            (base.targets.entries[t].0.name.clone(), Some(of.clone()), by)
        };
        let twins: Vec<_> = place.others.iter().map(twin).collect();
        for knots in place.knots.iter() {
            let shape = FreeForm { values: vec![0.0; knots.len()], knots: knots.clone() };
            let card = Effect::card(&shape);
            builder.push(NAME, &shape, &card, spot, 0.0, None, twins.clone());
        }
        let probe = PROBE * self.nominal.natural[spot.target];
        let causes = builder.found.drain(..);
        Some(causes.map(|cause| Arc::new(Candidate { probe, ..cause })).collect())
    }

    /// Curves without a value at the place of a law of the library, with its channels; they differ in
    /// their knots.
    pub fn in_place_of(&self, law: &Candidate) -> Vec<Candidate> {
        let base = &self.problem.base;
        let name = |source: usize| &base.sources.entries[source].0.name;
        let here = |place: &Place| {
            base.targets.entries[place.spot.target].0.name == law.into
                && place.spot.source.map(name) == law.of.as_ref()
        };
        let rewired = |curve: Arc<Candidate>| Candidate {
            also_into: law.also_into.clone(),
            wire: law.wire.clone(),
            twins: law.twins.clone(),
            ..Candidate::clone(&curve)
        };
        let mut builder = Builder::new(self.problem, self.nominal, vec![]);
        let places = self.spots(&builder).into_iter().filter(here);
        let curves = places.filter_map(|place| self.curves(&mut builder, &place));
        curves.collect::<Vec<_>>().into_iter().flatten().map(rewired).collect()
    }

    /// One curve to first order, as smooth as what is left out asks for.
    fn sketch(&self, at: &At<'_>, cause: &Arc<Candidate>) -> Option<Sketch> {
        let n = cause.linear.len();
        let step = cause.probe;
        let job = |values: Vec<f64>| self.problem.job(&at.model.with(cause, values), Grain::Coarse);
        let mut jobs: Vec<Job> = vec![];
        for i in 0..n {
            let mut values = vec![0.0; n];
            values[i] = step;
            jobs.push(job(values)?);
        }
        let mut left = at.now.clone();
        project(&at.basis, &mut left);
        let mut columns = vec![];
        for y in self.problem.run(&jobs, Span::Fit) {
            let r = self.problem.residual(y.as_ref()?, Part::Fit);
            let mut column: Vec<f64> = at.now.iter().zip(&r).map(|(a, b)| (a - b) / step).collect();
            project(&at.basis, &mut column);
            columns.push(column);
        }
        let drawn = smoothed(&columns, &left, self.problem.y.len(), &bends(&knots_of(cause)))?;
        let Smoothed { values, errors, share } = drawn;
        Some(Sketch { cause: cause.clone(), values, errors, share })
    }
}

/// Knots half way between those of equal spacing and those of equal use.
fn knots(view: &View, count: usize) -> Vec<f64> {
    let (low, high) = (view.quantile(0.001), view.quantile(0.999));
    let at = |i: usize| {
        let share = i as f64 / (count - 1) as f64;
        0.5 * (low + (high - low) * share) + 0.5 * view.quantile(0.001 + 0.998 * share)
    };
    let mut knots: Vec<f64> = (0..count).map(at).collect();
    knots.dedup_by(|a, b| (*a - *b).abs() < 1e-3 * view.range());
    knots
}

/// The knots of a curve of unknown shape; none where a cause is none.
pub(crate) fn knots_of(cause: &Candidate) -> Vec<f64> {
    let table = serde_json::to_value(&cause.shape).unwrap_or_default();
    let list = table.get(NAME).and_then(|fields| fields.get("knots"));
    let list = list.and_then(serde_json::Value::as_array);
    list.map_or_else(Vec::new, |list| list.iter().filter_map(serde_json::Value::as_f64).collect())
}
