//! Variance function of a disturbance: noise that grows with the signal that it lies on, or in time.
//!
//! ```text
//! var(e[t]) = v(x[t]) = b_0 + b_1 x + b_2 x^2
//! ```
//!
//! with x the output or the time, in units of its spread about its mean: noise that is always there,
//! noise proportional to the signal (b_2) and both, about any zero of the scale (Davidian and Carroll,
//! "Variance function estimation", Journal of the American Statistical Association 82, 1987). b is the
//! most probable one of normal e, found by Fisher's scoring, which is here the weighted regression of
//! e^2 on (1, x, x^2) with weights 1/v^2 (the same, section 3.1). x is what the model says, so that a
//! sample's noise does not decide its own weight. One variance is kept unless the score against a
//! driver in its studentised form, N R^2 of the regression of e^2 (Koenker, Journal of Econometrics 17,
//! 1981), pays for the two numbers: above 2 ln N (Schwarz, Annals of Statistics 6, 1978).

use nalgebra::{Matrix3, Vector3};

/// Steps of the scoring at most, the gain of a log likelihood at which it ends, and halvings of a step.
const STEPS: usize = 30;
const SETTLED: f64 = 1e-3;
const HALVINGS: usize = 12;
/// The least variance, as a share of the mean one.
const LEAST: f64 = 1e-5;

/// What a variance may follow.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Driver {
    Output,
    Time,
}

/// Variance as a function of a driver.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct VarianceFunction {
    driver: Driver,
    /// Mean and standard deviation of the driver.
    centre: f64,
    spread: f64,
    /// Coefficients, for a mean square of 1.
    b: Vector3<f64>,
    /// The least variance that was seen.
    least: f64,
}

/// One output of a residual: what the model says, the time of each sample, what it leaves (exactly 0
/// where a sample is not known) and what of that the past does not foretell.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seen<'a> {
    pub yhat: &'a [f64],
    pub time: &'a [f64],
    pub residual: &'a [f64],
    pub white: &'a [f64],
}

impl Seen<'_> {
    /// Values of a driver and squares of what is not foretold, as far as known; the squares about 1.
    fn pairs(&self, driver: Driver) -> Vec<(f64, f64)> {
        let of = match driver {
            Driver::Output => self.yhat,
            Driver::Time => self.time,
        };
        let all = of.iter().zip(self.residual.iter().zip(self.white));
        let mut pairs: Vec<(f64, f64)> =
            all.filter(|(_, (r, _))| **r != 0.0).map(|(x, (_, e))| (*x, e * e)).collect();
        let mean = pairs.iter().map(|(_, square)| square).sum::<f64>() / pairs.len() as f64;
        pairs.iter_mut().for_each(|(_, square)| *square /= mean);
        pairs
    }
}

impl VarianceFunction {
    /// The most probable variance function; `None` where one variance is as probable.
    pub fn of(seen: Seen<'_>) -> Option<Self> {
        let both = [Driver::Output, Driver::Time].into_iter();
        let found = both.filter_map(|driver| Self::following(driver, seen.pairs(driver)));
        found.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(found, _)| found)
    }

    /// The most probable function of a driver, and the logarithm of its likelihood but for a constant.
    fn following(driver: Driver, mut pairs: Vec<(f64, f64)>) -> Option<(Self, f64)> {
        let n = pairs.len() as f64;
        let centre = pairs.iter().map(|(x, _)| x).sum::<f64>() / n;
        let square = pairs.iter().map(|(x, _)| (x - centre).powi(2)).sum::<f64>() / n;
        let spread = square.sqrt();
        pairs.iter_mut().for_each(|(x, _)| *x = (*x - centre) / spread);
        let start = regression(&pairs, |_| 1.0)?;
        let fourth = pairs.iter().map(|(_, e)| (e - 1.0).powi(2)).sum::<f64>();
        let explained: f64 =
            pairs.iter().map(|(x, _)| (start.dot(&powers(*x)) - 1.0).powi(2)).sum();
        if n * explained / fourth <= 2.0 * n.ln() {
            return None;
        }
        let (b, likelihood) = scored(&pairs)?;
        let least = pairs.iter().map(|(x, _)| b.dot(&powers(*x))).fold(f64::INFINITY, f64::min);
        Some((Self { driver, centre, spread, b, least }, likelihood))
    }

    /// The root of v where the model says `yhat`.
    pub fn deviation(&self, yhat: f64, time: f64) -> f64 {
        let at = match self.driver {
            Driver::Output => yhat,
            Driver::Time => time,
        };
        self.b.dot(&powers((at - self.centre) / self.spread)).max(self.least).sqrt()
    }
}

fn powers(x: f64) -> Vector3<f64> {
    Vector3::new(1.0, x, x * x)
}

