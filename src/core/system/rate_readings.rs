//! Which outputs read rates of states, as accelerometers do.
//!
//! ```text
//! y = k f(x, u; theta) + g(x, u),   dx/dt = f(x, u; theta)
//! ```
//!
//! with a constant k and a g without any parameter that may be wrong: beside the rate stands what kinematics
//! add, such as gravity, the r v of a frame that turns, or a bias. It is seen by slopes: dh/dtheta = k df/dtheta
//! for all parameters that f depends on. k is not negative: y = g - |k| f is a reaction, such as the outflow
//! q - dV/dt of a tank, into which what else leaves the tank does not enter. An output without such parameters
//! reads a rate where g = 0: (c, d) = k (A, B) with d != 0, or the very equation of one state.
//! Sources: Rajamani, "Vehicle Dynamics and Control", 2nd ed., 2012, section 2.3 (a_y = dv/dt + r V_x);
//! Titterton and Weston, "Strapdown Inertial Navigation Technology", 2nd ed., 2004, section 2.2.

use nalgebra::{DMatrix, DVector};

use super::rates::OTHER;
use crate::model::probe::{Along, Point, matrices, slope, unit};
use crate::model::{Ask, Law, Sizes};

/// How closely a row is a rate, as a share of it.
const EXACT: f64 = 1e-9;
/// Smallest singular value of the slopes, as a share of the largest, for which k is unique.
const UNIQUE: f64 = 1e-9;

/// A law's slopes around some points.
pub struct Readings<'a> {
    law: &'a dyn Law,
    sizes: Sizes,
    /// With the model's parameters, and with others too.
    points: Vec<Point>,
    /// Along states and inputs: with the model's parameters, and everywhere.
    here: Rows,
    anywhere: Rows,
    /// Parameters that may be wrong.
    free: Vec<usize>,
    /// Slopes of the outputs along these at the first point, outputs by parameters.
    along_free: DMatrix<f64>,
}

impl<'a> Readings<'a> {
    /// Those of a law with states.
    pub fn new(law: &'a dyn Law, sizes: Sizes, points: &[Point]) -> Self {
        let signals = law.signals();
        let free: Vec<usize> = (0..sizes.theta).filter(|&p| !signals.parameters[p].fixed).collect();
        // a k that changes with parameters that may be wrong is none
        let moved = points.iter().map(|point| {
            let mut theta = point.theta.clone();
            free.iter().for_each(|&p| theta[p] *= OTHER);
            Point { theta, ..point.clone() }
        });
        let all: Vec<Point> = points.iter().cloned().chain(moved).collect();
        let mut along_free = DMatrix::zeros(sizes.y, free.len());
        for (i, &p) in free.iter().enumerate() {
            let slopes = along(law, sizes, Ask::Output, &points[0], p);
            along_free.column_mut(i).copy_from_slice(&slopes);
        }
        let (here, anywhere) = (Rows::around(law, sizes, points), Rows::around(law, sizes, &all));
        Self { law, sizes, points: all, here, anywhere, free, along_free }
    }

    /// The states whose rates an output sums, with their factors; `reached` says whether an input enters its
    /// equation. Empty where it reads none.
    pub fn rates(&self, output: usize, reached: bool) -> Vec<(usize, f64)> {
        if let Some(state) = self.anywhere.row(output, self.sizes.x + self.sizes.u) {
            return vec![(state, 1.0)];
        }
        let k = self.with_kinematics(output);
        let Some(k) = k.or_else(|| self.anywhere.rate(output).filter(|_| reached)) else {
            return vec![];
        };
        let least = EXACT * k.amax();
        k.iter().copied().enumerate().filter(|(_, k)| k.abs() > least).collect()
    }

    /// Whether an output is k f for the model's own parameters at least: a force such as m dv/dt.
    pub fn is_force(&self, output: usize) -> bool {
        self.here.solve(output).is_some()
    }

    /// k with dh/dtheta = k df/dtheta, where there is one and none of it is negative.
    fn with_kinematics(&self, output: usize) -> Option<DVector<f64>> {
        let first = &self.points[0];
        let enters = |p: usize| {
            let slopes = along(self.law, self.sizes, Ask::Derivative, first, p);
            slopes.iter().any(|slope| *slope != 0.0)
        };
        let read = |i: &usize| self.along_free[(output, *i)] != 0.0;
        if !(0..self.free.len()).filter(read).any(|i| enters(self.free[i])) {
            return None;
        }
        let rows = Rows::along(self.law, self.sizes, &self.points, &self.free);
        rows.rate(output).filter(|k| k.min() >= -EXACT * k.amax() && k.amax() > 0.0)
    }
}

