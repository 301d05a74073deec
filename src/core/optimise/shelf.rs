//! Problems with known answers, which every optimiser has to solve.
//!
//! Most are sums of squares from Moré, Garbow and Hillstrom, "Testing unconstrained
//! optimization software", ACM Trans. Math. Softw. 7, 1981; the numbers in the doc comments
//! are theirs.

use super::{Bounds, LeastSquares, Objective};

/// Residuals at a point; their derivatives, one column per entry.
type Residuals = Box<dyn Fn(&[f64]) -> Vec<f64>>;
type Columns = Box<dyn Fn(&[f64]) -> Vec<Vec<f64>>>;

/// One problem: half a sum of squares, perhaps within bounds.
pub struct Problem {
    /// Name.
    pub name: String,
    /// Where to start.
    pub start: Vec<f64>,
    /// Where the minimum is.
    pub minimum_at: Vec<f64>,
    /// The value there.
    pub minimum: f64,
    bounds: Option<Bounds>,
    residuals: Residuals,
    columns: Columns,
}

impl Objective for Problem {
    fn len(&self) -> usize {
        self.start.len()
    }

    fn value_and_gradient(&self, theta: &[f64], gradient: &mut [f64]) -> f64 {
        let residuals = (self.residuals)(theta);
        for (g, column) in gradient.iter_mut().zip((self.columns)(theta)) {
            *g = column.iter().zip(&residuals).map(|(a, b)| a * b).sum();
        }
        0.5 * residuals.iter().map(|r| r * r).sum::<f64>()
    }

    fn bounds(&self) -> Option<&Bounds> {
        self.bounds.as_ref()
    }

    fn least_squares(&self) -> Option<&dyn LeastSquares> {
        Some(self)
    }
}

impl LeastSquares for Problem {
    fn len(&self) -> usize {
        self.start.len()
    }

    fn residuals(&self, points: &[Vec<f64>]) -> Vec<Option<Vec<f64>>> {
        points.iter().map(|point| Some((self.residuals)(point))).collect()
    }

    fn columns(&self, theta: &[f64]) -> Option<Vec<Vec<f64>>> {
        Some((self.columns)(theta))
    }

    fn bounds(&self) -> Option<&Bounds> {
        self.bounds.as_ref()
    }
}

fn problem(
    name: &str,
    start: &[f64],
    minimum_at: &[f64],
    residuals: impl Fn(&[f64]) -> Vec<f64> + 'static,
    columns: impl Fn(&[f64]) -> Vec<Vec<f64>> + 'static,
) -> Problem {
    let minimum = 0.5 * residuals(minimum_at).iter().map(|r| r * r).sum::<f64>();
    Problem {
        name: name.into(),
        start: start.to_vec(),
        minimum_at: minimum_at.to_vec(),
        minimum,
        bounds: None,
        residuals: Box::new(residuals),
        columns: Box::new(columns),
    }
}

/// A sphere whose axes differ by 100 in length: 10^4 in curvature.
pub fn stretched(n: usize) -> Problem {
    let weight = move |i: usize| 100f64.powf(-(i as f64) / (n.max(2) - 1) as f64);
    let at: Vec<f64> = (0..n).map(|i| 1.0 + i as f64).collect();
    let centre = at.clone();
    problem(
        "stretched sphere",
        &vec![0.0; n],
        &at,
        move |x| (0..n).map(|i| weight(i) * (x[i] - centre[i])).collect(),
        move |_| {
            (0..n).map(|j| (0..n).map(|i| if i == j { weight(i) } else { 0.0 }).collect()).collect()
        },
    )
}

