//! Residual test of model adequacy: does what the model leaves depend on what went before?
//!
//! `r = y - y_hat` is put to the score test of a dynamic regression ([`Regression`]) against
//! what a wrong model would leave: a constant and a trend, the sensitivities of `y_hat` to the free
//! parameters, and curves of `y_hat` and of past inputs. Its p-value is uniform if the model is
//! right, whatever the colour of the noise. `y_hat` is simulated, or, where noise inside the plant is
//! more probable than a simulation with coloured noise, what a predictor foresees of the next sample.
//! A plant that forgets slowly makes of such noise nearly a random walk, which no short
//! autoregression whitens; what forgets nothing makes one of it, and the regressions of that have
//! no such distribution (Dickey and Fuller, Journal of the American Statistical Association 74,
//! 1979).
//!
//! The input of the same sample is tested where it reaches the output without a state in between.
//! Elsewhere a right model leaves it out, and a controller that reads the output makes it follow
//! the noise (Ljung, "System Identification", 2nd ed., section 16.6).
//!
//! Outputs are combined by the Cauchy combination (Liu and Xie, Journal of the American
//! Statistical Association 115, 2020), which holds for outputs whose noises belong together.

use crate::data::Record;
use crate::evaluate::EvaluateError;
use crate::innovations::Rivals;
use crate::likelihood::{Fitted, Noise, NoiseModel, Predictor};
use crate::prepare::windows::windows;
use crate::segmentation::horizon;
use crate::statistics::Regression;
use crate::system::System;
use crate::validate::independent::{LAGS, curves};
use crate::validate::residuals::Residuals;

/// Probability of as much dependence of what a system leaves of records if it is right; `None` where
/// they are too short to tell. Long records are looked at in windows.
///
/// # Errors
///
/// If system and records do not go together.
pub(crate) fn p_value(system: &System, records: &[Record]) -> Result<Option<f64>, EvaluateError> {
    let windows = windows(records);
    let records = windows.as_deref().unwrap_or(records);
    let predicted = calls_for(system, records)?
        .and_then(|(predictor, noise)| Residuals::predicted(system, records, (&predictor, &noise)));
    let residuals = predicted.map_or_else(|| Residuals::simulated(system, records), Ok)?;
    let each = (0..residuals.left.len()).filter_map(|o| of_output(&residuals, o));
    Ok(combined(&each.collect::<Vec<_>>()))
}

/// The predictor of a system on records that call for one, and its noise: noise inside the plant is more
/// probable than a free run with coloured noise, or no free run follows them from a start that it forgets.
fn calls_for(
    system: &System,
    records: &[Record],
) -> Result<Option<(Predictor, Noise)>, EvaluateError> {
    let is_followed = horizon(system, records)?.is_none();
    let Ok(predictor) = Predictor::new(system, records) else { return Ok(None) };
    let rivals = Rivals::of(&predictor);
    let is_simulated = is_followed && predictor.forgets().unwrap_or(true);
    Ok(match rivals.inside {
        Some(_) if is_simulated && !rivals.call_for_more(0.0) => None,
        Some(Fitted { noise: NoiseModel::Predictor(noise), .. }) => Some((predictor, noise)),
        _ => None,
    })
}

/// The test of what is left of an output.
fn of_output(of: &Residuals, o: usize) -> Option<f64> {
    let series = &of.left[o];
    let n = series.len();
    let mut tested = of.sensitivities[o].clone();
    tested.push(vec![1.0; n]);
    tested.push((0..n).map(|k| k as f64 / n.max(1) as f64).collect());
    tested.extend(curves(&of.given[o], 0));
    for lag in of.first_lags[o]..=LAGS {
        for input in &of.inputs {
            tested.extend(curves(input, lag));
        }
        if lag > 0 && lag < 3 {
            tested.extend(curves(&of.given[o], lag));
        }
    }
    let regression = Regression {
        r: series,
        segments: &of.segments,
        nuisance: &of.of_starts[o],
        tested: &tested,
    };
    regression.test().map(|dependence| dependence.p_value)
}

