//! A learned law read as a formula: one or two shapes of its coordinates, or products of two.

use nalgebra::{DMatrix, DVector};

use crate::candidates::network_start::value;
use crate::digits::number;
use crate::effect::View;
use crate::findings::cause::{Cause, FoundShape};
use crate::findings::context::Context;
use crate::findings::law_band::{band, other_law};
use crate::findings::pictures::curves;
use crate::findings::series::Curve;
use crate::fit::finished::Finished;
use crate::fit::problem::{Added, Grain, Model, Problem};
use crate::plugins::effects::network::Network;
use crate::prepare::operating_range::Nominal;
use crate::statistics::{dot, rms};

/// Samples that are looked at.
const SAMPLES: usize = 1500;
/// Terms of a formula at most.
const TERMS: usize = 2;
/// Times that each is exchanged for a better one.
const EXCHANGES: usize = 3;
/// Share of the law that a formula must make up for.
const ALIKE: f64 = 0.95;
/// Share that a term must make up for per step of how intricate it is.
const INTRICATE: f64 = 0.004;
/// Numbers before an angle whose sine is looked at.
const TURNS: usize = 4;
/// Widths of friction, as shares of what its coordinate moves.
const WIDTHS: [f64; 3] = [0.02, 0.1, 0.3];

/// Points of a slice, and where in its range the other coordinate is held.
const POINTS: usize = 121;
const SLICES: [f64; 3] = [0.1, 0.5, 0.9];

/// A learned law as a formula.
pub(crate) struct Reading {
    /// Largest magnitude along the record.
    pub most: f64,
    /// Its terms, none where no formula is like it.
    pub terms: Vec<Term>,
    /// Share of its mean square that they make up for.
    pub share: f64,
}