/// The regression of squares on (1, x, x^2) with weights of x.
fn regression(pairs: &[(f64, f64)], weight: impl Fn(f64) -> f64) -> Option<Vector3<f64>> {
    // moments of x weighted, and of the squares
    let (mut m, mut of) = ([0.0; 5], Vector3::zeros());
    for &(x, square) in pairs {
        let w = weight(x);
        let (x1, x2) = (w * x, w * x * x);
        m[0] += w;
        m[1] += x1;
        m[2] += x2;
        m[3] += x2 * x;
        m[4] += x2 * x * x;
        of += Vector3::new(w * square, x1 * square, x2 * square);
    }
    Matrix3::new(m[0], m[1], m[2], m[1], m[2], m[3], m[2], m[3], m[4])
        .cholesky()
        .map(|factor| factor.solve(&of))
        .filter(|b| b.iter().all(|v| v.is_finite()))
}

/// Logarithm of the normal likelihood of squares at coefficients; minus infinity below the least variance.
fn log_likelihood(pairs: &[(f64, f64)], b: &Vector3<f64>) -> f64 {
    let mut sum = 0.0;
    for &(x, square) in pairs {
        let v = b[0] + x * (b[1] + x * b[2]);
        if !(v > LEAST) {
            return f64::NEG_INFINITY;
        }
        sum += square / v + v.ln();
    }
    -0.5 * sum
}

/// The most probable coefficients, from one variance on.
fn scored(pairs: &[(f64, f64)]) -> Option<(Vector3<f64>, f64)> {
    let mut b = Vector3::new(1.0, 0.0, 0.0);
    let mut likelihood = log_likelihood(pairs, &b);
    for _ in 0..STEPS {
        let step = regression(pairs, |x| b.dot(&powers(x)).powi(-2))? - b;
        let tries = (0..HALVINGS).map(|half| b + step * 0.5f64.powi(half as i32));
        let mut tries = tries.map(|b| (b, log_likelihood(pairs, &b)));
        let Some(better) = tries.find(|(_, value)| *value > likelihood) else { break };
        let gain = better.1 - likelihood;
        (b, likelihood) = better;
        if gain < SETTLED {
            break;
        }
    }
    Some((b, likelihood))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Random;

    fn record(n: usize, seed: u64, level: impl Fn(f64, f64) -> f64) -> [Vec<f64>; 3] {
        let mut random = Random::new(seed);
        let time: Vec<f64> = (0..n).map(|k| k as f64).collect();
        let yhat: Vec<f64> = time.iter().map(|t| 3.0 + 2.0 * (0.05 * t).sin()).collect();
        let of = |(y, t): (&f64, &f64)| 0.1 * level(*y, *t / n as f64) * random.normal();
        let e = yhat.iter().zip(&time).map(of).collect();
        [yhat, time, e]
    }

    fn found([yhat, time, e]: &[Vec<f64>; 3]) -> Option<VarianceFunction> {
        VarianceFunction::of(Seen { yhat, time, residual: e, white: e })
    }

    fn ratio(of: &VarianceFunction, a: (f64, f64), b: (f64, f64)) -> f64 {
        of.deviation(a.0, a.1) / of.deviation(b.0, b.1)
    }

    #[test]
    fn one_variance_stays_one() {
        let some = (0..60).filter(|&seed| found(&record(2000, seed, |_, _| 1.0)).is_some());
        assert!(some.count() <= 1);
    }

    #[test]
    fn noise_that_follows_the_output_about_any_zero() {
        for zero in [1.0, 2.7, 3.0] {
            let of = move |y: f64, _: f64| (0.01 + (y - zero).powi(2)).sqrt();
            let found = found(&record(4000, 3, of)).unwrap();
            assert_eq!(found.driver, Driver::Output);
            for y in [1.5, 2.0, 4.0, 5.0] {
                let [exact, own] = [of(y, 0.0) / of(3.5, 0.0), ratio(&found, (y, 0.0), (3.5, 0.0))];
                assert!((own / exact - 1.0).abs() < 0.15, "{zero} {y} {own} {exact}");
            }
            // where it is least
            let least = found.deviation(zero, 0.0) / found.deviation(zero + 1.0, 0.0);
            assert!((0.03..0.25).contains(&least), "{zero} {least}");
        }
    }

    #[test]
    fn noise_that_grows_or_fades() {
        for (from, to) in [(1.0, 3.0), (3.0, 1.0)] {
            let found = found(&record(4000, 4, |_, t| from + (to - from) * t)).unwrap();
            assert_eq!(found.driver, Driver::Time);
            let ratio = ratio(&found, (0.0, 4000.0), (0.0, 0.0));
            assert!((ratio / (to / from) - 1.0).abs() < 0.3, "{ratio}");
        }
    }

    #[test]
    fn samples_that_are_not_known_say_nothing() {
        let [yhat, time, mut e] = record(3000, 6, |y, _| (y - 3.0).abs() + 0.1);
        let whole = found(&[yhat.clone(), time.clone(), e.clone()]).unwrap();
        e[..1000].fill(0.0);
        let part = found(&[yhat, time, e]).unwrap();
        let [a, b] = [whole, part].map(|of| ratio(&of, (4.5, 0.0), (3.2, 0.0)));
        assert!((a / b - 1.0).abs() < 0.15, "{a} {b}");
    }
}
