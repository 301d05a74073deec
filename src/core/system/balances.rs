//! Output equations that an input enters directly, and that say more than how fast a state changes.
//!
//! Around a point a model is dx/dt = A x + B u, y = C x + D u. A row (c, d) of (C, D) with d = 0 is what a
//! sensor reads of the states: laws of physics act before it, in the channels of the states. With d != 0
//! and (c, d) = k (A, B) for one k at all points it is the reading of an acceleration or a flow: what it
//! lacks is lacking in dx/dt too. Any other row with d != 0 is a balance of its own, such as the torque
//! J q'' + g sin q of an inverse dynamic model (Spong, Hutchinson and Vidyasagar, "Robot Modeling and
//! Control", 2006, section 7.3): a law that is missing there enters no state.

use nalgebra::{DMatrix, DVector};

use super::rates::points;
use crate::model::probe::{Along, Point, matrices, slope, unit};
use crate::model::{Ask, Law, Sizes};

/// Points that are looked at.
const POINTS: usize = 4;
/// How closely a row is the derivative of something, as a share of it.
const EXACT: f64 = 1e-9;

/// Per output whether its equation is a balance of its own.
pub fn balances(law: &dyn Law) -> Vec<bool> {
    let sizes = Sizes::of(&law.signals());
    let points = points(law, POINTS);
    let reached = reached(law, sizes, &points);
    if sizes.x == 0 || !reached.contains(&true) {
        return reached;
    }
    let columns = sizes.x + sizes.u;
    let mut moves = DMatrix::zeros(points.len() * columns, sizes.x);
    let mut reads = DMatrix::zeros(points.len() * columns, sizes.y);
    for (p, point) in points.iter().enumerate() {
        let at = matrices(law, sizes, point);
        for (from, a, c) in [(0, &at.a, &at.c), (sizes.x, &at.b, &at.d)] {
            let first = p * columns + from;
            moves.rows_mut(first, a.ncols()).copy_from(&a.transpose());
            reads.rows_mut(first, c.ncols()).copy_from(&c.transpose());
        }
    }
    // where the law has no slope nothing is compared
    for k in 0..moves.nrows() {
        let finite = moves.row(k).iter().chain(reads.row(k).iter()).all(|v| v.is_finite());
        if !finite {
            moves.row_mut(k).fill(0.0);
            reads.row_mut(k).fill(0.0);
        }
    }
    let svd = moves.clone().svd(true, true);
    let smallest = f64::EPSILON * svd.singular_values.max();
    let is_rate = |row: DVector<f64>| {
        svd.solve(&row, smallest).is_ok_and(|k| (&row - &moves * k).norm() <= EXACT * row.norm())
    };
    let is = |o: usize| reached[o] && !is_rate(reads.column(o).into_owned());
    (0..sizes.y).map(is).collect()
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
    use super::balances;
    use crate::file::{Format, parse};

    /// Whether each output of a mass on a spring with these further outputs is a balance of its own.
    fn found(outputs: &str, states: &str) -> Vec<bool> {
        let text = format!(
            "sampling_time = 0.01\n[model.equations]\ninputs = [{{ name = \"F\" }}, {{ name = \"a\" }}]\n\
             states = [{states}]\noutputs = [{outputs}]\n\
             parameters = [{{ name = \"m\", value = 2.0 }}, {{ name = \"k\", value = 3.0 }}]\n"
        );
        let system = parse(&text, "mass.toml", Format::Toml).unwrap();
        balances(system.model.as_ref())
    }

    #[test]
    fn a_reading_and_an_acceleration_are_no_balances() {
        let states =
            r#"{ name = "q", derivative = "v" }, { name = "v", derivative = "(F - k*q^3)/m" }"#;
        let outputs = r#"{ name = "y", value = "q^2" }, { name = "z", value = "2*(F - k*q^3)/m" },
                         { name = "f", value = "F + k*q^3" }, { name = "b", value = "m*a + v" }"#;
        assert_eq!(found(outputs, states), [false, false, true, true]);
    }

    #[test]
    fn without_states_every_output_of_an_input_is_a_balance() {
        let outputs = r#"{ name = "y", value = "m*a - F^2" }, { name = "constant", value = "k" }"#;
        assert_eq!(found(outputs, ""), [true, false]);
    }
}
