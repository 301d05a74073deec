//! A linear model from records alone: a subspace start, refined by simulation error.
//!
//! ```text
//! Record -- signals --> scaled stretches -- hankel, subspace --> order, A, C
//! A, C -- fit --> B, D, offset -- refine --> least simulation error -- form, outcome --> System
//! ```

mod baseline;
mod error;
mod fit;
mod form;
mod hankel;
mod outcome;
mod refine;
mod search;
mod signals;
mod subspace;

use crate::data::Record;
use crate::statistics::rms;
use crate::system::System;
use crate::watch::Watch;

pub use baseline::linear_baseline;
pub use error::LinearError;
use fit::{Fitted, Free};
pub use outcome::{LinearParameter, Mode};
use search::{Found, Search};
use signals::Signals;
use subspace::{MOST, Sight};

/// A number within so many standard errors of 0 is taken for 0.
const SEEN: f64 = 3.0;
/// Samples by which starts are told apart.
const FIRST: usize = 20_000;

/// A linear model of records.
#[derive(Debug)]
pub struct LinearEstimate {
    /// The model, discrete, with the records' sampling time, names and units.
    pub system: System,
    /// Number of states.
    pub order: usize,
    /// Singular values of what the past inputs say about the future outputs, with the noise made
    /// white and of size 1; largest first.
    pub singular_values: Vec<f64>,
    /// What a singular value has to exceed to stand above the noise.
    pub edge: f64,
    /// What the poles do, slowest first.
    pub modes: Vec<Mode>,
    /// The numbers of the model.
    pub parameters: Vec<LinearParameter>,
    /// Root mean square of the residuals over the outputs' standard deviation: of the subspace
    /// model, and refined.
    pub nrmse: (f64, f64),
    /// Steps of the refinement.
    pub iterations: usize,
    /// What a user should know.
    pub remarks: Vec<String>,
    /// Whether somebody stopped the fit before its end.
    pub interrupted: bool,
}

/// Makes a linear model of order `order` of records, or of an order that it finds itself.
///
/// The model is x_{k+1} = A x_k + B u_k, y_k = C x_k + D u_k + offset. Poles and shapes come
/// from a subspace method with past inputs as instruments (and a variant with past outputs
/// beside them, over several horizons; the best simulation counts), B, D, the offset and the
/// initial states from linear least squares, and everything from the least simulation error in
/// the end (McKelvey, Helmersson and Ribarits, Automatica 40, 2004). Entries of D and offsets
/// within three standard errors of 0 are left out. Every output counts by its own spread.
///
/// Without `order`: with past inputs as instruments and the noise made white, as many states
/// are proposed as singular values stand above 1.2 times the largest one that pure noise would
/// have, 12 at most, once for each horizon of 10, 20 and 40 samples. The simulation error
/// decides: a higher proposal has to lower the mean square by 1 %, an order above or below the
/// proposals is taken if it lowers it by 5 % or raises it by less than 1 %; each number more has
/// to gain four times what it would gain from the noise on top.
///
/// A missing output carries no weight; a missing input cuts the record, and each part has its
/// own initial state.
///
/// # Errors
///
/// Records that do not go together, are too short for the order, or whose inputs move in too
/// few ways.
///
/// # Example
///
/// ```
/// use lacuna::data::Record;
/// use lacuna::estimate::linear;
///
/// let u: Vec<f64> = (0..400).map(|k| ((k * k) as f64 * 0.7).sin()).collect();
/// let mut y = vec![0.0];
/// for k in 0..399 {
///     y.push(0.9 * y[k] + 0.5 * u[k]);
/// }
/// let record = Record::new(0.1).input("u", u)?.output("y", y)?;
/// let found = linear(&[record], None)?;
/// assert_eq!(found.order, 1);
/// assert!((found.modes[0].pole[0] - 0.9).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn linear(records: &[Record], order: Option<usize>) -> Result<LinearEstimate, LinearError> {
    linear_with(records, order, &())
}

