//! Settings of a training beyond one step rule: what counts how much, windows that grow, a
//! finish on the whole objective.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::optimise::{Lbfgs, Named};

/// How much records and outputs count: the weight of one squared error of output o in record r
/// is outputs\[o\] records\[r\], and 0 where it is masked.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Weights {
    /// One number of at least 0 per record, in the order in which they are given; 1 where
    /// absent.
    pub records: Vec<f64>,
    /// One number of at least 0 per output, by name; 1 where absent.
    pub outputs: BTreeMap<String, f64>,
    /// What does not count at all. It is still seen by the encoder.
    pub masks: Vec<Mask>,
}

/// A stretch of one output of one record that does not count.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mask {
    /// Number of the record, from 1.
    pub record: usize,
    /// Name of the output.
    pub output: String,
    /// First sample, from 0.
    #[serde(default)]
    pub from: usize,
    /// One beyond the last sample; absent: to the end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<usize>,
}

/// Sections that grow from a few samples to their full length, by equal factors: short ones
/// have no bad minima, long ones see slow errors (Ribeiro et al., Automatica 121, 2020).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Growing {
    /// Samples at the beginning.
    pub from: usize,
    /// Epochs until the full length is reached.
    pub epochs: usize,
}

impl Growing {
    /// Samples in an epoch, of `full` at the end: from (full / from)^(epoch / epochs).
    pub fn length(self, full: usize, epoch: usize) -> usize {
        if epoch >= self.epochs || self.from >= full {
            return full;
        }
        let share = epoch as f64 / self.epochs as f64;
        let length = self.from as f64 * (full as f64 / self.from as f64).powf(share);
        (length.round() as usize).clamp(1, full)
    }
}

/// A finish after the epochs: another optimiser on all sections at once, or on many of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Finish {
    /// The optimiser; L-BFGS where absent.
    pub optimiser: Named,
    /// Legs: after each there is a validation and a checkpoint.
    pub legs: usize,
    /// Steps in a leg.
    pub steps: usize,
    /// Sections at most, evenly spread; 0 for all. A section for every sample sees each sample
    /// once for each of its own.
    #[serde(skip_serializing_if = "is_all")]
    pub sections: usize,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "what serde asks for")]
fn is_all(sections: &usize) -> bool {
    *sections == 0
}

impl Default for Finish {
    fn default() -> Self {
        Self { optimiser: Lbfgs::default().into(), legs: 10, steps: 50, sections: 0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_grow_by_equal_factors_to_the_full_length() {
        let growing = Growing { from: 10, epochs: 3 };
        let lengths: Vec<usize> = (0..5).map(|epoch| growing.length(80, epoch)).collect();
        assert_eq!(lengths, [10, 20, 40, 80, 80]);
        assert_eq!(growing.length(5, 0), 5);
    }

    #[test]
    fn a_finish_is_quasi_newton_unless_another_is_named() {
        let finish: Finish = toml::from_str("legs = 3").unwrap();
        assert_eq!((finish.optimiser.name(), finish.legs, finish.steps), ("lbfgs", 3, 50));
        let finish: Finish = toml::from_str("[optimiser.adam]\nrate = 0.1").unwrap();
        assert_eq!(finish.optimiser.name(), "adam");
    }
}
