//! Whether what is told is as sure as it says: calibration over the cases of an exam.
//!
//! Names: reliability diagram, its slope, and the score of Brier (Monthly Weather Review 78, 1950;
//! Murphy and Winkler, Applied Statistics 26, 1977). Coefficients and gain: coverage of 95 %
//! intervals, and rank histograms: the share of the told distribution, normal of the told standard
//! error, that lies below the true value is uniform where all is well (Talts, Betancourt, Simpson,
//! Vehtari and Gelman, arXiv 1804.06788, 2018), tested by chi-square.

use std::collections::BTreeMap;

use serde::Serialize;
use statrs::distribution::{ChiSquared, ContinuousCDF, Normal};

use super::{ExamResult, Hit, Kind, Marks};
use crate::share::Share;

/// Bins of probabilities and of ranks.
const BINS: usize = 10;
/// Expected ranks in a bin below which chi-square says nothing.
const FEW: f64 = 5.0;

/// One bin of the reliability diagram.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Bin {
    /// Probabilities from, and to.
    pub from: f64,
    /// Upper end.
    pub to: f64,
    /// Mean of the probabilities in it.
    #[serde(rename = "told")]
    pub probability: Option<f64>,
    /// How often names in it were right.
    pub right: Share,
}

/// How sure names are.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Names {
    /// Probabilities that were told.
    pub count: usize,
    /// Mean square of probability less outcome.
    pub brier: Option<f64>,
    /// Slope of the outcome over the probability, by least squares.
    pub slope: Option<f64>,
    /// The diagram.
    pub bins: Vec<Bin>,
}

/// Where true values lie in what was told of them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Ranks {
    /// True values inside 95 % intervals.
    pub covered: Share,
    /// True values in each tenth of the told distribution.
    pub histogram: Vec<usize>,
    /// Probability of so uneven a histogram by chance; `None` where there are too few.
    pub chi_square_p: Option<f64>,
}

/// The calibration of cases of one kind.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// What was asked.
    pub kind: Kind,
    /// Cases.
    pub cases: usize,
    /// Something was named that was not hidden.
    pub spurious: Share,
    /// All that was hidden stands in the sets of causes.
    pub named: Share,
    /// A hidden effect stands in a set of a cause, of those hidden where a cause was told.
    pub sets: Share,
    /// Probabilities of names.
    pub names: Names,
    /// Coefficients.
    pub coefficients: Ranks,
    /// Gain.
    pub gain: Ranks,
}

/// The calibration of an exam.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Calibration {
    /// Cases.
    pub cases: usize,
    /// Names of the machines.
    pub machines: Vec<String>,
    /// Kind by kind.
    pub rows: Vec<Row>,
    /// Probabilities of names over all kinds.
    pub names: Names,
    /// Coefficients over all kinds.
    pub coefficients: Ranks,
    /// Gain over all kinds.
    pub gain: Ranks,
}

impl Names {
    fn of(stated: &[(f64, bool)]) -> Self {
        let n = stated.len() as f64;
        let outcome = |right: bool| f64::from(u8::from(right));
        let square = |(p, right): &(f64, bool)| (p - outcome(*right)).powi(2);
        let mean_p = stated.iter().map(|(p, _)| p).sum::<f64>() / n;
        let mean_o = stated.iter().map(|(_, right)| outcome(*right)).sum::<f64>() / n;
        let across: f64 = stated.iter().map(|(p, _)| (p - mean_p).powi(2)).sum();
        let along: f64 =
            stated.iter().map(|(p, right)| (p - mean_p) * (outcome(*right) - mean_o)).sum();
        let bin = |i: usize| {
            let (from, to) = (i as f64 / BINS as f64, (i + 1) as f64 / BINS as f64);
            let inside: Vec<&(f64, bool)> =
                stated.iter().filter(|(p, _)| from <= *p && (*p < to || i + 1 == BINS)).collect();
            let sum: f64 = inside.iter().map(|(p, _)| p).sum();
            let mean = (!inside.is_empty()).then(|| sum / inside.len() as f64);
            Bin {
                from,
                to,
                probability: mean,
                right: Share::of(inside.iter().map(|(_, right)| *right)),
            }
        };
        Self {
            count: stated.len(),
            brier: (!stated.is_empty()).then(|| stated.iter().map(square).sum::<f64>() / n),
            slope: (across > 1e-9).then(|| along / across),
            bins: (0..BINS).map(bin).collect(),
        }
    }
}

