//! What output equations say beside what a sensor reads of the states: rates, and balances of their own.
//!
//! Around a point a model is dx/dt = A x + B u, y = C x + D u. A row (c, d) of (C, D) with d = 0 is mostly what
//! a sensor reads of the states: laws of physics act before it, in the channels of the states. An output that
//! [reads rates](super::rate_readings), such as an acceleration, reads what enters dx/dt by G w as k G w at
//! once (D_yw of the linear fractional representation: Hoekstra et al., eq. `interconn_mx`). Any other row
//! with d != 0 is a balance of its own, such as the torque J q'' + g sin q of an inverse dynamic model (Spong,
//! Hutchinson and Vidyasagar, "Robot Modeling and Control", 2006, section 7.3): a law that is missing there
//! enters no state.

use super::rate_readings::Readings;
use super::rates::points;
use crate::model::probe::{Along, Point, slope, unit};
use crate::model::{Ask, LaneNumber, Law, Sizes};

/// Points that are looked at.
const POINTS: usize = 4;

/// What the output equations of a law are.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct OutputEquations {
    /// Per output whether its equation is a balance of its own.
    pub balances: Vec<bool>,
    /// Outputs that are rates: their number, and the states whose rates they sum, with factors.
    pub rates: Vec<(usize, Vec<(usize, f64)>)>,
}

impl OutputEquations {
    /// Those of a law, looked at around random points.
    pub fn of(law: &dyn Law) -> Self {
        let signals = law.signals();
        let (sizes, continuous) = (Sizes::of(&signals), signals.time.is_continuous());
        let points = points(law, POINTS);
        let reached = reached(law, sizes, &points);
        if sizes.x == 0 {
            return Self { balances: reached, rates: vec![] };
        }
        let readings = Readings::new(law, sizes, &points);
        let mut found = Self::default();
        for (o, &reached) in reached.iter().enumerate() {
            let parts = if continuous { readings.rates(o, reached) } else { vec![] };
            let is_force = || reached && readings.is_force(o);
            found.balances.push(reached && parts.is_empty() && !is_force());
            if !parts.is_empty() {
                found.rates.push((o, parts));
            }
        }
        found
    }

    /// Whether any output reads rates of states.
    pub fn reads_rates(&self) -> bool {
        !self.rates.is_empty()
    }

    /// Adds to outputs that are rates what makes the rates of the states `with` out of `without`; all pack
    /// by pack, of as many states and outputs as there are.
    pub fn add_rates<R: LaneNumber>(&self, sizes: Sizes, y: &mut [R], [with, without]: [&[R]; 2]) {
        if sizes.x == 0 {
            return;
        }
        let packs = with.chunks_exact(sizes.x).zip(without.chunks_exact(sizes.x));
        for (y, (with, without)) in y.chunks_exact_mut(sizes.y.max(1)).zip(packs) {
            for (output, parts) in &self.rates {
                for &(state, factor) in parts {
                    y[*output] += (with[state] - without[state]) * factor;
                }
            }
        }
    }
}

/// Per output whether an input enters its equation.
fn reached(law: &dyn Law, sizes: Sizes, points: &[Point]) -> Vec<bool> {
    let mut reached = vec![false; sizes.y];
    for i in 0..sizes.u {
        let along = unit(sizes.u, i);
        for point in points {
            let slopes = slope(law, sizes, Ask::Output, point, Along::Input(&along));
            let enters = slopes.iter().map(|slope| slope.is_finite() && *slope != 0.0);
            reached.iter_mut().zip(enters).for_each(|(all, one)| *all |= one);
        }
    }
    reached
}

#[cfg(test)]
mod tests {
    use super::OutputEquations;
    use crate::file::{Format, parse};

    /// A mass on a spring with these further outputs.
    fn found(outputs: &str, states: &str) -> OutputEquations {
        let text = format!(
            "sampling_time = 0.01\n[model.equations]\ninputs = [{{ name = \"F\" }}, {{ name = \"a\" }}]\n\
             states = [{states}]\noutputs = [{outputs}]\n\
             parameters = [{{ name = \"m\", value = 2.0 }}, {{ name = \"k\", value = 3.0 }}]\n"
        );
        let system = parse(&text, "mass.toml", Format::Toml).unwrap();
        OutputEquations::of(system.model.as_ref())
    }

    #[test]
    fn readings_rates_and_balances() {
        let states =
            r#"{ name = "q", derivative = "v" }, { name = "v", derivative = "(F - k*q^3)/m" }"#;
        let outputs = r#"{ name = "y", value = "q^2" }, { name = "z", value = "2*(F - k*q^3)/m + v" },
                         { name = "f", value = "F + k*q^3" }, { name = "b", value = "m*a + v" },
                         { name = "force", value = "F - k*q^3" }"#;
        let found = found(outputs, states);
        // a force that is m v' is a rate by a factor that may be wrong, and nothing of its own
        assert_eq!(found.balances, [false, false, true, true, false]);
        // the speed that is read beside the rate is no rate that anything enters
        let [(1, parts)] = &found.rates[..] else { panic!("{found:?}") };
        let [(1, factor)] = parts[..] else { panic!("{parts:?}") };
        assert!((factor - 2.0).abs() < 1e-9, "{factor}");
    }

    #[test]
    fn without_states_every_output_of_an_input_is_a_balance() {
        let outputs = r#"{ name = "y", value = "m*a - F^2" }, { name = "constant", value = "k" }"#;
        assert_eq!(found(outputs, "").balances, [true, false]);
    }
}
