//! Sets of laws of one place that are worth an exact fit.
//!
//! With the noise known, a set S of columns raises log L by 1/2 g_S' G_S^-1 g_S, of which its numbers are paid for by
//! 1/2 ln(samples) each, as at the end. Of every law's grid the best point counts; singles and pairs exhaustively,
//! triples from the leading pairs, and the offset of the channel as a law like any other.
//! Sources: Miller, "Subset Selection in Regression", 2nd ed., 2002, ch. 3; Schwarz, Annals of Statistics 6, 1978.

use nalgebra::{DMatrix, DVector};

use super::hypothesis::Part;
use super::laws::Law;
use super::noise::Noise;
use super::path::Path;
use super::replay::Pass;
use super::screen::Spotted;
use super::tangent::{Column, Site, gram};
use crate::effect::Size;

/// Sets of each size that are fitted.
const SINGLES: usize = 4;
const PAIRS: usize = 5;
const TRIPLES: usize = 3;

/// How far the orders of two waves are apart, at least.
const ORDERS: f64 = 0.9;

/// One law at one point of its grid, and its columns.
struct Entry<'a> {
    law: &'a Law,
    site: Site,
    source: Option<usize>,
    columns: Vec<usize>,
}

/// The sets, with coefficients as the linear problem has them.
pub(crate) fn sets(
    path: &Path,
    noise: &Noise,
    spot: &Spotted,
    offset: Option<&Spotted>,
) -> Vec<Vec<Part>> {
    let pass = Pass::of(path, noise, false);
    let gains = |laws: &[Law]| -> Vec<f64> {
        let columns: Vec<Column> = laws
            .iter()
            .map(|law| (spot.site, law.columns(&spot.z, &[]).swap_remove(0)).into())
            .collect();
        let sums = gram(path, &pass, noise, &columns);
        let one = |i: usize| solved(&sums.square, &sums.slope, &[i]).map_or(0.0, |s| s.0);
        (0..laws.len()).map(one).collect()
    };
    let begun = Law::begun(&spot.laws, step(&spot.z), gains);
    let mut columns: Vec<Column> = vec![];
    let mut entries = vec![];
    for own in [Some(spot), offset.filter(|o| o.source != spot.source)].into_iter().flatten() {
        let begun = begun.iter().filter(|_| own.source == spot.source);
        for law in own.laws.iter().chain(begun) {
            let first = columns.len();
            let own_columns = law.columns(&own.z, own.load_of(law)).into_iter();
            columns.extend(own_columns.map(|column| (own.site, column).into()));
            let columns = (first..columns.len()).collect();
            entries.push(Entry { law, site: own.site, source: own.source, columns });
        }
    }
    let sums = gram(path, &pass, noise, &columns);
    let joined = |of: &[usize]| -> Vec<usize> {
        of.iter().flat_map(|&e| entries[e].columns.iter().copied()).collect()
    };
    let samples = pass.z.iter().filter(|z| z.is_finite()).count().max(1) as f64;
    let gain = |set: &[usize]| {
        let columns = joined(set);
        let numbers: usize = set.iter().map(|&e| entries[e].law.numbers()).sum();
        let raised = solved(&sums.square, &sums.slope, &columns).map_or(0.0, |s| s.0);
        raised - 0.5 * numbers as f64 * samples.ln()
    };
    let mut found: Vec<Vec<usize>> = vec![];
    let leading = |all: Vec<Vec<usize>>, most: usize| {
        let mut all: Vec<(f64, Vec<usize>)> =
            all.into_iter().map(|set| (gain(&set), set)).collect();
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        // of every set of names the best point of its grid
        let names = |set: &[usize]| {
            let mut names: Vec<&str> = set.iter().map(|&e| entries[e].law.name).collect();
            names.sort_unstable();
            names
        };
        let mut kept: Vec<Vec<usize>> = vec![];
        for (_, set) in all {
            if kept.len() < most && !kept.iter().any(|other| names(other) == names(&set)) {
                kept.push(set);
            }
        }
        kept
    };
    let n = entries.len();
    let distinct = |set: &[usize]| {
        (1..set.len()).all(|i| (0..i).all(|j| are_two(entries[set[i]].law, entries[set[j]].law)))
    };
    found.extend(leading((0..n).map(|e| vec![e]).collect(), SINGLES));
    let pairs = (0..n).flat_map(|a| (0..a).map(move |b| vec![b, a])).filter(|set| distinct(set));
    let pairs = leading(pairs.collect(), PAIRS);
    let triples = pairs.iter().take(TRIPLES).flat_map(|pair| {
        (0..n).map(|e| [&pair[..], &[e]].concat()).filter(|set| distinct(set)).collect::<Vec<_>>()
    });
    let triples = leading(triples.collect(), TRIPLES);
    found.extend(pairs);
    found.extend(triples);
    found
        .into_iter()
        .map(|set| {
            let own = joined(&set);
            let amplitudes = solved(&sums.square, &sums.slope, &own).map(|s| s.1);
            let mut next = 0;
            set.into_iter()
                .map(|e| {
                    let Entry { law, site, source, columns } = &entries[e];
                    let mut law = (*law).clone();
                    let coefficients = law.coefficients();
                    for (&i, _) in coefficients.iter().zip(columns) {
                        let value = amplitudes.as_ref().map_or(0.0, |a| a[next]);
                        law.values[i] =
                            value.clamp(law.card.parameters[i].min, law.card.parameters[i].max);
                        next += 1;
                    }
                    if coefficients.is_empty() {
                        next += columns.len();
                    }
                    Part::Law { site: *site, source: *source, law: Box::new(law) }
                })
                .collect()
        })
        .collect()
}

/// From sample to sample of a clock.
fn step(z: &[f64]) -> f64 {
    z.windows(2).map(|two| two[1] - two[0]).find(|step| *step > 0.0).unwrap_or(f64::INFINITY)
}

/// Whether two laws of a place may act together: they have other names, or are waves of other orders, as a periodic
/// law has several of.
fn are_two(a: &Law, b: &Law) -> bool {
    let order = |law: &Law| match law.card.properties.size {
        Size::Wave { order, .. } => {
            let at = law.card.parameters.iter().position(|own| own.name == order)?;
            Some(law.values[at])
        }
        _ => None,
    };
    let differ = || order(a).zip(order(b)).is_some_and(|(a, b)| (a - b).abs() > ORDERS);
    a.name != b.name || differ()
}

/// Gain of log L of a set of columns, and their amplitudes.
fn solved(
    square: &DMatrix<f64>,
    slope: &DVector<f64>,
    set: &[usize],
) -> Option<(f64, DVector<f64>)> {
    let m = set.len();
    let size = |i: usize| square[(set[i], set[i])].max(1e-300).sqrt();
    let scaled = DMatrix::from_fn(m, m, |i, j| {
        let own = if i == j { 1e-9 } else { 0.0 };
        square[(set[i], set[j])] / size(i) / size(j) + own
    });
    let right = DVector::from_fn(m, |i, _| -slope[set[i]] / size(i));
    let at = scaled.cholesky()?.solve(&right);
    let gain = 0.5 * at.dot(&right);
    Some((gain, DVector::from_fn(m, |i, _| at[i] / size(i))))
}
