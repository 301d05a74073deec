//! Outputs that have nothing to do with the machine: a sensor that is not connected, a column of another
//! record.
//!
//! Two hypotheses about an output y, whose simulation is s:
//!
//! ```text
//! H0  y is independent of the inputs, of s and of the other outputs
//! H1  y = s + e, e independent of s                        what the model says
//! ```
//!
//! H0 is put to the score test of a dynamic regression ([`Regression`]) on curves of present and past
//! inputs, s and the other outputs, and to the coherence of y with s and with the inputs,
//! `|S_uy|^2 / (S_uu S_yy)`, which sees a linear answer of any delay (Carter, Knapp and Nuttall, IEEE
//! Trans. Audio Electroacoustics 21, 1973). H1 is put to the score test of y - s on s and
//! its past. An output is unrelated where no test sees anything against H0 and H1 is rejected: an answer
//! as large as the model's would have been seen.

use super::{Fault, FaultKind};
use crate::data::Record;
use crate::evaluate::{EvaluateError, Init, Run};
use crate::look::coherences;
use crate::prepare::windows::windows;
use crate::statistics::{Regression, deviation, is_white, mean};
use crate::system::System;

/// Readings that a verdict takes, at least: pieces of spectra have to be many.
const FEWEST: usize = 256;
/// Chance at which an unrelated output is taken for a related one, by each test.
const RELATED: f64 = 1e-3;
/// Chance at which an output of the model is taken for an unrelated one.
const CLAIM: f64 = 1e-6;
/// Samples that inputs are looked back by.
const LAGS: usize = 4;

/// The records as far as one output can be judged, one after the other.
#[derive(Default)]
struct Joined {
    y: Vec<f64>,
    simulated: Vec<f64>,
    /// Inputs, and outputs beside y.
    others: Vec<Vec<f64>>,
    segments: Vec<std::ops::Range<usize>>,
}

/// Outputs that have no relation to anything, though their simulation says they would; but for those
/// that are known to be dead.
pub(crate) fn unrelated(
    system: &System,
    records: &[Record],
    dead: &[Fault],
) -> Result<Vec<Fault>, EvaluateError> {
    let windows = windows(records);
    let part = windows.as_deref().unwrap_or(records);
    let mut faults = vec![];
    for (o, signal) in system.signals().outputs.iter().enumerate() {
        let columns = part.iter().filter_map(|r| r.signal(&signal.name));
        let known = columns.flat_map(|c| &c.values).filter(|v| v.is_finite()).count();
        if known < FEWEST || dead.iter().any(|fault| fault.into == signal.name) {
            continue;
        }
        let Some(joined) = joined(system, part, o)? else { continue };
        let Some(p_value) = joined.claim().filter(|p| *p < CLAIM) else { continue };
        if joined.is_related() {
            continue;
        }
        let readings: Vec<f64> = joined.y.iter().copied().filter(|v| v.is_finite()).collect();
        let noise = deviation(&readings);
        let is_level = is_white(&readings);
        faults.push(Fault {
            kind: FaultKind::Unrelated { level: mean(&readings), noise, is_level, p_value },
            into: signal.name.clone(),
            unit: signal.unit.clone(),
            rows: vec![],
            removed: 0.0,
            or_in: vec![],
        });
    }
    Ok(faults)
}