/// Slopes of states' rates and of outputs at some points, one direction under the other.
struct Rows {
    moves: DMatrix<f64>,
    reads: DMatrix<f64>,
    /// Whether no two combinations of rates that change are the same.
    unique: bool,
}

impl Rows {
    /// Along states and inputs: (A, B) and (C, D).
    fn around(law: &dyn Law, sizes: Sizes, points: &[Point]) -> Self {
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
        Self::of(moves, reads)
    }

    /// Along those of some parameters that the rates depend on.
    fn along(law: &dyn Law, sizes: Sizes, points: &[Point], free: &[usize]) -> Self {
        let mut moves = DMatrix::zeros(points.len() * free.len(), sizes.x);
        let mut reads = DMatrix::zeros(points.len() * free.len(), sizes.y);
        for (i, &p) in free.iter().enumerate() {
            let rows = i * points.len()..(i + 1) * points.len();
            for (row, point) in rows.clone().zip(points) {
                let slopes = |ask| along(law, sizes, ask, point, p);
                moves.row_mut(row).copy_from_slice(&slopes(Ask::Derivative));
                reads.row_mut(row).copy_from_slice(&slopes(Ask::Output));
            }
            // what the sensor alone depends on says nothing of rates
            if rows.clone().all(|row| moves.row(row).amax() == 0.0) {
                rows.for_each(|row| reads.row_mut(row).fill(0.0));
            }
        }
        Self::of(moves, reads)
    }

    fn of(mut moves: DMatrix<f64>, mut reads: DMatrix<f64>) -> Self {
        // where the law has no slope nothing is compared
        for k in 0..moves.nrows() {
            let finite = moves.row(k).iter().chain(reads.row(k).iter()).all(|v| v.is_finite());
            if !finite {
                moves.row_mut(k).fill(0.0);
                reads.row_mut(k).fill(0.0);
            }
        }
        let (changing, scaled) = changing(&moves);
        let unique = !changing.is_empty() && {
            let values = scaled.singular_values();
            values.min() > UNIQUE * values.max()
        };
        Self { moves, reads, unique }
    }

    /// The state whose rate an output is, along more than one of so many directions at every point.
    fn row(&self, output: usize, directions: usize) -> Option<usize> {
        let read = self.reads.column(output);
        let depends = |at: usize| read.iter().skip(at).step_by(directions).any(|s| *s != 0.0);
        if (0..directions).filter(|&at| depends(at)).count() < 2 {
            return None;
        }
        let off = |i: usize| (self.moves.column(i) - read).norm();
        (0..self.moves.ncols()).find(|&i| off(i) <= EXACT * read.norm())
    }

    /// k of a row that is k times the rates, where there is no other.
    fn rate(&self, output: usize) -> Option<DVector<f64>> {
        self.solve(output).filter(|_| self.unique)
    }

    /// A k of a row that is k times the rates.
    fn solve(&self, output: usize) -> Option<DVector<f64>> {
        let row = self.reads.column(output).into_owned();
        let (lengths, scaled) = changing(&self.moves);
        let mut k = DVector::zeros(self.moves.ncols());
        if lengths.is_empty() {
            return (row.norm() == 0.0).then_some(k);
        }
        let of_changing = scaled.svd(true, true).solve(&row, f64::EPSILON).ok()?;
        for ((state, length), own) in lengths.into_iter().zip(of_changing.iter()) {
            k[state] = own / length;
        }
        ((&row - &self.moves * &k).norm() <= EXACT * row.norm()).then_some(k)
    }
}

/// Slopes of rates that change at all, each by its length, which depends on its unit: the states, with
/// lengths, and their columns.
fn changing(moves: &DMatrix<f64>) -> (Vec<(usize, f64)>, DMatrix<f64>) {
    let lengths = moves.column_iter().map(|column| column.norm()).enumerate();
    let lengths: Vec<(usize, f64)> = lengths.filter(|(_, length)| *length > 0.0).collect();
    let mut scaled = DMatrix::zeros(moves.nrows(), lengths.len());
    for (mut to, &(state, length)) in scaled.column_iter_mut().zip(&lengths) {
        to.copy_from(&(moves.column(state) / length));
    }
    (lengths, scaled)
}

