//! Variance function of a disturbance: noise that grows with the signal that it lies on, or in time.
//!
//! ```text
//! var(e[t]) = s^2 v[t],   v[t] = (1 - q) + q d[t],   0 <= q < 1,   mean of d = 1
//! ```
//!
//! with d one of ((yhat - mean)/sd)^2, yhat^2/mean, and the squared time since the start or until the
//! end: a part that is always there and a part proportional to the driver (Davidian and Carroll,
//! "Variance function estimation", Journal of the American Statistical Association 82, 1987; the
//! additive and proportional error of Sheiner and Beal, Journal of Pharmacokinetics and
//! Biopharmaceutics 13, 1985). yhat is the model's own output, so that a sample's noise does not decide
//! its own weight. One variance is kept unless the score against a driver, in its studentised form N R^2
//! of the regression of e^2 on d (Koenker, Journal of Econometrics 17, 1981), is above ln N (Schwarz,
//! Annals of Statistics 6, 1978); q is then the most probable one.

/// Shares q that are tried first, and steps of the golden section between the neighbours of the best.
const SHARES: [f64; 7] = [0.1, 0.3, 0.5, 0.7, 0.9, 0.97, 0.999];
const STEPS: usize = 12;
/// Golden section.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// What a variance may follow.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Driver {
    /// ((yhat - centre)/spread)^2.
    Output { centre: f64, spread: f64 },
    /// 3 (t - start)^2 / length^2, mean 1 over the samples it was estimated from.
    Time { start: f64, length: f64 },
}

impl Driver {
    fn at(self, yhat: f64, time: f64) -> f64 {
        match self {
            Self::Output { centre, spread } => ((yhat - centre) / spread).powi(2),
            Self::Time { start, length } => 3.0 * ((time - start) / length).powi(2),
        }
    }
}

/// Variance as a function of a driver.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct VarianceFunction {
    driver: Driver,
    /// The share q.
    share: f64,
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
    fn known(&self) -> impl Iterator<Item = (f64, f64, f64)> + '_ {
        let all = self.yhat.iter().zip(self.time).zip(self.residual.iter().zip(self.white));
        all.filter(|(_, (r, _))| **r != 0.0).map(|((y, t), (_, e))| (*y, *t, e * e))
    }
}

impl VarianceFunction {
    /// The most probable variance function; `None` where one variance is as probable.
    pub fn of(seen: Seen<'_>) -> Option<Self> {
        let (mut n, mut sum, mut square) = (0.0, 0.0, 0.0);
        let (mut first, mut last) = (f64::INFINITY, f64::NEG_INFINITY);
        for (y, t, _) in seen.known() {
            n += 1.0;
            sum += y;
            square += y * y;
            first = t.min(first);
            last = t.max(last);
        }
        let centre = sum / n;
        let drivers = [
            Driver::Output { centre, spread: (square / n - centre * centre).max(0.0).sqrt() },
            Driver::Output { centre: 0.0, spread: (square / n).sqrt() },
            Driver::Time { start: first, length: last - first },
            Driver::Time { start: last, length: last - first },
        ];
        let scored = drivers.into_iter().map(|driver| (score(seen, driver), driver));
        let asked = scored.filter(|(score, _)| *score > f64::ln(n));
        let (_, driver) = asked.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let of: Vec<(f64, f64)> =
            seen.known().map(|(y, t, square)| (driver.at(y, t), square)).collect();
        let share = most_probable(|share| likelihood(&of, share));
        (likelihood(&of, share) > likelihood(&of, 0.0)).then_some(Self { driver, share })
    }

    /// The root of v[t].
    pub fn deviation(self, yhat: f64, time: f64) -> f64 {
        (1.0 - self.share + self.share * self.driver.at(yhat, time)).sqrt()
    }
}

/// N R^2 of the regression of squares on a driver; 0 where they fall with it or it is constant.
fn score(seen: Seen<'_>, driver: Driver) -> f64 {
    let (mut n, mut d, mut dd, mut e, mut ee, mut de) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for (y, t, square) in seen.known() {
        let at = driver.at(y, t);
        n += 1.0;
        d += at;
        dd += at * at;
        e += square;
        ee += square * square;
        de += at * square;
    }
    let (covariance, of_d, of_e) = (de - d * e / n, dd - d * d / n, ee - e * e / n);
    let score = n * covariance * covariance / (of_d * of_e);
    if covariance > 0.0 && score.is_finite() { score } else { 0.0 }
}

/// Logarithm of the normal likelihood of (driver, square) at a share, the scale at its best.
fn likelihood(of: &[(f64, f64)], share: f64) -> f64 {
    let n = of.len() as f64;
    let (mut weighted, mut levels) = (0.0, 0.0);
    for (d, square) in of {
        let v = 1.0 - share + share * d;
        weighted += square / v;
        levels += v.ln();
    }
    -0.5 * (n * (weighted / n).max(1e-300).ln() + levels)
}

/// The share of the largest value: the best of a list, then between its neighbours.
fn most_probable(value: impl Fn(f64) -> f64) -> f64 {
    let values = SHARES.map(&value);
    let best = (0..SHARES.len()).max_by(|&a, &b| values[a].total_cmp(&values[b])).unwrap_or(0);
    let mut low = if best == 0 { 0.0 } else { SHARES[best - 1] };
    let mut high = SHARES[(best + 1).min(SHARES.len() - 1)];
    let inner = |low: f64, high: f64| (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    for _ in 0..STEPS {
        let (a, b) = inner(low, high);
        if value(a) > value(b) { high = b } else { low = a }
    }
    0.5 * (low + high)
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

    #[test]
    fn one_variance_stays_one() {
        let some = (0..60).filter(|&seed| found(&record(2000, seed, |_, _| 1.0)).is_some());
        assert!(some.count() <= 1);
    }

    #[test]
    fn noise_that_follows_the_output_is_of_that_share() {
        let of = |y: f64, _: f64| (0.2 + 0.8 * (y - 3.0).powi(2) / 2.0).sqrt();
        let found = found(&record(4000, 3, of)).unwrap();
        assert!((found.share - 0.8).abs() < 0.06, "{found:?}");
        assert!(
            matches!(found.driver, Driver::Output { centre, .. } if (centre - 3.0).abs() < 0.01)
        );
        let ratio = found.deviation(5.0, 0.0) / found.deviation(3.0, 0.0);
        assert!((ratio / (1.8f64 / 0.2).sqrt() - 1.0).abs() < 0.2, "{ratio}");
    }

    #[test]
    fn noise_that_grows_or_fades() {
        let grows = found(&record(4000, 4, |_, t| 1.0 + 2.0 * t)).unwrap();
        assert!(matches!(grows.driver, Driver::Time { start: 0.0, .. }), "{grows:?}");
        let ratio = grows.deviation(0.0, 4000.0) / grows.deviation(0.0, 0.0);
        assert!((2.0..5.0).contains(&ratio), "{ratio}");
        let fades = found(&record(4000, 5, |_, t| 3.0 - 2.0 * t)).unwrap();
        assert!(matches!(fades.driver, Driver::Time { start: 3999.0, .. }), "{fades:?}");
    }

    #[test]
    fn samples_that_are_not_known_say_nothing() {
        let [yhat, time, mut e] = record(3000, 6, |y, _| (y - 3.0).abs() + 0.1);
        let whole = found(&[yhat.clone(), time.clone(), e.clone()]).unwrap();
        e[..1000].fill(0.0);
        let part = found(&[yhat, time, e]).unwrap();
        assert!((whole.share - part.share).abs() < 0.1, "{whole:?} {part:?}");
    }
}