/// Rosenbrock's curved valley, chained over pairs: `10 (x2 - x1^2)`, `1 - x1`; minimum at 1.
pub fn rosenbrock(n: usize) -> Problem {
    let start: Vec<f64> = (0..n).map(|i| if i % 2 == 0 { -1.2 } else { 1.0 }).collect();
    let pairs = n / 2;
    problem(
        &format!("Rosenbrock {n}"),
        &start,
        &vec![1.0; n],
        move |x| {
            (0..pairs)
                .flat_map(|p| [10.0 * (x[2 * p + 1] - x[2 * p].powi(2)), 1.0 - x[2 * p]])
                .collect()
        },
        move |x| {
            let mut columns = vec![vec![0.0; 2 * pairs]; n];
            for p in 0..pairs {
                columns[2 * p][2 * p] = -20.0 * x[2 * p];
                columns[2 * p][2 * p + 1] = -1.0;
                columns[2 * p + 1][2 * p] = 10.0;
            }
            columns
        },
    )
}

/// Rosenbrock's valley with its minimum cut off: `x1 <= 0.5`, so it ends at (0.5, 0.25).
pub fn rosenbrock_cut() -> Problem {
    let mut cut = rosenbrock(2);
    cut.name = "Rosenbrock, cut off".into();
    cut.bounds =
        Some(Bounds { lower: vec![-2.0, f64::NEG_INFINITY], upper: vec![0.5, f64::INFINITY] });
    cut.minimum_at = vec![0.5, 0.25];
    cut.minimum = 0.125;
    cut
}

/// Powell's function, whose second derivatives at the minimum 0 are singular.
pub fn powell() -> Problem {
    let (root5, root10) = (5f64.sqrt(), 10f64.sqrt());
    problem(
        "Powell's singular function",
        &[3.0, -1.0, 0.0, 1.0],
        &[0.0; 4],
        move |x| {
            vec![
                x[0] + 10.0 * x[1],
                root5 * (x[2] - x[3]),
                (x[1] - 2.0 * x[2]).powi(2),
                root10 * (x[0] - x[3]).powi(2),
            ]
        },
        move |x| {
            let (a, b) = (2.0 * (x[1] - 2.0 * x[2]), 2.0 * root10 * (x[0] - x[3]));
            vec![
                vec![1.0, 0.0, 0.0, b],
                vec![10.0, 0.0, a, 0.0],
                vec![0.0, root5, -2.0 * a, 0.0],
                vec![0.0, -root5, 0.0, -b],
            ]
        },
    )
}

/// Beale's function, flat far from its minimum at (3, 0.5).
pub fn beale() -> Problem {
    let wanted = [1.5, 2.25, 2.625];
    problem(
        "Beale's function",
        &[1.0, 1.0],
        &[3.0, 0.5],
        move |x| (0..3).map(|i| wanted[i] - x[0] * (1.0 - x[1].powi(i as i32 + 1))).collect(),
        |x| {
            vec![
                (1..4).map(|i| -(1.0 - x[1].powi(i))).collect(),
                (1..4).map(|i| x[0] * f64::from(i) * x[1].powi(i - 1)).collect(),
            ]
        },
    )
}

/// A decaying exponential through ten points without error: `a exp(-b t)`, a = 2, b = 0.7.
pub fn decay() -> Problem {
    let at = |x: &[f64], i: usize| x[0] * (-x[1] * 0.3 * i as f64).exp();
    let truth = [2.0, 0.7];
    problem(
        "decay",
        &[1.0, 0.1],
        &truth,
        move |x| (0..10).map(|i| at(x, i) - at(&truth, i)).collect(),
        move |x| {
            vec![
                (0..10).map(|i| at(x, i) / x[0]).collect(),
                (0..10).map(|i| -0.3 * i as f64 * at(x, i)).collect(),
            ]
        },
    )
}

/// `x - ln x` as a square, with no value at all below 0 and its minimum at 1: steps that go
/// too far have to be taken back.
pub fn cliff() -> Problem {
    problem(
        "cliff",
        &[5.0],
        &[1.0],
        |x| vec![(2.0 * (x[0] - x[0].ln())).sqrt()],
        |x| vec![vec![(1.0 - 1.0 / x[0]) / (2.0 * (x[0] - x[0].ln())).sqrt()]],
    )
}

/// All of them.
pub fn all() -> Vec<Problem> {
    vec![
        stretched(5),
        rosenbrock(2),
        rosenbrock(10),
        rosenbrock_cut(),
        powell(),
        beale(),
        decay(),
        cliff(),
    ]
}