/// Slopes along a parameter, for a change of its own size.
fn along(law: &dyn Law, sizes: Sizes, ask: Ask, at: &Point, parameter: usize) -> Vec<f64> {
    let mut direction = unit(sizes.theta, parameter);
    let value = at.theta[parameter];
    direction[parameter] = if value == 0.0 { 1.0 } else { value };
    slope(law, sizes, ask, at, Along::Theta(&direction))
}

#[cfg(test)]
mod tests {
    use super::super::balances::OutputEquations;
    use crate::file::{Format, parse};

    /// What the outputs of a model read, in thousandths.
    fn read(text: &str) -> (Vec<(usize, Vec<(usize, i64)>)>, Vec<bool>) {
        let text = format!("sampling_time = 0.01\n[model.equations]\n{text}");
        let system = parse(&text, "model.toml", Format::Toml).unwrap();
        let found = OutputEquations::of(system.model.as_ref());
        let thousandths = |(state, k): (usize, f64)| (state, (1e3 * k).round() as i64);
        let one = |(o, parts): (usize, Vec<(usize, f64)>)| {
            (o, parts.into_iter().map(thousandths).collect())
        };
        (found.rates.into_iter().map(one).collect(), found.balances)
    }

    #[test]
    fn an_accelerometer_on_a_mass_that_no_input_reaches() {
        // wheel and body of a car; the outputs are the body's acceleration in g and the suspension's force
        let (rates, balances) = read(
            r#"
            inputs = [{ name = "road" }]
            states = [{ name = "s", derivative = "vs" }, { name = "u", derivative = "vu" },
              { name = "vs", derivative = "(k*(u - s) + c*(vu - vs))/m" },
              { name = "vu", derivative = "(kt*(road - u) - k*(u - s) - c*(vu - vs))/mu" }]
            outputs = [{ name = "a", value = "(k*(u - s) + c*(vu - vs))/m/g" }, { name = "f", value = "k*(u - s) + c*(vu - vs)" }]
            parameters = [{ name = "k", value = 2.0 }, { name = "c", value = 0.3 }, { name = "m", value = 2.5 }, { name = "mu", value = 0.4 },
              { name = "kt", value = 20.0 }, { name = "g", value = 10.0, fixed = true }]"#,
        );
        assert_eq!((rates, balances), (vec![(0, vec![(2, 100)])], vec![false, false]));
    }

    #[test]
    fn what_kinematics_and_a_bias_add_is_no_matter() {
        // lateral and yaw motion of a car at a recorded speed; the sensor has a bias that is a state
        let (rates, balances) = read(
            r#"
            inputs = [{ name = "steering" }, { name = "speed" }]
            states = [{ name = "v", derivative = "(cf*(steering - v/speed) - cr*v/speed)/m - r*speed" },
              { name = "r", derivative = "(1.2*cf*(steering - v/speed) + 1.5*cr*v/speed)/j" }, { name = "b", derivative = "0" }]
            outputs = [{ name = "ay", value = "(cf*(steering - v/speed) - cr*v/speed)/m + b" }, { name = "yaw", value = "r" }]
            parameters = [{ name = "cf", value = 8.0 }, { name = "cr", value = 9.0 }, { name = "m", value = 1.5 }, { name = "j", value = 2.0 }]"#,
        );
        assert_eq!((rates, balances), (vec![(0, vec![(0, 1000)])], vec![false, false]));
    }

    #[test]
    fn a_reaction_reads_no_rate() {
        // the outflow of a tank, and what a wall feels of a mass of 1
        let (rates, balances) = read(
            r#"
            inputs = [{ name = "q" }]
            states = [{ name = "level", derivative = "(q - a*sqrt(level))/3" }, { name = "p", derivative = "v" },
              { name = "v", derivative = "q - k*p - c*v" }]
            outputs = [{ name = "outflow", value = "a*sqrt(level)" }, { name = "wall", value = "k*p + c*v" }, { name = "y", value = "v" }]
            parameters = [{ name = "a", value = 2.0 }, { name = "k", value = 3.0 }, { name = "c", value = 0.1 }]"#,
        );
        assert_eq!((rates, balances), (vec![], vec![false; 3]));
    }
}