/// One term of a formula.
#[derive(Clone)]
pub(crate) struct Term {
    pub coefficient: f64,
    /// What it is of, as text, coefficient left out.
    pub text: String,
    /// The effect of the library that is this and nothing else, and its coordinate.
    pub shape: Option<(&'static str, Option<String>)>,
    column: Vec<f64>,
    intricate: usize,
}

impl Reading {
    /// The effect of the library that the law is, and its coordinate.
    pub fn is_shape(&self) -> Option<(&'static str, Option<&str>)> {
        let [only] = &self.terms[..] else { return None };
        let (effect, of) = only.shape.as_ref()?;
        Some((*effect, of.as_deref()))
    }
}

/// Reads a learned law of a model by what the record visits.
pub(crate) fn read(problem: &Problem<'_>, model: &Model, index: usize) -> Option<Reading> {
    let added = &model.added[index];
    let law = network(added.cause.placed(&added.parameters)?.effect.as_ref())?;
    let job = problem.job(model, Grain::Coarse)?;
    let track = problem.system.run_seen(&job.plan, &problem.drive, &job.lane);
    let sources = &problem.base.sources;
    let names = added.cause.coordinates();
    let entries: Vec<usize> = names.iter().filter_map(|of| sources.find(of)).collect();
    let seen: Vec<usize> = (0..problem.len())
        .filter(|&k| entries.iter().all(|&e| track.seen[e].get(k).is_some_and(|z| z.is_finite())))
        .collect();
    let used: Vec<usize> = (0..SAMPLES.min(seen.len()))
        .map(|i| seen[i * seen.len() / SAMPLES.min(seen.len())])
        .collect();
    let points: Vec<Vec<f64>> =
        used.iter().map(|&k| entries.iter().map(|&e| track.seen[e][k]).collect()).collect();
    let w: Vec<f64> = points.iter().map(|z| value(&law, &added.parameters, z)).collect();
    let most = w.iter().fold(0.0_f64, |m, w| m.max(w.abs()));
    if !(most > 0.0 && most.is_finite()) {
        return None;
    }
    let mut all = vec![plain("", vec![1.0; w.len()], 0, Some(("bias", None)))];
    let each: Vec<Vec<Term>> = (0..entries.len())
        .map(|i| {
            let z: Vec<f64> = points.iter().map(|z| z[i]).collect();
            shapes(names[i], &sources.entries[entries[i]].0.unit, &z)
        })
        .collect();
    for (i, own) in each.iter().enumerate() {
        all.extend_from_slice(own);
        for other in &each[i + 1..] {
            all.extend(own.iter().flat_map(|a| other.iter().map(move |b| product(a, b))));
        }
    }
    let (terms, share) = selected(&w, &all);
    let terms = if share >= ALIKE { terms } else { vec![] };
    Some(Reading { most, terms, share })
}

/// The network of a placed effect.
fn network(effect: &dyn crate::effect::CandidateEffect) -> Option<Network> {
    let table = serde_json::to_value(effect).ok()?;
    serde_json::from_value(table.get(crate::candidates::free_surface::NAME)?.clone()).ok()
}

fn plain(
    text: &str,
    column: Vec<f64>,
    intricate: usize,
    shape: Option<(&'static str, Option<String>)>,
) -> Term {
    Term { coefficient: 0.0, text: text.into(), shape, column, intricate }
}

/// Shapes of one coordinate.
fn shapes(name: &str, unit: &str, z: &[f64]) -> Vec<Term> {
    let of = |f: &dyn Fn(f64) -> f64| z.iter().map(|&z| f(z)).collect::<Vec<f64>>();
    let own = |effect| Some((effect, Some(name.to_string())));
    let mut all = vec![
        plain(name, of(&|z| z), 1, own("linear")),
        plain(&format!("{name}^2"), of(&|z| z * z), 2, own("quadratic")),
        plain(&format!("{name}^3"), of(&|z| z.powi(3)), 3, own("cubic")),
        plain(&format!("{name}^5"), of(&|z| z.powi(5)), 4, own("quintic")),
        plain(&format!("{name} |{name}|"), of(&|z| z * z.abs()), 3, own("drag")),
    ];
    let size = rms(z);
    for width in WIDTHS.map(|share| share * size).into_iter().filter(|width| *width > 0.0) {
        let text = format!("tanh({name}/{})", number(width, None));
        all.push(plain(&text, of(&|z| (z / width).tanh()), 4, own("coulomb_friction")));
    }
    for n in (1..=TURNS).filter(|_| unit == "rad") {
        let angle = if n == 1 { name.to_string() } else { format!("{n} {name}") };
        let n = n as f64;
        all.push(plain(&format!("sin({angle})"), of(&|z| (n * z).sin()), 3, own("harmonic")));
        all.push(plain(&format!("cos({angle})"), of(&|z| (n * z).cos()), 3, own("harmonic")));
    }
    all
}

fn product(a: &Term, b: &Term) -> Term {
    let column = a.column.iter().zip(&b.column).map(|(a, b)| a * b).collect();
    plain(&format!("{} {}", a.text, b.text), column, a.intricate + b.intricate, None)
}

/// One or two terms that make up for most of `w`, an intricate one only where it is worth it,
/// and the share that they make up for.
fn selected(w: &[f64], all: &[Term]) -> (Vec<Term>, f64) {
    let total = dot(w, w);
    let cost = |which: &[usize]| {
        let (_, left) = solved(w, all, which)?;
        let price: usize = which.iter().map(|&i| all[i].intricate).sum();
        Some(left / total + INTRICATE * price as f64)
    };
    // the best term in the place of one, given the others
    let placed = |chosen: &[usize], place: usize| {
        let with = |i: usize| {
            let mut with = chosen.to_vec();
            if place < with.len() {
                with[place] = i
            } else {
                with.push(i)
            }
            with
        };
        let open = (0..all.len()).filter(|i| !chosen.contains(i) || chosen.get(place) == Some(i));
        let costs = open.filter_map(|i| Some((cost(&with(i))?, i)));
        costs.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, i)| with(i))
    };
    let mut chosen: Vec<usize> = vec![];
    let mut best = (vec![], 0.0);
    while chosen.len() < TERMS && best.1 < ALIKE {
        let Some(more) = placed(&chosen, chosen.len()) else { break };
        chosen = more;
        // the first may have been a compromise
        let count = chosen.len();
        for place in (0..EXCHANGES * count).map(|i| i % count) {
            chosen = placed(&chosen, place).unwrap_or(chosen);
        }
        let Some((values, left)) = solved(w, all, &chosen) else { break };
        let each = chosen.iter().zip(values);
        let terms = each.map(|(&i, coefficient)| Term { coefficient, ..all[i].clone() }).collect();
        best = (terms, 1.0 - left / total);
    }
    best
}