/// An output with what it may be related to; `None` where it was not measured.
fn joined(system: &System, records: &[Record], o: usize) -> Result<Option<Joined>, EvaluateError> {
    let mut all = Joined::default();
    for record in records {
        let run = Run::new(system, record)?;
        let Some(y) = &run.measured[o] else { continue };
        // a start that was fitted to y would be related to it
        let count = run.init_samples(Init::Forgotten);
        let simulated = run.track(run.starts(0)).y.swap_remove(o);
        let first = all.y.len();
        let usable =
            |k: usize| run.drive.segments.iter().any(|s| (s.start + count..s.end).contains(&k));
        all.y.extend(y.iter().enumerate().map(|(k, v)| if usable(k) { *v } else { f64::NAN }));
        all.simulated.extend(simulated);
        let others = run.measured.iter().enumerate().filter(|(other, _)| *other != o);
        let others = others.filter_map(|(_, other)| other.as_ref());
        for (i, column) in run.drive.inputs.iter().chain(others).enumerate() {
            if all.others.len() <= i {
                all.others.push(vec![0.0; first]);
            }
            let level = mean(&column.iter().copied().filter(|v| v.is_finite()).collect::<Vec<_>>());
            all.others[i].extend(column.iter().map(|v| if v.is_finite() { *v } else { level }));
        }
        let segments = run.drive.segments.iter();
        all.segments.extend(segments.map(|s| s.start + first..s.end + first));
        all.others.iter_mut().for_each(|column| column.resize(all.y.len(), 0.0));
    }
    Ok((!all.y.is_empty()).then_some(all))
}

impl Joined {
    /// Probability of the readings if they were the simulation and noise; `None` where that cannot be
    /// told.
    fn claim(&self) -> Option<f64> {
        let r: Vec<f64> = self.y.iter().zip(&self.simulated).map(|(y, s)| y - s).collect();
        // beside its own past a wandering reading is asked for the steps of s, not its level
        let z = centred(&self.simulated);
        let tested: Vec<Vec<f64>> = (0..LAGS).map(|lag| late(&z, lag)).collect();
        let (segments, nuisance) = (&self.segments[..], &[vec![1.0; r.len()]][..]);
        let test = Regression { r: &r, segments, nuisance, tested: &tested };
        test.test().map(|found| found.p_value)
    }

    /// Whether anything speaks against independence.
    fn is_related(&self) -> bool {
        self.is_coherent() || self.depends().is_none_or(|p| p < RELATED)
    }

    /// Probability of as much dependence on the others and their past if there were none.
    fn depends(&self) -> Option<f64> {
        let nuisance = [vec![1.0; self.y.len()]];
        let mut tested = vec![];
        for lag in 0..LAGS {
            for column in std::iter::once(&self.simulated).chain(&self.others) {
                let z = centred(column);
                let late = late(&z, lag);
                let curve = |f: fn(f64) -> f64| late.iter().map(|&z| f(z)).collect::<Vec<f64>>();
                tested.extend([curve(|z| z), curve(|z| z * z), curve(|z| z * z.abs())]);
            }
        }
        let segments = &self.segments[..];
        let test = Regression { r: &self.y, segments, nuisance: &nuisance, tested: &tested };
        test.test().map(|found| found.p_value)
    }

    /// Whether its coherence with the simulation, or with all others together, is above chance.
    fn is_coherent(&self) -> bool {
        let column = |name: &str, values: &[f64]| crate::data::Signal {
            name: name.into(),
            unit: String::new(),
            values: values.to_vec(),
        };
        let seen = |inputs: Vec<crate::data::Signal>| {
            let record = Record {
                source: String::new(),
                sampling_time: 1.0,
                start: 0.0,
                inputs,
                outputs: vec![column("y", &self.y)],
                segments: self.segments.clone(),
            };
            coherences(&record, RELATED).iter().any(|found| found.band.is_some())
        };
        let others = self.others.iter().map(|other| column("u", other)).collect();
        seen(vec![column("s", &self.simulated)]) || seen(others)
    }
}

/// A series so many samples later.
fn late(of: &[f64], lag: usize) -> Vec<f64> {
    (0..of.len()).map(|k| of[k.saturating_sub(lag)]).collect()
}

/// A series about its mean in units of its deviation.
fn centred(of: &[f64]) -> Vec<f64> {
    let known: Vec<f64> = of.iter().copied().filter(|v| v.is_finite()).collect();
    let (centre, size) = (mean(&known), deviation(&known).max(f64::MIN_POSITIVE));
    of.iter().map(|v| (v - centre) / size).collect()
}
