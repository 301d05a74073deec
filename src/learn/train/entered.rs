//! What was added to the states of a model as a signal in each of its channels: see
//! [`added`](super::added) for the equations.

use nalgebra::{DMatrix, DVector};

use super::TrainError;
use crate::encoder::Spread;
use crate::lfr::{Baseline, Sampled};
use crate::model::probe::{Point, equilibrium, matrices, value};
use crate::model::{Ask, Law, Quantity, Signal};
use crate::system::{Base, Method, Origin, System};

/// Points of the model's own curve.
const POINTS: usize = 61;

/// What is added to one channel.
#[derive(Debug, Clone)]
pub struct Added {
    /// The channel, with its unit.
    pub channel: Signal,
    /// Share of everything that is added, between 0 and 1, that this channel alone makes up for.
    pub share: f64,
    /// The signal, sample by sample, in the unit of the channel.
    pub values: Vec<f64>,
}

/// Something that what is added may depend on.
#[derive(Debug, Clone)]
pub struct Coordinate {
    /// Name, unit, and quantity where it is known or found to be a velocity.
    pub signal: Signal,
    /// Its values at the same samples.
    pub values: Vec<f64>,
    /// What the model itself gives into the first channel where this coordinate alone moves away
    /// from the equilibrium: the coordinate and what is given there. Empty where it is no state and
    /// no input.
    pub own: Vec<(f64, f64)>,
}

/// States and inputs at some samples.
pub(super) struct Visited {
    pub x: Vec<Vec<f64>>,
    pub u: Vec<Vec<f64>>,
    pub du: Vec<Vec<f64>>,
    pub time: Vec<f64>,
}

/// What a baseline is before it is sampled: the model with channels that something may enter.
fn within(baseline: &Baseline) -> Option<System> {
    let model = baseline.system.model.as_ref();
    if model.typetag_name() != "sampled" {
        return Some(baseline.system.clone());
    }
    let mut table = serde_json::to_value(model).ok()?;
    let sampled: Sampled = serde_json::from_value(table.get_mut("sampled")?.take()).ok()?;
    Some(sampled.system)
}

pub(super) type Entered = (Vec<Added>, Vec<Coordinate>);

/// What was added to the states as a signal in every channel, and the coordinates.
pub(super) fn entered(
    baseline: &Baseline,
    sampling_time: f64,
    visited: &Visited,
    d: &[Vec<f64>],
) -> Result<Entered, TrainError> {
    let Some(inner) = within(baseline) else { return Ok((vec![], vec![])) };
    let law: &dyn Law = inner.model.as_ref();
    let base = Base::new(law, &inner.sampling, sampling_time)
        .map_err(crate::encoder::EncoderError::from)?;
    let (n, continuous) = (base.sizes, base.signals.time.is_continuous());
    let scales: Vec<f64> = (0..n.x)
        .map(|i| Spread::of(&visited.x.iter().map(|x| x[i]).collect::<Vec<f64>>()).scale)
        .collect();
    let theta = baseline.theta();
    let integrator = inner.sampling.integrator;
    let order = if integrator.method == Method::Euler { 1 } else { 4 };
    let pace = Pace { order, substeps: integrator.substeps.max(1), sampling_time };
    let channels: Vec<(Signal, usize)> = (base.targets.entries.iter())
        .filter_map(|(signal, origin)| match origin {
            Origin::Own(c) => Some((signal.clone(), *c)),
            _ => None,
        })
        .collect();
    let mut values = vec![Vec::with_capacity(d.len()); channels.len()];
    let (mut left, mut total) = (vec![0.0; channels.len()], 0.0);
    let mut seen = vec![vec![]; base.sources.entries.len()];
    for (k, d) in d.iter().enumerate() {
        let at = Point {
            theta: theta[..n.theta].to_vec(),
            x: visited.x[k][..n.x].to_vec(),
            u: visited.u[k].clone(),
            w: vec![0.0; n.w],
            time: visited.time[k],
        };
        let own = matrices(law, n, &at);
        let nx = n.x;
        let response = if continuous { held(&own.a, &own.g, &pace) } else { own.g };
        let d = DVector::from_fn(nx, |i, _| d[i] / scales[i]);
        total += d.norm_squared();
        for (c, (_, number)) in channels.iter().enumerate() {
            let along = DVector::from_fn(nx, |i, _| response[(i, *number)] / scales[i]);
            let size = along.norm_squared();
            let force = if size > 0.0 { along.dot(&d) / size } else { 0.0 };
            left[c] += (&d - along * force).norm_squared();
            values[c].push(force);
        }
        let coordinates = value(law, n, Ask::Coordinates, &at);
        for (series, (_, origin)) in seen.iter_mut().zip(&base.sources.entries) {
            let known = match origin {
                Origin::State(i) => at.x.get(*i),
                Origin::Input(i) => at.u.get(*i),
                Origin::Own(i) if coordinates.is_empty() => at.x.get(*i),
                Origin::Own(i) => coordinates.get(*i),
                _ => None,
            };
            series.extend(known);
        }
    }
    let named = channels.into_iter().zip(values).zip(left).map(|(((channel, _), values), left)| {
        let share = if total > 0.0 { 1.0 - left / total } else { 0.0 };
        Added { channel, share, values }
    });
    let mut channels: Vec<Added> = named.collect();
    channels.sort_by(|a, b| b.share.total_cmp(&a.share));
    let sources = base.sources.entries.iter().enumerate();
    let kept = sources.zip(seen).filter(|((entry, _), series)| {
        !series.is_empty() && !(0..*entry).any(|other| base.rates.same(other, *entry))
    });
    let first = channels.first().map(|added| added.channel.name.clone()).unwrap_or_default();
    let coordinates = kept.map(|((entry, (signal, origin)), values)| {
        let mut signal = signal.clone();
        if signal.quantity.is_none() && base.rates.is_rate(entry) {
            signal.quantity = Some(Quantity::velocity());
        }
        let state = match origin {
            Origin::Own(i) => base.own_state.get(*i).copied().flatten(),
            Origin::State(i) => Some(*i),
            _ => None,
        };
        let own = state.map_or_else(Vec::new, |state| slice(law, &base, &first, state, &values));
        Coordinate { signal, values, own }
    });
    Ok((channels, coordinates.collect()))
}

