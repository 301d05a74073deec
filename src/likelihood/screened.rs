//! The evidence of one place: of its free curve, and of its laws over their grids.
//!
//! In closed form from the sums of its columns along a path (`tangent.rs`, `evidence.rs`).
//! Source: MacKay, Neural Computation 4, 1992.

use std::ops::Range;

use rayon::prelude::*;

use super::evidence::{Evidence, curve_prior, evidence, log_sum};
use super::noise::Noise;
use super::path::Path;
use super::predictor::Predictor;
use super::replay::Pass;
use super::screen::Spotted;
use super::tangent::{Gram, Site, gram};

/// Columns whose sums are made in one pass, unless one law has more: products grow with their square.
const AT_ONCE: usize = 16;

/// What the sums say about a place.
#[derive(Debug, Clone)]
pub(crate) struct Screened {
    /// Evidence of the free curve, where there is one.
    pub curve: Option<Evidence>,
    /// The best evidence of a law, averaged over its grid, or of a parameter.
    pub best: f64,
}

impl Screened {
    /// The place's evidence: of its free curve or of its laws, whichever is larger.
    pub fn value(&self) -> f64 {
        self.curve.as_ref().map_or(self.best, |curve| curve.value.max(self.best))
    }
}

impl Predictor {
    /// The sums and evidences of places under a noise.
    pub(crate) fn screen(&self, path: &Path, noise: &Noise, spots: &[Spotted]) -> Vec<Screened> {
        let pass = Pass::of(path, noise, false);
        spots.par_iter().map(|spot| screened(path, &pass, noise, spot)).collect()
    }
}

/// Columns that are summed at a time: those of the free curve, whole laws, and what comes after them.
fn blocks(curves: usize, first: &[usize], count: usize) -> Vec<Range<usize>> {
    let mut found: Vec<Range<usize>> = vec![];
    let laws = first.windows(2).map(|w| w[0]..w[1]);
    let rest = first.last().copied().unwrap_or(curves)..count;
    for own in std::iter::once(0..curves).chain(laws).chain([rest]).filter(|own| !own.is_empty()) {
        match found.last_mut().filter(|last| own.end - last.start <= AT_ONCE) {
            Some(last) => last.end = own.end,
            None => found.push(own),
        }
    }
    found
}

/// The evidences of a place under a noise.
pub(super) fn screened(path: &Path, pass: &Pass, noise: &Noise, spot: &Spotted) -> Screened {
    let (columns, first) = spot.columns();
    let curves = spot.knots.len();
    // products of columns that no evidence has both of are not wanted
    let blocks = blocks(curves, &first, columns.len());
    let sums: Vec<(usize, Gram)> = blocks
        .into_iter()
        .map(|block| (block.start, gram(path, pass, noise, &columns[block])))
        .collect();
    let part = |range: Range<usize>, prior: nalgebra::DMatrix<f64>| {
        let (start, gram) = sums.iter().rev().find(|(start, _)| *start <= range.start)?;
        let (from, n) = (range.start - start, range.len());
        let square = gram.square.view((from, from), (n, n)).into_owned();
        Some(evidence(&square, &gram.slope.rows(from, n).into_owned(), &prior))
    };
    let value = |of: Option<Evidence>| of.map_or(f64::NEG_INFINITY, |own| own.value);
    let curve = (curves > 0).then(|| part(0..curves, curve_prior(curves, spot.scale))).flatten();
    let rms = |column: &[f64]| {
        (column.iter().map(|v| v * v).sum::<f64>() / column.len().max(1) as f64).sqrt()
    };
    let own = |range: Range<usize>| {
        let sizes = range.clone().map(|j| {
            let size = spot.scale / rms(columns[j].values()).max(f64::MIN_POSITIVE);
            if size.is_finite() { size * size } else { 0.0 }
        });
        let prior =
            nalgebra::DMatrix::from_diagonal(&nalgebra::DVector::from_iterator(range.len(), sizes));
        value(part(range, prior))
    };
    let laws: Vec<f64> = first.windows(2).map(|w| own(w[0]..w[1])).collect();
    let mut names: Vec<&str> = spot.laws.iter().map(|law| law.name).collect();
    names.dedup();
    let averaged = names.iter().map(|name| {
        let of = spot.laws.iter().zip(&laws).filter(|(law, _)| law.name == *name);
        let values: Vec<f64> = of.map(|(_, value)| *value).collect();
        log_sum(&values) - (values.len() as f64).ln()
    });
    let mut best = averaged.fold(f64::NEG_INFINITY, f64::max);
    if let Site::Parameter(_) = spot.site {
        let j = columns.len() - 1;
        let prior = nalgebra::DMatrix::from_element(1, 1, spot.scale * spot.scale);
        best = value(part(j..j + 1, prior));
    }
    Screened { curve, best }
}
