//! Columns of numbers as text: what a page carries of its figures.
//!
//! A column is a sequence of equal steps, or values as base64 of little-endian `f32`, or of
//! `u16` codes that divide the range of the column evenly:
//!
//! ```text
//! value = low + code (high - low) / 65534        code 65535: no value
//! ```
//!
//! Simulations are stored as measured minus residual, so that the residual, which is what a
//! report is about, keeps the whole resolution however small it is.

use std::collections::HashMap;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde::{Deserialize, Serialize};

/// Characters of base64 that the columns of one page may take.
const BUDGET: usize = 1_400_000;
/// Columns up to this length keep `f32` whatever the budget.
const SHORT: usize = 2000;
/// Largest code; the next one says that there is no value.
const CODES: f64 = 65534.0;

/// A column as it is stored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Stored {
    /// `start + k step`.
    Even {
        /// Number of values.
        n: usize,
        /// First value.
        start: f64,
        /// Difference between neighbours.
        step: f64,
    },
    /// Single precision, little-endian, base64.
    F32(String),
    /// Codes of two bytes, little-endian, base64, between two values.
    U16 {
        /// Value of code 0.
        low: f64,
        /// Value of code 65534.
        high: f64,
        /// The codes.
        codes: String,
    },
}

impl Stored {
    /// The values; `None` where a stored form is damaged.
    pub fn values(&self) -> Option<Vec<f64>> {
        match self {
            Self::Even { n, start, step } => {
                // no more than any page holds: a damaged file asks for no memory
                (*n <= 100_000_000)
                    .then(|| (0..*n).map(|k| start + k as f64 * step).collect::<Vec<f64>>())
            }
            Self::F32(text) => {
                let bytes = STANDARD.decode(text).ok()?;
                let each = bytes.chunks_exact(4);
                Some(
                    each.map(|b| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]))).collect(),
                )
            }
            Self::U16 { low, high, codes } => {
                let bytes = STANDARD.decode(codes).ok()?;
                let value = |b: &[u8]| match u16::from_le_bytes([b[0], b[1]]) {
                    u16::MAX => f64::NAN,
                    code => low + f64::from(code) * (high - low) / CODES,
                };
                Some(bytes.chunks_exact(2).map(value).collect())
            }
        }
    }

    fn even(values: &[f64]) -> Option<Self> {
        let (first, last) = (*values.first()?, *values.last()?);
        if values.len() < 3 || !(last - first).is_finite() {
            return None;
        }
        let step = (last - first) / (values.len() - 1) as f64;
        let near =
            |(k, v): (usize, &f64)| (v - (first + k as f64 * step)).abs() <= 1e-6 * step.abs();
        let even = step != 0.0 && values.iter().enumerate().all(near);
        even.then_some(Self::Even { n: values.len(), start: first, step })
    }

    fn f32(values: &[f64]) -> Self {
        let bytes: Vec<u8> = values.iter().flat_map(|v| (*v as f32).to_le_bytes()).collect();
        Self::F32(STANDARD.encode(bytes))
    }

    fn u16(values: &[f64]) -> Self {
        let finite = || values.iter().copied().filter(|v| v.is_finite());
        let (low, high) =
            (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
        let (low, high) = if low <= high { (low, high) } else { (0.0, 0.0) };
        let over = if high > low { CODES / (high - low) } else { 0.0 };
        let code = |v: &f64| match v.is_finite() {
            true => ((v - low) * over).round() as u16,
            false => u16::MAX,
        };
        let bytes: Vec<u8> = values.iter().flat_map(|v| code(v).to_le_bytes()).collect();
        Self::U16 { low, high, codes: STANDARD.encode(bytes) }
    }
}

/// All columns of a page, each stored once.
#[derive(Debug, Default)]
pub(super) struct Columns {
    known: HashMap<Vec<u64>, usize>,
    all: Vec<Vec<f64>>,
}

impl Columns {
    /// The number of a column.
    pub fn add(&mut self, values: Vec<f64>) -> usize {
        let next = self.all.len();
        let key = values.iter().map(|v| v.to_bits()).collect();
        let number = *self.known.entry(key).or_insert(next);
        if number == next {
            self.all.push(values);
        }
        number
    }

    /// Characters of base64 at so many bytes a value.
    fn size(&self, bytes: usize) -> usize {
        let uneven = self.all.iter().filter(|values| Stored::even(values).is_none());
        uneven
            .map(|values| if values.len() <= SHORT { 4 } else { bytes } * values.len() * 4 / 3)
            .sum()
    }

    /// By how much the long ones are too long for a page even as codes; 1: they are not.
    pub fn excess(&self) -> f64 {
        (self.size(2) as f64 / BUDGET as f64).max(1.0)
    }

    /// All columns as they are stored: in single precision where the page has room for it.
    pub fn stored(&self) -> Vec<Stored> {
        let room = self.size(4) <= BUDGET;
        let store = |values: &Vec<f64>| {
            let short = room || values.len() <= SHORT;
            let uneven = || if short { Stored::f32(values) } else { Stored::u16(values) };
            Stored::even(values).unwrap_or_else(uneven)
        };
        self.all.iter().map(store).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_comes_back_to_its_resolution() {
        let time: Vec<f64> = (0..5000).map(|k| 3.0 + 0.01 * f64::from(k)).collect();
        let mut wave: Vec<f64> = time.iter().map(|t| 7.0 * (3.0 * t).sin()).collect();
        wave[17] = f64::NAN;
        let even = Stored::even(&time).unwrap();
        assert!(matches!(even, Stored::Even { n: 5000, .. }));
        for (stored, bound) in [(Stored::f32(&wave), 5e-7), (Stored::u16(&wave), 14.0 / 65534.0)] {
            let back = stored.values().unwrap();
            assert!(back[17].is_nan() && back.len() == wave.len());
            let worst = back.iter().zip(&wave).filter(|p| p.1.is_finite());
            let worst = worst.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(worst < bound && worst > 0.0, "{worst}");
        }
        assert_eq!(Stored::u16(&[2.0; 4]).values().unwrap(), [2.0; 4]);
        assert!(Stored::u16(&[f64::NAN; 4]).values().unwrap()[0].is_nan());
        assert_eq!(Stored::F32("&".into()).values(), None);
        assert_eq!(Stored::Even { n: usize::MAX, start: 0.0, step: 1.0 }.values(), None);
    }

    #[test]
    fn the_same_column_is_stored_once_and_the_budget_is_kept() {
        let mut columns = Columns::default();
        let noise = |seed: u64| -> Vec<f64> {
            (0..100_000u64).map(|k| (k * (k + 7 * seed) % 9973) as f64).collect()
        };
        assert_eq!(
            [columns.add(noise(1)), columns.add(noise(2)), columns.add(noise(1))],
            [0, 1, 0]
        );
        assert!(columns.excess() == 1.0);
        (3..=4).for_each(|seed| {
            columns.add(noise(seed));
        });
        let stored = columns.stored();
        assert!(stored.iter().all(|s| matches!(s, Stored::U16 { .. })), "two bytes a value");
        assert!(serde_json::to_string(&stored).unwrap().len() < BUDGET);
        (5..=9).for_each(|seed| {
            columns.add(noise(seed));
        });
        assert!(columns.excess() > 1.7, "{}", columns.excess());
    }
}