/// Coefficients of some terms by least squares, and the squares that they leave.
fn solved(w: &[f64], all: &[Term], which: &[usize]) -> Option<(Vec<f64>, f64)> {
    let n = which.len();
    let column = |i: usize| &all[which[i]].column;
    let normal = DMatrix::from_fn(n, n, |i, j| dot(column(i), column(j)));
    let right = DVector::from_fn(n, |i, _| dot(column(i), w));
    // two terms that are one another's multiple are no two terms
    let alike = (0..n)
        .any(|i| (0..i).any(|j| normal[(i, j)].powi(2) > 0.999 * normal[(i, i)] * normal[(j, j)]));
    let values = normal.cholesky().filter(|_| !alike)?.solve(&right);
    let left = dot(w, w) - values.dot(&right);
    left.is_finite().then(|| (values.iter().copied().collect(), left.max(0.0)))
}

/// Pictures of learned laws of two coordinates: the law against the first one, where the second
/// one is low, in the middle and high.
fn slices(problem: &Problem<'_>, nominal: &Nominal, model: &Model) -> Vec<Curve> {
    let view = |of: &str| {
        let source = problem.base.sources.find(of)?;
        Some((View::new(nominal.series(source), problem.base.sampling_time), source))
    };
    let places = model.places();
    let picture = |(index, added): (usize, &Added)| {
        let [of, also] = added.cause.coordinates()[..] else { return None };
        let law = network(added.cause.placed(&added.parameters)?.effect.as_ref())?;
        let ((view, _), (other, source)) = (view(of)?, view(also)?);
        let (low, high) = (view.quantile(0.002), view.quantile(0.998));
        let unit = &problem.base.sources.entries[source].0.unit;
        let at = |i: usize| low + (high - low) * i as f64 / (POINTS - 1) as f64;
        let slice = |share: f64| {
            let held = other.quantile(share);
            let points =
                (0..POINTS).map(|i| (at(i), value(&law, &added.parameters, &[at(i), held])));
            let words = format!("where {also} is {} {unit}", number(held, None));
            (words.trim_end().to_string(), points.collect())
        };
        Some(Curve {
            cause: places.iter().position(|own| own.contains(&index))?,
            coordinate: (of.into(), added.cause.units.1.clone()),
            channel: (added.cause.into.clone(), added.cause.units.0.clone()),
            slices: SLICES.map(slice).to_vec(),
            ..Curve::default()
        })
    };
    model.added.iter().enumerate().filter_map(picture).collect()
}

impl Context<'_, '_> {
    /// Pictures of all causes that can be drawn; `causes` are those of the places of the model, in order.
    pub fn pictures(&self, chosen: &Finished, causes: &[Cause]) -> Vec<Curve> {
        let (problem, nominal, model) = (self.problem, self.nominal, &chosen.fitted.model);
        let mut all = curves(problem, nominal, &chosen.nuisance, model);
        let (places, step) = (model.places(), problem.step(Grain::Fine));
        for curve in &mut all {
            let (own, cause) = (&places[curve.cause], &causes[curve.cause]);
            let z: Vec<f64> = curve.law.iter().map(|p| p.0).collect();
            curve.band = band(chosen, own, &cause.parts, step, &z);
            let laws = chosen.found.slots[own[0]].laws.iter();
            curve.others = laws.map(|laws| other_law(laws, model, step, &z)).collect();
        }
        all.extend(slices(problem, nominal, model));
        all
    }

    /// What is known of a learned law.
    pub fn found_law(&self, model: &Model, index: usize) -> FoundShape {
        let reading = read(self.problem, model, index);
        let most = reading.as_ref().map_or(0.0, |reading| reading.most);
        let formula = reading.map_or((vec![], 0.0), |reading| {
            let terms = reading.terms.into_iter().map(|term| (term.coefficient, term.text));
            (terms.collect(), reading.share)
        });
        FoundShape::Learned { most, formula }
    }
}