impl Ranks {
    /// Of estimates less true values in standard errors, and whether each true value is covered.
    fn of(standardised: &[f64], covered: impl IntoIterator<Item = bool>) -> Self {
        let normal = Normal::standard();
        let mut histogram = vec![0; BINS];
        for z in standardised {
            // the truth lies at -z of the told distribution
            let rank = (normal.cdf(-z) * BINS as f64) as usize;
            histogram[rank.min(BINS - 1)] += 1;
        }
        let expected = standardised.len() as f64 / BINS as f64;
        let square: f64 =
            histogram.iter().map(|&n| (n as f64 - expected).powi(2) / expected.max(1e-300)).sum();
        let law = ChiSquared::new((BINS - 1) as f64).ok().filter(|_| expected >= FEW);
        let covered = Share::of(covered);
        Self { covered, histogram, chi_square_p: law.map(|law| law.sf(square)) }
    }
}

/// Coefficients, then gain, of some marks.
fn ranks(marks: &[&Marks]) -> (Ranks, Ranks) {
    let all = |of: fn(&Marks) -> Vec<f64>| marks.iter().flat_map(|m| of(m)).collect::<Vec<_>>();
    let coefficients = all(|m| m.standardised.clone());
    let gain = all(|m| m.gain_standardised.into_iter().collect());
    (
        Ranks::of(&coefficients, marks.iter().flat_map(|m| m.covered.iter().copied())),
        Ranks::of(&gain, marks.iter().filter_map(|m| m.gain_covered)),
    )
}

fn names(marks: &[&Marks]) -> Names {
    Names::of(&marks.iter().flat_map(|m| m.probabilities.iter().copied()).collect::<Vec<_>>())
}

impl Row {
    fn of(kind: Kind, marks: &[&Marks]) -> Self {
        let guilty = || marks.iter().filter(|m| !m.hidden.is_empty());
        let stated = guilty().filter(|m| !m.found.is_empty());
        let (coefficients, gain) = ranks(marks);
        Self {
            kind,
            cases: marks.len(),
            spurious: Share::of(marks.iter().map(|m| m.spurious() > 0)),
            named: Share::of(guilty().map(|m| m.all())),
            sets: Share::of(stated.flat_map(|m| m.hits.iter().map(|hit| *hit > Hit::Missed))),
            names: names(marks),
            coefficients,
            gain,
        }
    }
}

impl Calibration {
    /// Of an exam's marks.
    pub fn of(result: &ExamResult) -> Self {
        let all: Vec<&Marks> = result.marks().iter().collect();
        let mut kinds: BTreeMap<Kind, Vec<&Marks>> = BTreeMap::new();
        all.iter().for_each(|m| kinds.entry(m.case.kind).or_default().push(m));
        let mut machines: Vec<String> = all.iter().map(|m| m.system.clone()).collect();
        machines.sort();
        machines.dedup();
        let (coefficients, gain) = ranks(&all);
        Self {
            cases: all.len(),
            machines,
            rows: kinds.iter().map(|(kind, marks)| Row::of(*kind, marks)).collect(),
            names: names(&all),
            coefficients,
            gain,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Random;

    #[test]
    fn what_is_as_sure_as_it_says_has_slope_one_and_flat_ranks() {
        let mut random = Random::new(3);
        let stated: Vec<(f64, bool)> = (0..20_000)
            .map(|_| {
                let p = random.uniform();
                (p, random.uniform() < p)
            })
            .collect();
        let names = Names::of(&stated);
        assert!((names.slope.unwrap() - 1.0).abs() < 0.05, "{:?}", names.slope);
        assert!((names.brier.unwrap() - 1.0 / 6.0).abs() < 0.01, "{:?}", names.brier);
        for bin in &names.bins {
            let [low, high] = bin.right.interval95;
            let stated = bin.probability.unwrap();
            assert!(low - 0.02 < stated && stated < high + 0.02, "{bin:?}");
        }
        let z: Vec<f64> = (0..5000).map(|_| random.normal()).collect();
        let well = Ranks::of(&z, z.iter().map(|z| z.abs() < 1.96));
        assert!(well.chi_square_p.unwrap() > 0.01, "{well:?}");
        // standard errors that are too small by a third are noticed
        let sure: Vec<f64> = z.iter().map(|z| 1.5 * z).collect();
        let ill = Ranks::of(&sure, sure.iter().map(|z| z.abs() < 1.96));
        assert!(ill.chi_square_p.unwrap() < 1e-6, "{ill:?}");
        assert!(ill.covered.interval95[1] < 0.9, "{ill:?}");
        // and so is an estimate that lies too high: the truth is at low ranks
        let high: Vec<f64> = z.iter().map(|z| z + 1.0).collect();
        let high = Ranks::of(&high, [true]);
        assert!(high.histogram[0] > 3 * high.histogram[9], "{high:?}");
        assert_eq!(Ranks::of(&[0.1], [true]).chi_square_p, None);
    }
}
