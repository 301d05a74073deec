//! A fitted linear model as a model file keeps it, with the uncertainty of its numbers.

use serde::Serialize;

use super::fit::{Fitted, unit_changes};
use super::form::{Model, modal};
use super::signals::Signals;
use crate::data::Record;
use crate::model::lti::{Lti, LtiTime, Named};
use crate::statistics::{covariance, dot};
use crate::system::{Sampling, System};

/// One number of a linear model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LinearParameter {
    /// Its name in the model: `A21`, `offset`.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Standard error, robust to correlated residuals; `None` where the record does not tell.
    pub std_error: Option<f64>,
    /// 95 % interval.
    pub interval95: Option<[f64; 2]>,
    /// Unit, where it has one of its own.
    pub unit: String,
}

/// What a pole or a pair of poles does in time.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Mode {
    /// The pole with its imaginary part, the conjugate one left out.
    pub pole: [f64; 2],
    /// Natural frequency of a pair in Hz.
    pub frequency: Option<f64>,
    /// Damping ratio of a pair.
    pub damping: Option<f64>,
    /// Time constant of a real, positive pole in s.
    pub time_constant: Option<f64>,
}

impl Mode {
    /// The mode of a pole at a sampling time in s.
    pub(super) fn of((re, im): (f64, f64), step: f64) -> Self {
        // the pole of the same motion in continuous time is ln(p) / step
        let (decay, turn) = (re.hypot(im).ln() / step, im.atan2(re) / step);
        let rate = decay.hypot(turn);
        let (pair, slow) = (im > 0.0, im == 0.0 && re > 0.0);
        Self {
            pole: [re, im],
            frequency: pair.then_some(rate / std::f64::consts::TAU),
            damping: pair.then_some(-decay / rate),
            time_constant: slow.then_some(-1.0 / decay),
        }
    }
}

/// What is to be said of a pole that the records cannot tell from an integrator: its time constant
/// -T / ln p, or that of growth, is longer than the longest record.
pub fn integrates(model: &Model, step: f64, duration: f64) -> Option<String> {
    let slow = |p: &(f64, f64)| p.1 == 0.0 && p.0 > 0.0 && p.0.ln().abs() * duration < step;
    let pole = model.poles().into_iter().find(slow)?;
    Some(format!(
        "the pole {:.6} is slower than the record of {duration} s: the plant integrates, or settles later than the record shows",
        pole.0
    ))
}

/// The numbers of a linear model and the uncertainty of each.
pub struct Numbers {
    /// The model in the records' units, about 0.
    pub model: Model,
    /// Table (`o` is the offset), entry within it row by row, value and standard error of every
    /// number that is neither 0 nor 1.
    pub entries: Vec<(char, usize, f64, Option<f64>)>,
    /// Whether the form has as few numbers as there can be.
    pub is_least: bool,
}

/// The model in the records' own units and about 0 instead of their means.
fn physical(model: &Model, signals: &Signals) -> Model {
    let (nu, ny) = (signals.nu, signals.ny);
    let (u0, y0) = signals.middles.split_at(nu);
    let (su, sy) = signals.sizes.split_at(nu);
    let mut raw = model.clone();
    for j in 0..nu {
        raw.b.column_mut(j).scale_mut(1.0 / su[j]);
        raw.d.column_mut(j).scale_mut(1.0 / su[j]);
    }
    for i in 0..ny {
        raw.c.row_mut(i).scale_mut(sy[i]);
        raw.d.row_mut(i).scale_mut(sy[i]);
        raw.offset[i] = y0[i] + sy[i] * model.offset[i];
    }
    let n = raw.a.nrows();
    let mean = nalgebra::DVector::from_column_slice(u0);
    // the states rest where the mean inputs hold them
    let still = nalgebra::DMatrix::identity(n, n) - &raw.a;
    if let Some(rest) = still.lu().solve(&(&raw.b * &mean)) {
        raw.offset -= &raw.c * rest + &raw.d * mean;
    }
    raw
}

/// A model in the records' units as the scaled signals about 0 see it.
fn scaled(raw: &Model, signals: &Signals) -> Model {
    let (su, sy) = signals.sizes.split_at(signals.nu);
    let mut model = raw.clone();
    for (j, size) in su.iter().enumerate() {
        model.b.column_mut(j).scale_mut(*size);
        model.d.column_mut(j).scale_mut(*size);
    }
    for (i, size) in sy.iter().enumerate() {
        model.c.row_mut(i).scale_mut(1.0 / size);
        model.d.row_mut(i).scale_mut(1.0 / size);
        model.offset[i] /= size;
    }
    model
}

