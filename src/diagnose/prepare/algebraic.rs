//! Output equations that an input enters directly, and that say more than how fast a state changes.
//!
//! Around a point of the record a model is dx/dt = A x + B u, y = C x + D u. A row (c, d) of (C, D) with
//! d = 0 is what a sensor reads of the states: laws of physics act before it, in the channels of the
//! states. With d != 0 and (c, d) = k (A, B) for one k along the record it is the reading of an
//! acceleration or a flow: what it lacks is lacking in dx/dt too. Any other row with d != 0 is a balance
//! of its own, such as the torque J q'' + g sin q of an inverse dynamic model (Spong, Hutchinson and
//! Vidyasagar, "Robot Modeling and Control", 2006, section 7.3): a law that is missing there enters no
//! state.

use nalgebra::{DMatrix, DVector};

use crate::model::probe::{Point, matrices};
use crate::model::{Matrices, Sizes, StateSpaceModel};

/// How closely a row is the derivative of something, as a share of it.
const EXACT: f64 = 1e-9;

/// Slopes of the outputs by the inputs and by the outputs' own additions.
pub(crate) struct Algebraic {
    /// Per input the slopes of all outputs at every point, 0 for outputs that are no balance.
    direct: Vec<Vec<f64>>,
    /// Whether an output is a balance of its own.
    is: Vec<bool>,
    points: usize,
}

impl Algebraic {
    /// Which outputs of a model are balances of their own, looked at around `points`.
    pub fn new(model: &dyn StateSpaceModel, sizes: Sizes, points: &[Point]) -> Self {
        let at: Vec<Matrices> = points.iter().map(|point| matrices(model, sizes, point)).collect();
        let columns = sizes.x + sizes.u;
        let mut moves = DMatrix::zeros(at.len() * columns, sizes.x);
        let mut reads = DMatrix::zeros(at.len() * columns, sizes.y);
        for (p, point) in at.iter().enumerate() {
            for (from, a, c) in [(0, &point.a, &point.c), (sizes.x, &point.b, &point.d)] {
                let first = p * columns + from;
                moves.rows_mut(first, a.ncols()).copy_from(&a.transpose());
                reads.rows_mut(first, c.ncols()).copy_from(&c.transpose());
            }
        }
        let is: Vec<bool> = (0..sizes.y)
            .map(|o| {
                let reached = at.iter().any(|point| point.d.row(o).iter().any(|d| *d != 0.0));
                reached && !is_rate(&moves, reads.column(o).into_owned())
            })
            .collect();
        let slopes = |i: usize| -> Vec<f64> {
            let own = |d: &DMatrix<f64>, o: usize| if is[o] { d[(o, i)] } else { 0.0 };
            at.iter().flat_map(|point| (0..sizes.y).map(|o| own(&point.d, o))).collect()
        };
        let direct = (0..sizes.u).map(slopes).collect();
        Self { direct, is, points: points.len() }
    }

    /// Whether an output is a balance of its own.
    pub fn is(&self, output: usize) -> bool {
        self.is.get(output).copied().unwrap_or(false)
    }

    /// What one unit into an input does to the balances, point after point.
    pub fn of_input(&self, input: usize) -> Vec<f64> {
        self.direct[input].clone()
    }

    /// What one unit into an output does to the balances.
    pub fn of_output(&self, output: usize) -> Vec<f64> {
        let own = |o: usize| if o == output && self.is[o] { 1.0 } else { 0.0 };
        (0..self.points).flat_map(|_| (0..self.is.len()).map(own)).collect()
    }

    /// What a channel of the states does to them at once.
    pub fn of_state(&self) -> Vec<f64> {
        vec![0.0; self.points * self.is.len()]
    }
}

/// Whether a row is k times the rows of the derivatives, with one k everywhere.
fn is_rate(moves: &DMatrix<f64>, row: DVector<f64>) -> bool {
    if moves.ncols() == 0 {
        return false;
    }
    let (whole, svd) = (row.norm(), moves.clone().svd(true, true));
    let smallest = f64::EPSILON * svd.singular_values.max();
    let Ok(k) = svd.solve(&row, smallest) else { return false };
    (row - moves * k).norm() <= EXACT * whole
}

#[cfg(test)]
mod tests {
    use super::Algebraic;
    use lacuna_core::file::{Format, parse};
    use lacuna_core::model::Sizes;
    use lacuna_core::system::points;

    /// Whether each output of a mass on a spring with these further outputs is a balance of its own.
    fn balances(outputs: &str, states: &str) -> Vec<bool> {
        let text = format!(
            "sampling_time = 0.01\n[model.equations]\ninputs = [{{ name = \"F\" }}, {{ name = \"a\" }}]\n\
             states = [{states}]\noutputs = [{outputs}]\n\
             parameters = [{{ name = \"m\", value = 2.0 }}, {{ name = \"k\", value = 3.0 }}]\n"
        );
        let system = parse(&text, "mass.toml", Format::Toml).unwrap();
        let model = system.model.as_ref();
        let sizes = Sizes::of(&model.signals());
        let algebraic = Algebraic::new(model, sizes, &points(model, 5));
        (0..sizes.y).map(|output| algebraic.is(output)).collect()
    }

    #[test]
    fn a_reading_and_an_acceleration_are_no_balances() {
        let states =
            r#"{ name = "q", derivative = "v" }, { name = "v", derivative = "(F - k*q^3)/m" }"#;
        let outputs = r#"{ name = "y", value = "q^2" }, { name = "z", value = "2*(F - k*q^3)/m" },
                         { name = "f", value = "F + k*q^3" }, { name = "b", value = "m*a + v" }"#;
        assert_eq!(balances(outputs, states), [false, false, true, true]);
    }

    #[test]
    fn without_states_every_output_of_an_input_is_a_balance() {
        let outputs = r#"{ name = "y", value = "m*a - F^2" }, { name = "constant", value = "k" }"#;
        assert_eq!(balances(outputs, ""), [true, false]);
    }
}
