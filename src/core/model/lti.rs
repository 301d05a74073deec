//! Linear time-invariant models: x' = A x + B u, y = C x + D u + offset.

mod named;
mod product;

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::law::Matrices;
use super::{At, Fault, Parameter, Physics, Signals, State};
use crate::real::Real;

#[doc(hidden)]
pub use named::Named;
use named::names;

/// Whether the matrices give derivatives or next states.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[doc(hidden)]
pub enum LtiTime {
    /// x_{k+1} = A x_k + B u_k.
    #[default]
    Discrete,
    /// dx/dt = A x + B u, discretised exactly.
    Continuous,
}

/// A linear time-invariant model in state-space form.
///
/// `K`, the gain of the innovation form x+ = A x + B u + K e, acts in one-step prediction
/// and in encoders, not in free run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lti {
    /// States to states, row by row.
    #[serde(rename = "A")]
    pub a: Vec<Vec<f64>>,
    /// Inputs to states.
    #[serde(rename = "B")]
    pub b: Vec<Vec<f64>>,
    /// States to outputs.
    #[serde(rename = "C")]
    pub c: Vec<Vec<f64>>,
    /// Inputs to outputs; zero if absent.
    #[serde(rename = "D", default, skip_serializing_if = "Vec::is_empty")]
    pub d: Vec<Vec<f64>>,
    /// Constant part of each output, where the model holds about a point other than 0; zero if
    /// absent.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub offset: Vec<f64>,
    /// Innovations to states.
    #[serde(rename = "K", default, skip_serializing_if = "Vec::is_empty")]
    pub k: Vec<Vec<f64>>,
    /// Discrete (default) or continuous.
    #[serde(default)]
    pub time: LtiTime,
    /// Names of the inputs; `u` or `u1..` if absent.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub inputs: Vec<Named>,
    /// Names of the states; `x1..` if absent.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub states: Vec<Named>,
    /// Names of the outputs; `y` or `y1..` if absent.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outputs: Vec<Named>,
    /// Names of entries held at their values (`A11`, `B21`, ...).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fixed: Vec<String>,
}

impl Lti {
    /// Numbers of states, inputs, outputs.
    pub fn dimensions(&self) -> (usize, usize, usize) {
        (self.a.len(), self.b.first().map_or(0, Vec::len), self.c.len())
    }

    fn tables(&self) -> [(&'static str, &[Vec<f64>], usize, usize); 4] {
        let (n, nu, ny) = self.dimensions();
        [("A", &self.a, n, n), ("B", &self.b, n, nu), ("C", &self.c, ny, n), ("D", &self.d, ny, nu)]
    }

    /// Entry (table, row, column) of every parameter, in order: all that are neither 0 nor
    /// 1, which are taken as structure. Offsets that are not 0 come last, as table 4.
    fn entries(&self) -> Vec<(usize, usize, usize)> {
        let mut entries = vec![];
        for (t, (_, table, ..)) in self.tables().iter().enumerate() {
            for (i, row) in table.iter().enumerate() {
                for (j, &value) in row.iter().enumerate() {
                    if value != 0.0 && value != 1.0 {
                        entries.push((t, i, j));
                    }
                }
            }
        }
        let offsets = self.offset.iter().enumerate().filter(|(_, value)| **value != 0.0);
        entries.extend(offsets.map(|(i, _)| (4, i, 0)));
        entries
    }

    /// The four matrices and the offset with the parameters `theta` put in.
    fn filled(&self, theta: &[f64]) -> ([DMatrix<f64>; 4], DVector<f64>) {
        let mut filled = self.tables().map(|(_, table, rows, columns)| {
            DMatrix::from_fn(rows, columns, |i, j| {
                table.get(i).and_then(|row| row.get(j)).copied().unwrap_or(0.0)
            })
        });
        let count = self.c.len();
        let mut offset = DVector::from_fn(count, |i, _| self.offset.get(i).copied().unwrap_or(0.0));
        for ((t, i, j), &value) in self.entries().into_iter().zip(theta) {
            match filled.get_mut(t) {
                Some(table) => table[(i, j)] = value,
                None => offset[i] = value,
            }
        }
        (filled, offset)
    }
}

impl Physics for Lti {
    /// They loop over matrices.
    const STRAIGHT: &'static [usize] = &[];

