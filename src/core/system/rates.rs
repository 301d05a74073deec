//! Which signal is the rate of change of which: found from the law itself.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::model::probe::{Along, Point, slope, value};
use crate::model::{Ask, Law, Sizes};

use super::tables::{Origin, Sources};

/// Points at which an identity must hold to be believed.
const POINTS: usize = 6;

/// A law seen at a few random points.
#[derive(Debug)]
pub struct Rates {
    /// Values of every source at every point, and their rates with nothing missing.
    seen: Vec<(Vec<f64>, Vec<f64>)>,
    /// What each entry is.
    origins: Vec<Origin>,
    /// States whose derivative is another state whatever the parameters are.
    defined: Vec<bool>,
}

/// How much larger the parameters of a second look are.
const OTHER: f64 = 1.37;

/// Random points around the model's initial state, all positive so that roots exist.
pub fn points(law: &dyn Law, count: usize) -> Vec<Point> {
    let signals = law.signals();
    let sizes = Sizes::of(&signals);
    let mut random = ChaCha8Rng::seed_from_u64(17);
    let mut around = |n: usize, centre: &[f64]| -> Vec<f64> {
        (0..n)
            .map(|i| {
                let centre = centre.get(i).copied().unwrap_or(0.0);
                centre
                    + (0.1 + random.random::<f64>())
                        * if centre == 0.0 { 1.0 } else { 0.2 * centre.abs() }
            })
            .collect()
    };
    (0..count)
        .map(|_| Point {
            theta: signals.theta(),
            x: around(sizes.x, &signals.initial()),
            u: around(sizes.u, &[]),
            w: vec![0.0; sizes.w],
            time: 0.3,
        })
        .collect()
}

impl Rates {
    pub fn of(law: &dyn Law) -> Self {
        let signals = law.signals();
        let sizes = Sizes::of(&signals);
        let sources = Sources::of(&signals);
        let continuous = signals.time.is_continuous();
        let mut seen = vec![];
        let mut defined = vec![continuous; sizes.x];
        for point in points(law, POINTS) {
            let z = value(law, sizes, Ask::Coordinates, &point);
            let y = value(law, sizes, Ask::Output, &point);
            let dx = value(law, sizes, Ask::Derivative, &point);
            let mut other = point.clone();
            other.theta.iter_mut().for_each(|value| *value *= OTHER);
            let again = value(law, sizes, Ask::Derivative, &other);
            for (i, defined) in defined.iter_mut().enumerate() {
                let is = |j: usize| i != j && dx[i] == point.x[j] && again[i] == point.x[j];
                *defined &= (0..sizes.x).any(is);
            }
            let dz = slope(law, sizes, Ask::Coordinates, &point, Along::State(&dx));
            let dy = slope(law, sizes, Ask::Output, &point, Along::State(&dx));
            let pick = |states: &[f64], own: &[f64], outputs: &[f64], inputs: &[f64], time: f64| {
                sources
                    .entries
                    .iter()
                    .map(|(_, origin)| match *origin {
                        Origin::Own(i) if signals.coordinates.is_empty() => states[i],
                        Origin::Own(i) => own[i],
                        Origin::Input(i) => inputs[i],
                        Origin::Output(i) => outputs[i],
                        Origin::Time => time,
                        Origin::State(i) => states[i],
                    })
                    .collect::<Vec<_>>()
            };
            let values = pick(&point.x, &z, &y, &point.u, point.time);
            let nothing = vec![f64::NAN; sizes.u];
            let rates = pick(&dx, &dz, &dy, &nothing, 1.0);
            if continuous {
                seen.push((values, rates));
            }
        }
        let origins = sources.entries.iter().map(|(_, origin)| *origin).collect();
        Self { seen, origins, defined }
    }

    /// Whether the equation of a state only says what another state is (q' = v): nothing can be
    /// missing there, and nothing can push.
    pub fn is_definition(&self, state: usize) -> bool {
        self.defined.get(state).copied().unwrap_or(false)
    }

    /// The entry, and the factor on it, that equals the rate of change of `entry`.
    pub fn rate(&self, entry: usize) -> Option<(usize, f64)> {
        if self.seen.is_empty() || self.origins[entry] == Origin::Time {
            return None;
        }
        (0..self.origins.len()).find_map(|other| {
            if matches!(self.origins[other], Origin::Time | Origin::Input(_)) {
                return None;
            }
            let (values, rates) = &self.seen[0];
            let factor = rates[entry] / values[other];
            let holds = factor.is_finite()
                && factor != 0.0
                && self.seen.iter().all(|(values, rates)| {
                    let scale = rates[entry].abs().max(1e-12);
                    (rates[entry] - factor * values[other]).abs() < 1e-9 * scale
                });
            holds.then_some((other, factor))
        })
    }

    /// Whether `entry` is the rate of some other state or coordinate.
    pub fn is_rate(&self, entry: usize) -> bool {
        (0..self.origins.len()).any(|other| {
            matches!(self.origins[other], Origin::Own(_) | Origin::State(_))
                && self.rate(other).is_some_and(|(found, _)| self.same(found, entry))
        })
    }

    /// Whether two entries always have the same value.
    pub fn same(&self, a: usize, b: usize) -> bool {
        a == b
            || !self.seen.is_empty()
                && self.seen.iter().all(|(values, _)| {
                    (values[a] - values[b]).abs() <= 1e-12 * values[a].abs().max(1e-12)
                })
    }
}

#[cfg(test)]
mod tests {
    use crate::file::{Format, parse};

    #[test]
    fn a_derivative_that_is_another_state_is_a_definition() {
        let text = |of_q: &str| {
            format!(
                "sampling_time = 0.01\n[model.equations]\ninputs = [{{ name = \"u\" }}]\n\
                 states = [{{ name = \"q\", derivative = \"{of_q}\" }}, {{ name = \"v\", derivative = \"u - c*v\" }}]\n\
                 outputs = [{{ name = \"y\", value = \"q\" }}]\nparameters = [{{ name = \"c\", value = 1.0 }}]\n"
            )
        };
        let rates = |of_q: &str| {
            let system = parse(&text(of_q), "two.toml", Format::Toml).unwrap();
            let plan = system.plan(0.01).unwrap();
            [0, 1].map(|state| plan.rates.is_definition(state))
        };
        assert_eq!(rates("v"), [true, false]);
        // a factor of 1 that is a parameter may be wrong
        assert_eq!(rates("c*v"), [false, false]);
        assert_eq!(rates("v - q"), [false, false]);
    }
}