/// Order of an integrator and its steps in a sample.
struct Pace {
    order: usize,
    substeps: usize,
    sampling_time: f64,
}

/// What an integrator of order q (Euler's method, or the Runge-Kutta method of four stages) makes of
/// a channel that is held over a sample of m steps h, the model being linear there:
///
/// ```text
/// D = sum_{j<m} Phi^j Gamma,   Phi = sum_{i<=q} (h A)^i / i!,   Gamma = h sum_{i<q} (h A)^i / (i+1)! G
/// ```
///
/// (Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd ed., 1993, ch. II). As
/// the model takes its steps, not as the equations would have them.
fn held(a: &DMatrix<f64>, g: &DMatrix<f64>, pace: &Pace) -> DMatrix<f64> {
    let h = pace.sampling_time / pace.substeps as f64;
    let (ha, one) = (a * h, DMatrix::identity(a.nrows(), a.nrows()));
    let (mut term, mut phi) = (one.clone(), one.clone());
    let mut gamma = DMatrix::zeros(a.nrows(), a.nrows());
    for i in 1..=pace.order {
        gamma += &term * (h / i as f64);
        term = &term * &ha / i as f64;
        phi += &term;
    }
    let (gamma, mut done) = (gamma * g, DMatrix::zeros(g.nrows(), g.ncols()));
    for _ in 0..pace.substeps {
        done = &phi * done + &gamma;
    }
    done
}

/// What a model gives into a channel where one state alone moves away from its equilibrium.
fn slice(law: &dyn Law, base: &Base, channel: &str, state: usize, seen: &[f64]) -> Vec<(f64, f64)> {
    let (Some((x, u)), n) = (equilibrium(law), base.sizes) else { return vec![] };
    let target = base.targets.entries.iter().find(|(signal, _)| signal.name == channel);
    let Some((_, Origin::Own(number))) = target else { return vec![] };
    let theta = base.signals.theta();
    let rest = Point { theta, x, u, w: vec![0.0; n.w], time: 0.0 };
    let along = matrices(law, n, &rest).g.column(*number).into_owned();
    let size = along.norm_squared();
    let given =
        |at: &Point| DVector::from_vec(value(law, n, Ask::Derivative, at)).dot(&along) / size;
    let (low, high) = seen.iter().fold((f64::MAX, f64::MIN), |m, v| (m.0.min(*v), m.1.max(*v)));
    let (mut at, zero) = (rest.clone(), given(&rest));
    let points = (0..POINTS).map(|i| {
        let z = low + (high - low) * i as f64 / (POINTS - 1) as f64;
        at.x[state] = z;
        (z, given(&at) - zero)
    });
    points.filter(|(_, w)| w.is_finite()).collect()
}