/// The numbers of a fitted model, in the form with the fewest of them if that is possible.
pub fn numbers(signals: &Signals, fitted: &(Model, Fitted)) -> Numbers {
    let raw = physical(&fitted.0, signals);
    let about_zero = signals.uncentred();
    let squares = dot(&fitted.1.residuals, &fitted.1.residuals);
    // a form that does not simulate alike is none
    let same = |model: &Model| {
        let other = about_zero.fitted(&scaled(model, signals))?;
        let near = dot(&other.residuals, &other.residuals) <= squares * (1.0 + 1e-6) + 1e-18;
        near.then_some(other)
    };
    let least = modal(&raw).and_then(|model| same(&model).map(|fitted| (model, fitted)));
    let is_least = least.is_some();
    let (model, fitted) = match least {
        Some((model, fitted)) => (model, Some(fitted)),
        None => (raw, None),
    };
    let mut entries = vec![];
    let mut changes = vec![];
    let (mut letter, mut index) = ('A', 0);
    for (table, change) in unit_changes(&model) {
        index = if table == letter { index } else { 0 };
        letter = table;
        let value = match table {
            'A' => dot_of(&model.a, &change.a),
            'B' => dot_of(&model.b, &change.b),
            'C' => dot_of(&model.c, &change.c),
            'D' => dot_of(&model.d, &change.d),
            _ => model.offset.dot(&change.offset),
        };
        if value != 0.0 && (value != 1.0 || table == 'o') {
            entries.push((table, index, value, None));
            changes.push(scaled(&change, signals));
        }
        index += 1;
    }
    if let Some(fitted) = fitted {
        let mut columns = about_zero.columns(&scaled(&model, signals), &fitted, &changes);
        let sizes: Vec<f64> = columns.iter().map(|c| dot(c, c).sqrt()).collect();
        for (column, size) in columns.iter_mut().zip(&sizes) {
            column.iter_mut().for_each(|v| *v /= size.max(f64::MIN_POSITIVE));
        }
        let spread = covariance(&columns, &fitted.residuals, 1, &vec![0.0; columns.len()]);
        for (i, entry) in entries.iter_mut().enumerate() {
            let error = spread.as_ref().map(|s| s[(i, i)].sqrt() / sizes[i]);
            entry.3 = error.filter(|e| e.is_finite());
        }
    }
    Numbers { model, entries, is_least }
}

/// Sum of products of all entries.
fn dot_of(a: &nalgebra::DMatrix<f64>, b: &nalgebra::DMatrix<f64>) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The model file's form, with the records' names and units.
pub fn system(model: &Model, record: &Record) -> System {
    let rows = |m: &nalgebra::DMatrix<f64>| -> Vec<Vec<f64>> {
        m.row_iter().map(|row| row.iter().copied().collect()).collect()
    };
    let named = |signals: &[crate::data::Signal]| -> Vec<Named> {
        let one = |s: &crate::data::Signal| match s.unit.is_empty() {
            true => Named::Name(s.name.clone()),
            false => Named::Full { name: s.name.clone(), unit: s.unit.clone(), initial: None },
        };
        signals.iter().map(one).collect()
    };
    let n = model.a.nrows();
    // states are called x1.. unless a signal is
    let free = ["x", "state_", "lti_state_"]
        .into_iter()
        .find(|lead| (1..=n).all(|i| record.signals().all(|s| s.name != format!("{lead}{i}"))));
    let states = match free {
        Some("x") | None => vec![],
        Some(lead) => (1..=n).map(|i| Named::Name(format!("{lead}{i}"))).collect(),
    };
    let zero = |values: &[f64]| values.iter().all(|v| *v == 0.0);
    let lti = Lti {
        a: rows(&model.a),
        b: rows(&model.b),
        c: rows(&model.c),
        d: if zero(model.d.as_slice()) { vec![] } else { rows(&model.d) },
        offset: if zero(model.offset.as_slice()) {
            vec![]
        } else {
            model.offset.iter().copied().collect()
        },
        k: vec![],
        time: LtiTime::Discrete,
        inputs: named(&record.inputs),
        states,
        outputs: named(&record.outputs),
        fixed: vec![],
    };
    let sampling = Sampling { sampling_time: Some(record.sampling_time), ..Sampling::default() };
    System::new(lti, sampling)
}

/// The numbers under the names that the model gives them.
pub fn parameters(system: &System, numbers: &Numbers) -> Vec<LinearParameter> {
    let named = system.signals().parameters;
    let pairs = named.into_iter().zip(&numbers.entries);
    pairs
        .map(|(parameter, &(_, _, value, error))| LinearParameter {
            name: parameter.name,
            value,
            std_error: error,
            interval95: error.map(|e| [value - 1.96 * e, value + 1.96 * e]),
            unit: parameter.unit,
        })
        .collect()
}
