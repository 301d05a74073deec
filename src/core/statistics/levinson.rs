//! Levinson's recursion: the best linear predictors of order 0, 1, .. from autocovariances
//! (Durbin 1960; Brockwell and Davis, Time Series: Theory and Methods, section 5.2).

/// A prediction from past values, e\[k\] + f1 e\[k-1\] + .. + fp e\[k-p\] = eps\[k\].
#[derive(Debug, Clone, PartialEq)]
pub struct Predictor {
    /// 1, f1 .. fp: the filter that leaves the prediction error.
    pub filter: Vec<f64>,
    /// Variance of that error, in the unit of the autocovariances.
    pub variance: f64,
}

impl Predictor {
    /// Coefficients a1 .. ap of e\[k\] = a1 e\[k-1\] + .. + ap e\[k-p\] + eps\[k\].
    pub fn coefficients(&self) -> Vec<f64> {
        self.filter[1..].iter().map(|f| -f).collect()
    }
}

/// Predictors of order 0 to at most `r.len() - 1` from autocovariances `r` at lags 0, 1, ..;
/// fewer where one of them leaves nothing or the recursion meets a number that is none. None where
/// `r` is empty.
///
/// f(m)\[i\] = f(m-1)\[i\] + k f(m-1)\[m-i\], v(m) = v(m-1) (1 - k^2),
/// k = -sum over i < m of f(m-1)\[i\] r\[m-i\] / v(m-1).
pub fn levinson(r: &[f64]) -> Vec<Predictor> {
    let Some(&variance) = r.first() else { return vec![] };
    let mut last = Predictor { filter: vec![1.0], variance };
    let mut found = vec![last.clone()];
    for m in 1..r.len() {
        let met: f64 = (0..m).map(|i| last.filter[i] * r[m - i]).sum();
        let reflection = -met / last.variance;
        if !(reflection.abs() < 1.0) {
            break;
        }
        last.filter.push(0.0);
        let before = last.filter.clone();
        for i in 1..=m {
            last.filter[i] += reflection * before[m - i];
        }
        last.variance *= 1.0 - reflection * reflection;
        found.push(last.clone());
    }
    found
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::levinson;

    #[test]
    fn a_process_of_second_order_is_predicted_by_its_own_equation() {
        // e[k] = 1.2 e[k-1] - 0.5 e[k-2] + eps of variance 1, by the Yule-Walker equations
        let (a, b) = (1.2, -0.5);
        let r1 = a / (1.0 - b);
        let r2 = a * r1 + b;
        let power = 1.0 / (1.0 - a * r1 - b * r2);
        let r = [power, power * r1, power * r2, power * (a * r2 + b * r1)];
        let found = levinson(&r);
        assert_eq!(found.len(), 4);
        assert_relative_eq!(found[2].filter[1], -a, epsilon = 1e-12);
        assert_relative_eq!(found[2].filter[2], -b, epsilon = 1e-12);
        assert_relative_eq!(found[2].variance, 1.0, epsilon = 1e-12);
        assert!(found[3].filter[3].abs() < 1e-12);
    }

    #[test]
    fn what_repeats_exactly_and_what_is_nothing_end_the_recursion() {
        assert_eq!(levinson(&[2.0, 2.0, 2.0]).len(), 1);
        assert_eq!(levinson(&[0.0, 0.0]).len(), 1);
        assert!(levinson(&[]).is_empty());
    }
}
