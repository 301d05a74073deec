//! How stiff a steep law of a velocity makes a model, as its parameters move.
//!
//! A law of slope L / width in a channel that changes its coordinate by D per unit adds the rate
//! D L / width; an explicit integrator follows it up to D L h / width = 2 (Hairer and Wanner, "Solving
//! Ordinary Differential Equations II", section IV.2). D is of the model, so it moves with the
//! parameters: D(theta) = D_0 product of (theta_p / theta_p0)^a_p, a_p = d ln D / d ln theta_p, exact
//! where D is a product of powers, as 1/m.

/// Share of a parameter by which D is asked beside it.
const ASIDE: f64 = 1e-3;

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
        let power = |(p, &value): (usize, &f64)| {
            let mut theta = nominal.to_vec();
            theta[p] *= 1.0 + ASIDE;
            let aside = at(&theta)?;
            let exponent = (aside / rate).ln() / ASIDE.ln_1p();
            // what the step size and rounding leave of no dependence
            let counts = value != 0.0 && exponent.is_finite() && exponent.abs() > 1e-6;
            counts.then_some((p, value, exponent))
        };
        let powers = nominal.iter().enumerate().filter_map(power).collect();
        Self { nominal: rate.abs(), powers }
    }

    /// D at these parameter values, without its sign; 0 where no law is steep.
    pub fn at(&self, theta: &[f64]) -> f64 {
        let factor = |&(p, value, exponent): &(usize, f64, f64)| (theta[p] / value).powf(exponent);
        let moved = self.nominal * self.powers.iter().map(factor).product::<f64>();
        if moved.is_finite() { moved } else { self.nominal }
    }
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
}
