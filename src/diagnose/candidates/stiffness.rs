//! How stiff a steep law of a velocity makes a model, as its parameters move.
//!
//! A law of slope L / width in a channel that changes its coordinate by D per unit adds the rate
//! D L / width; an explicit integrator follows it up to D L h / width = 2 (Hairer and Wanner, "Solving
//! Ordinary Differential Equations II", section IV.2). D is of the model, so it moves with the
//! parameters: D(theta) = D_0 product of (theta_p / theta_p0)^a_p, a_p = d ln D / d ln theta_p, exact
//! where D is a product of powers, as 1/m.

use std::ops::Range;

/// Share of a parameter by which D is asked beside it.
const ASIDE: f64 = 1e-3;
/// Exponents up to this are what the step and rounding leave of no dependence.
const NONE: f64 = 1e-6;
/// Golden section: spreads shares evenly.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// The rate D.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Stiffness {
    nominal: f64,
    /// Parameters that it depends on: which, its nominal value, the exponent.
    powers: Vec<(usize, f64, f64)>,
}

impl Stiffness {
    /// A rate at nominal parameters, and what it is at others.
    pub fn new(rate: f64, nominal: &[f64], at: impl Fn(&[f64]) -> Option<f64>) -> Self {
        // d ln D / d ln theta along parameters, each moved by its own share of ASIDE
        let exponent = |group: Range<usize>, share: fn(usize) -> f64| {
            let mut theta = nominal.to_vec();
            group.for_each(|p| theta[p] *= 1.0 + share(p) * ASIDE);
            at(&theta).map(|aside| (aside / rate).ln() / ASIDE.ln_1p())
        };
        // different shares, so that those that D is a quotient of do not cancel
        let counts = |group: &Range<usize>| {
            let along = exponent(group.clone(), |p| 1.0 + (p as f64 * GOLDEN).fract());
            along.is_none_or(|along| !(along.abs() <= NONE))
        };
        let power = |p: usize| {
            let along = exponent(p..p + 1, |_| 1.0)?;
            let counts = nominal[p] != 0.0 && along.is_finite() && along.abs() > NONE;
            counts.then_some((p, nominal[p], along))
        };
        let powers = within(0..nominal.len(), &counts).into_iter().filter_map(power).collect();
        Self { nominal: rate.abs(), powers }
    }

    /// D at these parameter values, without its sign; 0 where no law is steep.
    pub fn at(&self, theta: &[f64]) -> f64 {
        let factor = |&(p, value, exponent): &(usize, f64, f64)| (theta[p] / value).powf(exponent);
        let moved = self.nominal * self.powers.iter().map(factor).product::<f64>();
        if moved.is_finite() { moved } else { self.nominal }
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
    use super::*;

    #[test]
    fn a_rate_follows_the_parameters() {
        // D = k / (m r^2), which a further parameter does not enter
        let rate = |theta: &[f64]| Some(theta[1] / (theta[0] * theta[2] * theta[2]));
        let nominal = [2.0, -3.0, 0.5, 7.0];
        let of = Stiffness::new(rate(&nominal).unwrap(), &nominal, rate);
        for theta in [nominal, [0.5, -3.0, 0.5, 1.0], [1.0, -4.0, 0.8, 0.0]] {
            let exact = rate(&theta).unwrap().abs();
            assert!((of.at(&theta) / exact - 1.0).abs() < 1e-2, "{theta:?}");
        }
        assert_eq!(Stiffness::default().at(&nominal), 0.0);
    }

    #[test]
    fn of_many_parameters_few_are_asked() {
        let nominal: Vec<f64> = (0..2000).map(|p| 1.0 + f64::from(p)).collect();
        let asked = std::cell::Cell::new(0);
        let rate = |theta: &[f64]| {
            asked.set(asked.get() + 1);
            Some(theta[700] / theta[1900])
        };
        let of = Stiffness::new(rate(&nominal).unwrap(), &nominal, rate);
        assert_eq!(of.powers.iter().map(|(p, ..)| *p).collect::<Vec<_>>(), [700, 1900]);
        assert!(asked.get() < 100, "{}", asked.get());
    }
}
