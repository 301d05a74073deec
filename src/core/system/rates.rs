//! Which signal is the rate of change of which: found from the law itself.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::model::probe::{Along, Point, slope, value};
use crate::model::{Ask, Law, Signal, Sizes};

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
    /// Its unit as text, empty where none is declared.
    units: Vec<String>,
    /// States whose derivative is another state whatever the parameters are.
    defined: Vec<bool>,
    /// Per input the input that is declared to be its rate of change.
    of_inputs: Vec<Option<usize>>,
}

/// How much larger the parameters of a second look are.
pub(super) const OTHER: f64 = 1.37;

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
        let of_inputs = rates_of_inputs(&signals.inputs);
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
            let du: Vec<Option<f64>> = of_inputs.iter().map(|v| v.map(|v| point.u[v])).collect();
            let known: Vec<f64> = du.iter().map(|du| du.unwrap_or(0.0)).collect();
            let rate = |ask| -> Vec<f64> {
                let of_states = slope(law, sizes, ask, &point, Along::State(&dx));
                let of_inputs = slope(law, sizes, ask, &point, Along::Input(&known));
                of_states.iter().zip(&of_inputs).map(|(x, u)| x + u).collect()
            };
            let (dz, dy) = (rate(Ask::Coordinates), rate(Ask::Output));
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
            let du: Vec<f64> = du.iter().map(|du| du.unwrap_or(f64::NAN)).collect();
            let rates = pick(&dx, &dz, &dy, &du, 1.0);
            if continuous {
                seen.push((values, rates));
            }
        }
        let origins = sources.entries.iter().map(|(_, origin)| *origin).collect();
        let units = sources.entries.iter().map(|(signal, _)| signal.unit.clone()).collect();
        Self { seen, origins, units, defined, of_inputs }
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
            match self.origins[other] {
                Origin::Time => return None,
                Origin::Input(i) if !self.of_inputs.contains(&Some(i)) => return None,
                _ => {}
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

    /// Whether `entry` is the rate of some other state or coordinate. What has the unit of that is none, but
    /// what is left to go, as `command - angle` of a servo.
    pub fn is_rate(&self, entry: usize) -> bool {
        let unit = &self.units[entry];
        (0..self.origins.len()).any(|other| {
            matches!(self.origins[other], Origin::Own(_) | Origin::State(_))
                && (unit.is_empty() || *unit != self.units[other])
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

    /// Whether one entry is always the other in another unit: a positive multiple of it.
    pub fn is_multiple(&self, a: usize, b: usize) -> bool {
        let Some(first) = self.seen.iter().find(|(values, _)| values[b] != 0.0) else {
            return self.same(a, b);
        };
        let factor = first.0[a] / first.0[b];
        let holds =
            |values: &[f64]| (values[a] - factor * values[b]).abs() <= 1e-12 * values[a].abs();
        factor > 0.0 && self.seen.iter().all(|(values, _)| holds(values))
    }
}

/// Per input the input that is its rate of change, as quantities and units declare: a velocity in the unit
/// of one other input per second, and of no more than that one.
fn rates_of_inputs(inputs: &[Signal]) -> Vec<Option<usize>> {
    let is_velocity = |i: usize| inputs[i].quantity.as_ref().is_some_and(|q| q.is_velocity());
    let is_rate = |v: usize, p: usize| {
        is_velocity(v)
            && !is_velocity(p)
            && !inputs[p].unit.is_empty()
            && inputs[v].unit == format!("{}/s", inputs[p].unit)
    };
    let only = |mut found: Vec<usize>| found.pop().filter(|_| found.is_empty());
    let all = 0..inputs.len();
    let rate = |p: usize| only(all.clone().filter(|&v| is_rate(v, p)).collect());
    let moves = |v: usize| only(all.clone().filter(|&p| is_rate(v, p)).collect());
    all.clone().map(|p| rate(p).filter(|&v| moves(v) == Some(p))).collect()
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

    #[test]
    fn what_is_left_to_go_is_no_velocity() {
        let velocity = |unit: &str| {
            let text = format!(
                "sampling_time = 0.1\n[model.equations]\ninputs = [{{ name = \"command\", unit = \"deg\" }}]\n\
                 states = [{{ name = \"rudder\", unit = \"deg\", derivative = \"(command - rudder)/t\" }}]\n\
                 outputs = [{{ name = \"angle\", value = \"rudder\" }}]\nparameters = [{{ name = \"t\", value = 2.0 }}]\n\
                 coordinates = [{{ name = \"demand\", unit = \"{unit}\", value = \"command - rudder\" }}]\n"
            );
            let plan = parse(&text, "rudder.toml", Format::Toml).unwrap().plan(0.1).unwrap();
            plan.is_velocity(plan.sources.find("demand").unwrap())
        };
        // a rate but for a factor, in the unit of what it would be the rate of
        assert!(!velocity("deg"));
        assert!(velocity("deg/s") && velocity(""));
    }

    #[test]
    fn a_signal_in_another_unit_is_a_multiple() {
        let text = "sampling_time = 0.01\n[model.equations]\ninputs = [{ name = \"u\" }]\n\
             states = [{ name = \"p\", derivative = \"u - p\" }]\n\
             outputs = [{ name = \"mm\", value = \"1000*p\" }, { name = \"other\", value = \"-p\" }, \
             { name = \"curve\", value = \"p*p\" }]\n";
        let plan = parse(text, "one.toml", Format::Toml).unwrap().plan(0.01).unwrap();
        let at = |name: &str| plan.sources.find(name).unwrap();
        let of_p = |name: &str| plan.rates.is_multiple(at("p"), at(name));
        assert_eq!(["mm", "other", "curve", "u"].map(of_p), [true, false, false, false]);
    }

    #[test]
    fn a_recorded_velocity_is_the_rate_of_the_one_position_of_its_unit() {
        let rate = |inputs: &[(&str, &str, &str)]| {
            let list: Vec<String> = inputs
                .iter()
                .map(|(name, unit, quantity)| {
                    format!("{{ name = \"{name}\", unit = \"{unit}\"{quantity} }}")
                })
                .collect();
            let text = format!(
                "sampling_time = 0.01\n[model.equations]\ninputs = [{}]\n\
                 outputs = [{{ name = \"y\", value = \"2*q\" }}]\n",
                list.join(", ")
            );
            let system = parse(&text, "still.toml", Format::Toml).unwrap();
            let plan = system.plan(0.01).unwrap();
            let name = |entry: usize| plan.sources.entries[entry].0.name.clone();
            ["q", "y"].map(|of| {
                let of = plan.sources.find(of).unwrap();
                plan.rates.rate(of).map(|(rate, factor)| (name(rate), factor))
            })
        };
        let velocity = ", quantity = \"velocity\"";
        let both = [("q", "rad", ""), ("w", "rad/s", velocity)];
        let found = |factor| Some(("w".to_string(), factor));
        assert_eq!(rate(&both), [found(1.0), found(2.0)]);
        // not declared, of another unit, or of two of them
        assert_eq!(rate(&[("q", "rad", ""), ("w", "rad/s", "")]), [None, None]);
        assert_eq!(rate(&[("q", "rad", ""), ("w", "m/s", velocity)]), [None, None]);
        let two = [both[0], both[1], ("p", "rad", ""), ("r", "rad/s", velocity)];
        assert_eq!(rate(&two), [None, None]);
    }
}
