//! How stiff a steep law of a velocity makes a model, as its parameters move.
//!
//! A law of slope L / width in a channel that changes its coordinate by D per unit adds the rate
//! D L / width; an explicit integrator follows it up to D L h / width = 2 (Hairer and Wanner, "Solving
//! Ordinary Differential Equations II", section IV.2). D is of the model, so it moves with the
//! parameters: D(theta) = D_0 product of (theta_p / theta_p0)^a_p, a_p = d ln D / d ln theta_p, exact
//! where D is a product of powers, as 1/m. An exponent is asked once its parameter moves: at the nominal
//! values D is D_0 whatever the exponents are.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use std::sync::{Arc, Mutex, OnceLock};

/// Share of a parameter by which D is asked beside it.
const ASIDE: f64 = 1e-3;
/// Exponents up to this are what the step and rounding leave of no dependence.
const NONE: f64 = 1e-6;
/// Golden section: spreads shares evenly.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// The rate D at parameter values.
type Rate = Box<dyn Fn(&[f64]) -> Option<f64> + Send + Sync>;

/// The rate D.
#[derive(Debug, Clone, Default)]
pub(crate) struct Stiffness {
    nominal: f64,
    /// How it depends on parameters.
    powers: Option<Arc<Powers>>,
}

/// The exponents of a rate, as they are asked.
struct Powers {
    rate: f64,
    nominal: Arc<[f64]>,
    at: Rate,
    /// Those of single parameters, once they have moved.
    one: Mutex<BTreeMap<usize, f64>>,
    /// Parameters that it depends on, of all, and their exponents.
    all: OnceLock<Vec<(usize, f64)>>,
}

impl Stiffness {
    /// A rate at nominal parameters, and what it is at others.
    pub fn new(
        rate: f64,
        nominal: Arc<[f64]>,
        at: impl Fn(&[f64]) -> Option<f64> + Send + Sync + 'static,
    ) -> Self {
        let (one, all) = (Mutex::default(), OnceLock::new());
        let powers = Powers { rate, nominal, at: Box::new(at), one, all };
        Self { nominal: rate.abs(), powers: Some(Arc::new(powers)) }
    }

    /// D at these parameter values, without its sign; 0 where no law is steep.
    pub fn at(&self, theta: &[f64]) -> f64 {
        let factor = self.powers.as_ref().map_or(1.0, |powers| powers.factor(theta));
        let moved = self.nominal * factor;
        if moved.is_finite() { moved } else { self.nominal }
    }
}

impl Powers {
    /// What D is multiplied by at these parameter values.
    fn factor(&self, theta: &[f64]) -> f64 {
        let has_moved = |p: &usize| theta[*p].to_bits() != self.nominal[*p].to_bits();
        let moved: Vec<usize> = (0..self.nominal.len()).filter(has_moved).collect();
        let power = |p: usize, exponent: f64| (theta[p] / self.nominal[p]).powf(exponent);
        // to find one among n by halves takes two questions at each of log2(n) levels
        let few = 2 * self.nominal.len().max(2).ilog2() as usize;
        if moved.len() <= few {
            return moved.into_iter().map(|p| power(p, self.of_one(p))).product();
        }
        let all = self.all.get_or_init(|| {
            let of = |p: usize| Some((p, self.exponent(p)?));
            let counts = |group: &Range<usize>| self.counts(group);
            within(0..self.nominal.len(), &counts).into_iter().filter_map(of).collect()
        });
        all.iter().map(|&(p, exponent)| power(p, exponent)).product()
    }

    /// The exponent of a parameter that has moved; 0 where D does not depend on it.
    fn of_one(&self, p: usize) -> f64 {
        let ask = || self.exponent(p).unwrap_or(0.0);
        // who waits for the lock would ask the same
        let Ok(mut known) = self.one.lock() else { return ask() };
        *known.entry(p).or_insert_with(ask)
    }

