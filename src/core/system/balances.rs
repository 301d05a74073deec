//! What output equations say beside what a sensor reads of the states: rates, and balances of their own.
//!
//! Around a point a model is dx/dt = A x + B u, y = C x + D u. A row (c, d) of (C, D) with d = 0 is what a
//! sensor reads of the states: laws of physics act before it, in the channels of the states. With d != 0
//! and (c, d) = k (A, B) for one k at all points it is the reading of a rate, such as an acceleration: what
//! enters dx/dt by G w enters it by k G w (D_yw of the linear fractional representation: Hoekstra et al.,
//! eq. `interconn_mx`). Any other row with d != 0 is a balance of its own, such as the torque J q'' + g sin q
//! of an inverse dynamic model (Spong, Hutchinson and Vidyasagar, "Robot Modeling and Control", 2006,
//! section 7.3): a law that is missing there enters no state.

use nalgebra::{DMatrix, DVector, Dyn, SVD};

use super::rates::{OTHER, points};
use crate::model::probe::{Along, Point, matrices, slope, unit};
use crate::model::{Ask, LaneNumber, Law, Sizes};

/// Points that are looked at.
const POINTS: usize = 4;
/// How closely a row is a rate, as a share of it.
const EXACT: f64 = 1e-9;
/// Smallest singular value of (A, B), as a share of the largest, for which k is unique.
const UNIQUE: f64 = 1e-9;

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
        if sizes.x == 0 || !reached.contains(&true) {
            return Self { balances: reached, rates: vec![] };
        }
        // a k that changes with the parameters is none
        let moved = points.iter().map(|point| {
            let theta = point.theta.iter().map(|value| OTHER * value).collect();
            Point { theta, ..point.clone() }
        });
        let all: Vec<Point> = points.iter().cloned().chain(moved).collect();
        let (here, anywhere) = (Rows::new(law, sizes, &points), Rows::new(law, sizes, &all));
        let mut found = Self::default();
        for (o, &reached) in reached.iter().enumerate() {
            found.balances.push(reached && here.rate(o).is_none());
            let rate =
                (reached && continuous && anywhere.unique).then(|| anywhere.rate(o)).flatten();
            if let Some(k) = rate {
                let least = EXACT * k.amax();
                let parts = k.iter().copied().enumerate().filter(|(_, k)| k.abs() > least);
                found.rates.push((o, parts.collect()));
            }
        }
        found
    }
}

impl OutputEquations {
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

/// Rows of (A, B) and (C, D) at some points, one under the other.
struct Rows {
    moves: DMatrix<f64>,
    reads: DMatrix<f64>,
    /// Of `moves`.
    svd: SVD<f64, Dyn, Dyn>,
    /// Whether no two combinations of rows of (A, B) are the same.
    unique: bool,
}

impl Rows {
    fn new(law: &dyn Law, sizes: Sizes, points: &[Point]) -> Self {
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
        // lengths of rates differ by their units, which makes no two of them one
        let mut scaled = moves.clone();
        for mut column in scaled.column_iter_mut() {
            let length = column.norm();
            column /= if length > 0.0 { length } else { 1.0 };
        }
        let values = scaled.svd(false, false).singular_values;
        let unique = values.min() > UNIQUE * values.max();
        let svd = moves.clone().svd(true, true);
        Self { moves, reads, svd, unique }
    }

    /// k with (c, d) = k (A, B), where there is one.
    fn rate(&self, output: usize) -> Option<DVector<f64>> {
        let row = self.reads.column(output).into_owned();
        let smallest = f64::EPSILON * self.svd.singular_values.max();
        let k = self.svd.solve(&row, smallest).ok()?;
        ((&row - &self.moves * &k).norm() <= EXACT * row.norm()).then_some(k)
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
        let [(1, parts)] = &found.rates[..] else { panic!("{found:?}") };
        let factors: Vec<f64> = parts.iter().map(|(_, k)| (k * 1e9).round() / 1e9).collect();
        assert_eq!(factors, [1.0, 2.0]);
    }

    #[test]
    fn without_states_every_output_of_an_input_is_a_balance() {
        let outputs = r#"{ name = "y", value = "m*a - F^2" }, { name = "constant", value = "k" }"#;
        assert_eq!(found(outputs, "").balances, [true, false]);
    }
}