/// Cauchy combination of p-values.
fn combined(p: &[f64]) -> Option<f64> {
    match p {
        [] => None,
        [one] => Some(*one),
        // tan((1/2 - p) pi) is 1 / (p pi) where p is so small that 1/2 - p is 1/2
        _ => {
            let score = |p: &f64| match *p {
                p if p < 1e-15 => 1.0 / (p.max(f64::MIN_POSITIVE) * std::f64::consts::PI),
                p => ((0.5 - p) * std::f64::consts::PI).tan(),
            };
            let sum = p.iter().map(score).sum::<f64>() / p.len() as f64;
            Some(match sum {
                sum if sum > 1e15 => 1.0 / (sum * std::f64::consts::PI),
                sum => (0.5 - sum.atan() / std::f64::consts::PI).clamp(0.0, 1.0),
            })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Random;
    use lacuna_core::file::{Format, parse};

    #[test]
    fn p_values_combine() {
        assert_eq!(combined(&[]), None);
        assert_eq!(combined(&[0.3]), Some(0.3));
        let close = |a: Option<f64>, b: f64| (a.unwrap() / b - 1.0).abs() < 1e-6;
        assert!(close(combined(&[0.2, 0.2]), 0.2));
        assert!(close(combined(&[1e-200, 0.5]), 2e-200));
        assert!(close(combined(&[1e-10, 0.5]), 2e-10));
    }

    /// x' = K u - a x, both held over 0.1 s.
    fn first_order(k: f64, a: f64) -> System {
        let text = format!(
            "sampling_time = 0.1\n[model.equations]\ninputs = [{{ name = \"u\" }}]\n\
             states = [{{ name = \"x\", derivative = \"K*u - a*x\" }}]\n\
             outputs = [{{ name = \"y\", value = \"x\" }}]\nparameters = [\
             {{ name = \"K\", value = {k} }}, {{ name = \"a\", value = {a}, fixed = true }}]\n"
        );
        parse(&text, "first.toml", Format::Toml).unwrap()
    }

    /// What disturbs the machine with K = 2, and what drives it.
    struct Machine {
        a: f64,
        /// Pole of the sensor's noise, whose deviation is 0.1.
        pole: f64,
        /// Deviation of what is added to the input and not recorded.
        inside: f64,
        /// Gain of a controller that reads the output; an input of its own without one.
        feedback: Option<f64>,
    }

    impl Machine {
        fn record(&self, seed: u64, n: usize) -> Record {
            let mut random = Random::new(seed);
            let (mut reference, mut x, mut v) = (0.0, 0.0, 0.0);
            let (mut inputs, mut outputs) = (vec![], vec![]);
            let (a, pole) = (self.a, self.pole);
            let (kept, gained) = match a {
                0.0 => (1.0, 0.1),
                a => ((-0.1 * a).exp(), (1.0 - (-0.1 * a).exp()) / a),
            };
            for _ in 0..n {
                v = pole * v + 0.1 * (1.0 - pole * pole).sqrt() * random.normal();
                let u = self.feedback.map_or(reference, |gain| gain * (reference - x - v));
                inputs.push(u);
                outputs.push(x + v);
                x = kept * x + gained * 2.0 * (u + self.inside * random.normal());
                reference = 0.8 * reference + random.normal();
            }
            Record::new(0.1).input("u", inputs).unwrap().output("y", outputs).unwrap()
        }

        /// Distance of the p-values of the right model from an even spread (Kolmogorov-Smirnov).
        fn distance(&self, count: u64) -> f64 {
            let system = first_order(2.0, self.a);
            let of = |seed| p_value(&system, &[self.record(500 + seed, 400)]).unwrap().unwrap();
            let mut p: Vec<f64> = (0..count).map(of).collect();
            p.sort_by(f64::total_cmp);
            let n = p.len() as f64;
            let off = |(k, p): (usize, &f64)| (p - k as f64 / n).max((k + 1) as f64 / n - p);
            n.sqrt() * p.iter().enumerate().map(off).fold(0.0, f64::max)
        }

        /// Whether a model with K = 2.2 is rejected.
        fn rejects(&self) -> bool {
            let p = p_value(&first_order(2.2, self.a), &[self.record(1, 1200)]).unwrap();
            p.unwrap() < 1e-4
        }
    }

    /// Level of the distance that chance passes once in a hundred.
    const UNEVEN: f64 = 1.63;

    /// `check` on right models: the p-values spread evenly, also where the noise remembers a tenth of the
    /// record.
    #[test]
    fn a_right_model_is_rejected_as_often_as_was_said() {
        for pole in [0.0, 0.9] {
            let machine = Machine { a: 1.0, pole, inside: 0.0, feedback: None };
            let d = machine.distance(120);
            assert!(d < UNEVEN && machine.rejects(), "pole {pole}: {d}");
        }
    }

    /// The input of a sample follows from the noise of the same sample, in a plant that forgets and in one
    /// that integrates, with noise at the sensor and inside the plant.
    #[test]
    fn so_it_is_in_a_closed_loop() {
        for (a, inside) in [(1.0, 0.0), (0.0, 0.0), (0.0, 0.5), (1.0, 0.5)] {
            let machine = Machine { a, pole: 0.0, inside, feedback: Some(2.0) };
            let d = machine.distance(60);
            assert!(d < UNEVEN && machine.rejects(), "a {a}, inside {inside}: {d}");
        }
    }

    /// Noise that a slow plant adds up is nearly a random walk.
    #[test]
    fn so_it_is_where_a_slow_plant_is_disturbed() {
        let machine = Machine { a: 0.05, pole: 0.0, inside: 0.3, feedback: None };
        let d = machine.distance(60);
        assert!(d < UNEVEN && machine.rejects(), "{d}");
    }
}