    /// d ln D / d ln theta along parameters, each moved by its own share of `ASIDE`.
    fn along(&self, group: Range<usize>, share: fn(usize) -> f64) -> Option<f64> {
        let mut theta = self.nominal.to_vec();
        group.for_each(|p| theta[p] *= 1.0 + share(p) * ASIDE);
        (self.at)(&theta).map(|aside| (aside / self.rate).ln() / ASIDE.ln_1p())
    }

    /// The exponent of a parameter that D depends on.
    fn exponent(&self, p: usize) -> Option<f64> {
        let along = self.along(p..p + 1, |_| 1.0)?;
        let counts = self.nominal[p] != 0.0 && along.is_finite() && along.abs() > NONE;
        counts.then_some(along)
    }

    /// Whether D depends on any of these: different shares, so that those that it is a quotient of do not
    /// cancel.
    fn counts(&self, group: &Range<usize>) -> bool {
        let along = self.along(group.clone(), |p| 1.0 + (p as f64 * GOLDEN).fract());
        along.is_none_or(|along| !(along.abs() <= NONE))
    }
}

impl fmt::Debug for Powers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Powers").field("rate", &self.rate).finish_non_exhaustive()
    }
}

/// Numbers of a range that count, found by halving what counts as a whole (group testing: Dorfman, Annals
/// of Mathematical Statistics 14, 1943): of many parameters D depends on few.
fn within(range: Range<usize>, counts: &impl Fn(&Range<usize>) -> bool) -> Vec<usize> {
    if range.is_empty() || !counts(&range) {
        return vec![];
    }
    if range.len() == 1 {
        return vec![range.start];
    }
    let middle = range.start + range.len() / 2;
    let mut found = within(range.start..middle, counts);
    found.extend(within(middle..range.end, counts));
    found
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    #[test]
    fn a_rate_follows_the_parameters() {
        // D = k / (m r^2), which a further parameter does not enter
        let rate = |theta: &[f64]| Some(theta[1] / (theta[0] * theta[2] * theta[2]));
        let nominal = [2.0, -3.0, 0.5, 7.0];
        let of = Stiffness::new(rate(&nominal).unwrap(), nominal.into(), rate);
        for theta in [nominal, [0.5, -3.0, 0.5, 1.0], [1.0, -4.0, 0.8, 0.0]] {
            let exact = rate(&theta).unwrap().abs();
            assert!((of.at(&theta) / exact - 1.0).abs() < 1e-2, "{theta:?}");
        }
        assert_eq!(Stiffness::default().at(&nominal), 0.0);
    }

    #[test]
    fn of_many_parameters_few_are_asked() {
        let nominal: Vec<f64> = (0..2000).map(|p| 1.0 + f64::from(p)).collect();
        let asked = Arc::new(AtomicUsize::new(0));
        let counted = asked.clone();
        let rate = move |theta: &[f64]| {
            counted.fetch_add(1, Ordering::Relaxed);
            Some(theta[700] / theta[1900])
        };
        let of = Stiffness::new(701.0 / 1901.0, nominal.as_slice().into(), rate);
        let asked = || asked.load(Ordering::Relaxed);
        // nothing has moved: nothing is asked
        assert_eq!(of.at(&nominal), 701.0 / 1901.0);
        assert_eq!(asked(), 0);
        // one has moved: once, however often the rate is wanted
        let mut moved = nominal.clone();
        moved[700] *= 2.0;
        let twice = of.at(&moved) * 1901.0 / 701.0;
        assert!((twice / 2.0 - 1.0).abs() < 1e-2, "{twice}");
        assert_eq!((of.at(&moved) * 1901.0 / 701.0, asked()), (twice, 1));
        // all have moved: those that count are found by halves
        let all: Vec<f64> = nominal.iter().map(|v| 2.0 * v).collect();
        assert!((of.at(&all) * 1901.0 / 701.0 - 1.0).abs() < 1e-2);
        assert!(asked() < 100, "{}", asked());
        let powers = of.powers.as_ref().unwrap().all.get().unwrap();
        assert_eq!(powers.iter().map(|(p, ..)| *p).collect::<Vec<_>>(), [700, 1900]);
    }
}