    fn signals(&self) -> Signals {
        let (n, nu, ny) = self.dimensions();
        let mut signals = match self.time {
            LtiTime::Discrete => Signals::discrete(),
            LtiTime::Continuous => Signals::continuous(),
        };
        signals.inputs = names(&self.inputs, "u", nu, false);
        signals.outputs = names(&self.outputs, "y", ny, false);
        signals.states = names(&self.states, "x", n, true)
            .into_iter()
            .enumerate()
            .map(|(i, signal)| State {
                signal,
                initial: self.states.get(i).map_or(0.0, Named::initial),
            })
            .collect();
        let tables = self.tables();
        signals.parameters = self
            .entries()
            .into_iter()
            .map(|(t, i, j)| {
                let Some(&(letter, table, rows, columns)) = tables.get(t) else {
                    let name = if ny == 1 { "offset".into() } else { format!("offset{}", i + 1) };
                    let fixed = self.fixed.contains(&name);
                    let unit = signals.outputs.get(i).map_or("", |output| output.unit.as_str());
                    return Parameter::new(name, self.offset[i], unit).fixed(fixed);
                };
                let name = if rows.max(columns) > 9 {
                    format!("{letter}{}_{}", i + 1, j + 1)
                } else {
                    format!("{letter}{}{}", i + 1, j + 1)
                };
                let fixed = self.fixed.contains(&name);
                Parameter::new(name, table[i][j], "").fixed(fixed)
            })
            .collect();
        signals
    }

    fn faults(&self) -> Vec<Fault> {
        let mut faults = vec![];
        let (n, nu, ny) = self.dimensions();
        if n == 0 {
            faults.push(Fault::new("A", "no rows", "a square matrix with one row per state"));
        }
        let gain = ("K", self.k.as_slice(), n, ny);
        for (letter, table, rows, columns) in self.tables().into_iter().chain([gain]) {
            let may_be_absent = matches!(letter, "D" | "K");
            if may_be_absent && table.is_empty() {
                continue;
            }
            if table.len() != rows {
                let expected = format!("{rows} rows, as `A` and `C` have");
                faults.push(Fault::new(letter, format!("{} rows", table.len()), expected));
            }
            for (i, row) in table.iter().enumerate() {
                if row.len() != columns {
                    let found = format!("{} numbers", row.len());
                    faults.push(Fault::new(format!("{letter}[{i}]"), found, format!("{columns}")));
                }
                for (j, value) in row.iter().enumerate().filter(|(_, v)| !v.is_finite()) {
                    faults.push(Fault::new(
                        format!("{letter}[{i}][{j}]"),
                        value,
                        "a finite number",
                    ));
                }
            }
        }
        if !self.offset.is_empty() && self.offset.len() != ny {
            let found = format!("{} numbers", self.offset.len());
            faults.push(Fault::new("offset", found, format!("{ny}, as `C` has rows")));
        }
        for (i, value) in self.offset.iter().enumerate().filter(|(_, v)| !v.is_finite()) {
            faults.push(Fault::new(format!("offset[{i}]"), value, "a finite number"));
        }
        for (key, given, count) in [
            ("inputs", &self.inputs, nu),
            ("states", &self.states, n),
            ("outputs", &self.outputs, ny),
        ] {
            if !given.is_empty() && given.len() != count {
                let found = format!("{} names", given.len());
                faults.push(Fault::new(key, found, format!("{count}, as the matrices say")));
            }
        }
        faults
    }

    #[inline(always)]
    fn derivative<R: Real>(&self, at: &At<R>, dx: &mut [R]) {
        self.multiply(at, dx, [0, 1]);
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<R>, y: &mut [R]) {
        self.multiply(at, y, [2, 3]);
        let given = self.offset.iter().filter(|v| **v != 0.0).count();
        let mut next = at.theta.len() - given;
        for (y, &offset) in y.iter_mut().zip(&self.offset) {
            if offset != 0.0 {
                *y += at.theta[next];
                next += 1;
            }
        }
    }

    fn key(&self, parameter: &str) -> String {
        let entries = self.entries();
        let names = Physics::signals(self).parameters;
        let at = names.iter().position(|p| p.name == parameter);
        at.and_then(|at| entries.get(at)).map_or_else(
            || parameter.to_string(),
            |&(t, i, j)| match ["A", "B", "C", "D"].get(t) {
                Some(letter) => format!("{letter}.{i}.{j}"),
                None => format!("offset.{i}"),
            },
        )
    }

    fn matrices(&self, theta: &[f64]) -> Option<Matrices> {
        let n = self.dimensions().0;
        let ([a, b, c, d], h) = self.filled(theta);
        Some(Matrices { a, b, g: DMatrix::identity(n, n), f: DVector::zeros(n), c, d, h })
    }

    fn innovation_gain(&self) -> Option<DMatrix<f64>> {
        let (n, _, ny) = self.dimensions();
        (!self.k.is_empty()).then(|| DMatrix::from_fn(n, ny, |i, j| self.k[i][j]))
    }
}

crate::register!(StateSpaceModel for Lti, "lti", "a linear state-space model: A, B, C, D, offset, K",
    "A = [[0.9, 0.1], [-0.2, 0.8]]\nB = [[0.0], [0.5]]\nC = [[1.0, 0.0]]\noffset = [0.3]");