/// The same with somebody who watches.
pub fn linear_with(
    records: &[Record],
    order: Option<usize>,
    watch: &dyn Watch,
) -> Result<LinearEstimate, LinearError> {
    let signals = Signals::of(records)?;
    watch.report(0.0, "looking for the order");
    let (nu, ny) = (signals.nu, signals.ny);
    let sights = Sight::all(&signals, order.unwrap_or(1));
    let source = || signals.source.clone();
    let Some(ways) = sights.iter().map(|s| s.ways).max() else {
        let longest = signals.stretches(true).iter().map(|s| s.len() / (nu + ny)).max();
        let order = order.unwrap_or(1);
        return Err(LinearError::TooShort {
            record: source(),
            found: longest.unwrap_or(0),
            order,
            needed: subspace::needed(order, nu, ny),
        });
    };
    let least_ways = |order: usize| (order * (nu + ny)).div_ceil(ny);
    let first = order.unwrap_or(1);
    if ways < least_ways(first) {
        let needed = least_ways(first);
        return Err(LinearError::NotExciting {
            record: source(),
            found: ways,
            order: first,
            needed,
        });
    }
    let most = (1..=MOST).take_while(|&n| least_ways(n) <= ways).last().unwrap_or(1);
    let search = Search { signals: &signals, part: signals.first(FIRST), sights: &sights, watch };
    let found = match order {
        Some(order) => search.find(order),
        None => search.settle(most),
    };
    let Some(mut found) = found else {
        return Err(LinearError::NoModel { record: source(), order: first });
    };
    watch.report(0.7, "leaving out what is not there");
    let (kept, numbers) = without_insignificant(&signals, &mut found, watch);
    let mut remarks = vec![];
    if found.mirrored > 0 {
        remarks.push("the start had poles outside of the unit circle; they were mirrored".into());
    }
    if !numbers.is_least {
        remarks.push("poles are too near each other for a form with few numbers: all entries are free, and have no standard errors".into());
    }
    let sight = sights.iter().find(|s| s.order() == found.order).unwrap_or(&sights[0]);
    if order.is_none() && sights.iter().all(|s| s.order() == 0) {
        remarks.push("no singular value stands above the noise: order 1 is a guess".into());
    } else if order.is_none() && found.order == MOST {
        remarks.push(format!(
            "more than {MOST} states may stand above the noise; ask for them by --lti N"
        ));
    }
    let longest = records.iter().map(Record::duration).fold(0.0, f64::max);
    remarks.extend(outcome::integrates(&numbers.model, records[0].sampling_time, longest));
    let system = outcome::system(&numbers.model, &records[0]);
    let poles = numbers.model.poles().into_iter().filter(|p| p.1 >= 0.0);
    watch.report(1.0, "done");
    Ok(LinearEstimate {
        parameters: outcome::parameters(&system, &numbers),
        system,
        order: found.order,
        singular_values: sight.singular_values.clone(),
        edge: sight.edge,
        modes: poles.map(|p| Mode::of(p, records[0].sampling_time)).collect(),
        nrmse: (found.before, rms(&kept.residuals)),
        iterations: found.steps,
        remarks,
        interrupted: watch.stopped(),
    })
}

/// Leaves out the offsets and entries of D that the records do not show, and fits again.
fn without_insignificant(
    signals: &Signals,
    found: &mut Found,
    watch: &dyn Watch,
) -> (Fitted, outcome::Numbers) {
    let numbers = outcome::numbers(signals, &found.fitted);
    let mut free = Free::all(signals.nu, signals.ny);
    for &(table, index, value, error) in &numbers.entries {
        let unseen = error.is_some_and(|e| value.abs() < SEEN * e);
        match table {
            'D' if unseen => free.direct[index] = false,
            'o' if unseen => free.offset[index] = false,
            _ => {}
        }
    }
    if free == Free::all(signals.nu, signals.ny) || watch.stopped() {
        return (found.fitted.1.clone(), numbers);
    }
    // an offset that is left out is left out about 0, not about the means
    let about_zero;
    let signals = if free.offset.iter().all(|kept| *kept) {
        signals
    } else {
        about_zero = signals.uncentred();
        &about_zero
    };
    let start = signals.completed(&found.fitted.0, &free);
    let Some(start) = start else { return (found.fitted.1.clone(), numbers) };
    let (model, fitted, steps) = refine::refine(signals, start, &free, watch);
    found.steps += steps;
    let fitted = (model, fitted);
    let mut numbers = outcome::numbers(signals, &fitted);
    // what was left out is 0 to the last bit
    for (kept, value) in free.offset.iter().zip(numbers.model.offset.iter_mut()) {
        *value = if *kept { *value } else { 0.0 };
    }
    let left_out =
        |entry: &(char, usize, f64, Option<f64>)| entry.0 == 'o' && !free.offset[entry.1];
    numbers.entries.retain(|entry| !left_out(entry));
    (fitted.1, numbers)
}
