//! A record before any model: what a measured signal is like, and what inputs say about outputs.
//!
//! ```text
//! Record -- signal --> range, grain, clipping, excitation      each signal alone
//!        -- spectra --> lines that stand out, coherence        Welch's method
//!        -- lags --> delay, reaction of inputs to outputs      after whitening
//! ```
//!
//! Nothing is fitted but autoregressions; every decision is a test whose level is stated where
//! it is made. [`Look::of`] gives numbers, `Display` the same in words, [`Look::page`] a page.

mod lags;
mod page;
mod signal;
mod spectra;
mod words;

use crate::data::Record;
use serde::Serialize;

// machinery that sibling crates and the program share; it may change at any time
#[doc(hidden)]
pub use self::{
    lags::Response, signal::Clipped, signal::SignalLook, spectra::Coherence, spectra::Line,
};

/// What a record is like.
///
/// ```
/// use lacuna::data::Record;
/// use lacuna::look::Look;
///
/// let u: Vec<f64> = (0..2000).map(|k| ((k * k) as f64 * 0.7).sin()).collect();
/// let y: Vec<f64> = (0..2000).map(|k| if k < 3 { 0.0 } else { 2.0 * u[k - 3] }).collect();
/// let record = Record::new(0.1).input("u [N]", u)?.output("y [m]", y)?;
/// let look = Look::of(&record);
/// assert_eq!(look.responses[0].delay_samples, Some(3));
/// assert!(look.coherences[0].share > 0.95);
/// # Ok::<(), lacuna::data::DataError>(())
/// ```
#[derive(Debug, Clone, Serialize)]
pub struct Look {
    /// Where the record comes from.
    pub source: String,
    /// Number of samples.
    pub samples: usize,
    /// Step, s.
    pub sampling_time: f64,
    /// Time of the first sample, s.
    pub start: f64,
    /// Number of stretches with every input present.
    pub segments: usize,
    /// Each input and output.
    pub signals: Vec<SignalLook>,
    /// Per output, how much of it the inputs account for linearly.
    pub coherences: Vec<Coherence>,
    /// Per input and output, when the output answers, and whether the input reacts.
    pub responses: Vec<Response>,
    /// The period of the inputs, where they repeat.
    pub period: Option<Period>,
    #[serde(skip)]
    drawn: page::Drawn,
}

/// Inputs that repeat.
#[doc(hidden)]
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Period {
    /// Samples in one period.
    pub samples: usize,
    /// Whole periods.
    pub count: usize,
    /// Per output, the standard deviation of what differs from period to period, in its unit:
    /// the noise, without any model. The first period, in which the start dies away, is left
    /// out where there are three or more.
    pub noise: Vec<f64>,
}

/// Coherence of every output of a record with all inputs together; `level` is the chance, over all
/// frequencies, at which unrelated signals have a band.
#[doc(hidden)]
pub fn coherences(record: &Record, level: f64) -> Vec<Coherence> {
    spectra::Spectra::of(record).coherences(record, level)
}

impl Look {
    /// Looks at a record.
    pub fn of(record: &Record) -> Self {
        let spectra = spectra::Spectra::of(record);
        let signals: Vec<SignalLook> = record
            .signals()
            .enumerate()
            .map(|(k, signal)| SignalLook::of(record, signal, k < record.inputs.len(), &spectra, k))
            .collect();
        Self {
            source: record.source.clone(),
            samples: record.len(),
            sampling_time: record.sampling_time,
            start: record.start,
            segments: record.segments.len(),
            coherences: spectra.coherences(record, spectra::LEVEL),
            responses: lags::responses(record),
            period: Period::of(record),
            drawn: page::Drawn::of(record, &spectra),
            signals,
        }
    }
}

impl Period {
    fn of(record: &Record) -> Option<Self> {
        let periods = record.periods()?;
        let skipped = usize::from(periods.count > 2);
        let noise = record.outputs.iter().map(|output| {
            let (mut sum, mut freedom) = (0.0, 0_usize);
            for k in 0..periods.samples {
                let alike: Vec<f64> = (skipped..periods.count)
                    .map(|p| output.values[p * periods.samples + k])
                    .filter(|value| value.is_finite())
                    .collect();
                let mean = alike.iter().sum::<f64>() / alike.len().max(1) as f64;
                sum += alike.iter().map(|value| (value - mean).powi(2)).sum::<f64>();
                freedom += alike.len().saturating_sub(1);
            }
            (sum / freedom.max(1) as f64).sqrt()
        });
        Some(Self { samples: periods.samples, count: periods.count, noise: noise.collect() })
    }
}

#[cfg(test)]
mod tests;
