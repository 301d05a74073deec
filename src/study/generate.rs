//! Records with known truth: excitation, simulation, noise.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::StudyError;
use crate::data::{Excitation, Record, noise};
use crate::evaluate::{Init, Simulation};
use crate::system::{Placed, System};

/// How records are made of a system.
///
/// # Example
///
/// ```
/// use lacuna::plugins::systems::Duffing;
/// use lacuna::study::Generate;
/// use lacuna::system::{Sampling, System};
///
/// let model = Duffing { mass: 1.0, damping: 2.0, stiffness: 50.0, hardening: 0.0, fixed: vec![] };
/// let system = System::new(model, Sampling { sampling_time: Some(0.02), ..Sampling::default() });
/// let how: Generate = toml::from_str(
///     "model = 'spring.toml'\nsamples = { est = 500, test = 300 }\nsnr_db = 20.0\n\
///      [excitation.filtered_noise]\nrms = 3.0\ncutoff = 5.0\norder = 2\n\
///      [[hidden]]\ninto = 'force'\nof = 'v'\neffect.cubic = { coefficient = -0.5 }",
/// )?;
/// let made = how.make(&system, 1)?;
/// assert_eq!((made.est.len(), made.test.len(), made.truth.hidden.len()), (500, 300, 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Generate {
    /// The model file, seen from the configuration file.
    pub model: String,
    /// s; absent: the model file's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sampling_time: Option<f64>,
    /// Samples of each record.
    pub samples: Samples,
    /// What drives every input, with phases or draws of its own.
    pub excitation: Excitation,
    /// Other excitations of named inputs.
    #[serde(default)]
    pub inputs: BTreeMap<String, Excitation>,
    /// Constants added to named inputs, in their units.
    #[serde(default)]
    pub offset: BTreeMap<String, f64>,
    /// Ratio of output to white noise, dB; absent: no noise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub snr_db: Option<f64>,
    /// Samples simulated before each record and left out.
    #[serde(default)]
    pub transient: usize,
    /// Whether columns `<output>_clean` without noise stand beside the outputs.
    #[serde(default)]
    pub clean: bool,
    /// What the simulated system has and the model file has not.
    #[serde(default)]
    pub hidden: Vec<Placed>,
}

/// Lengths of the two records.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Samples {
    /// Of the one to learn from.
    pub est: usize,
    /// Of the one to score on.
    pub test: usize,
}

/// Two records of one system.
#[derive(Debug, Clone)]
pub struct Generated {
    /// The one to learn from.
    pub est: Record,
    /// The one to score on, with other phases or draws.
    pub test: Record,
    /// What is known about them.
    pub truth: Truth,
}

/// What is known about made records.
#[derive(Debug, Clone, Serialize)]
pub struct Truth {
    /// Version of this form.
    pub schema: u32,
    /// Everything random follows from it.
    pub seed: u64,
    /// The model file.
    pub model: String,
    /// s.
    pub sampling_time: f64,
    /// What was hidden.
    pub hidden: Vec<Placed>,
    /// Record by record, output by output.
    pub records: BTreeMap<&'static str, BTreeMap<String, OutputTruth>>,
}

/// What is known about one output of one record, in its unit.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct OutputTruth {
    /// Standard deviation without noise.
    pub std: f64,
    /// Root mean square of the noise that was added.
    pub noise_rms: f64,
    /// What the hidden effects change: RMSE of the model file's own free run against the
    /// output without noise, from the same initial state.
    pub hidden_rmse: f64,
}

/// Keeps the seeds of records, inputs and noises apart.
pub(super) fn seed_of(seed: u64, record: u64, what: u64) -> u64 {
    let mut mixed = seed ^ 0x6a09_e667_f3bc_c908;
    for part in [record, what] {
        mixed = (mixed ^ part).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        mixed ^= mixed >> 29;
    }
    mixed
}

/// A number far from those of other seeds: a user's seeds are often neighbours, and what they draw
/// must have nothing in common.
pub(super) fn apart(seed: u64) -> u64 {
    let mut mixed = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    for (by, times) in [(30, 0xbf58_476d_1ce4_e5b9), (27, 0x94d0_49bb_1331_11eb)] {
        mixed = (mixed ^ (mixed >> by)).wrapping_mul(times);
    }
    mixed ^ (mixed >> 31)
}

/// Samples of a made record at most; a record has several columns of them.
const MOST_SAMPLES: usize = 100_000_000;

/// Refuses a length before memory is taken for it.
pub(super) fn fits(key: &str, samples: usize) -> Result<(), StudyError> {
    match samples <= MOST_SAMPLES {
        true => Ok(()),
        false => Err(StudyError::setting(key, samples, &format!("at most {MOST_SAMPLES}"))),
    }
}

impl Generate {
    /// Both records.
    ///
    /// # Errors
    ///
    /// If a setting is out of range, a name is unknown, or the system diverges.
    pub fn make(&self, system: &System, seed: u64) -> Result<Generated, StudyError> {
        let sampling_time = system.sampling_time(self.sampling_time)?;
        let lengths = [
            ("samples.est", self.samples.est),
            ("samples.test", self.samples.test),
            ("transient", self.transient),
        ];
        lengths.into_iter().try_for_each(|(key, length)| fits(key, length))?;
        let mut records = BTreeMap::new();
        let mut one = |name: &'static str, samples: usize, number: u64| {
            let (record, truth) = self.record(system, sampling_time, samples, seed, number)?;
            records.insert(name, truth);
            Ok::<_, StudyError>(record)
        };
        let est = one("est", self.samples.est, 0)?;
        let test = one("test", self.samples.test, 1)?;
        let (model, hidden) = (self.model.clone(), self.hidden.clone());
        let truth = Truth { schema: 1, seed, model, sampling_time, hidden, records };
        Ok(Generated { est, test, truth })
    }

    fn record(
        &self,
        system: &System,
        sampling_time: f64,
        samples: usize,
        seed: u64,
        number: u64,
    ) -> Result<(Record, BTreeMap<String, OutputTruth>), StudyError> {
        let (signals, seed) = (system.signals(), apart(seed));
        for (key, name) in self
            .inputs
            .keys()
            .map(|n| ("inputs", n))
            .chain(self.offset.keys().map(|n| ("offset", n)))
        {
            if !signals.inputs.iter().any(|input| input.name == *name) {
                let known: Vec<&str> = signals.inputs.iter().map(|i| &i.name[..]).collect();
                let expected = format!("an input of the model ({})", known.join(", "));
                return Err(StudyError::setting(key, name, &expected));
            }
        }
        if samples == 0 {
            return Err(StudyError::setting("samples", 0, "at least 1"));
        }
        let all = samples + self.transient;
        let mut driven = Record::new(sampling_time);
        for (i, input) in signals.inputs.iter().enumerate() {
            let excitation = self.inputs.get(&input.name).unwrap_or(&self.excitation);
            let offset = self.offset.get(&input.name).copied().unwrap_or(0.0);
            let mut u = excitation.generate(all, sampling_time, seed_of(seed, number, i as u64))?;
            u.iter_mut().for_each(|u| *u += offset);
            driven = driven.input(&header(&input.name, &input.unit), u)?;
        }
        // the record begins after the transient, and there its time is 0
        driven.start = -(self.transient as f64) * sampling_time;
        let mut truth = system.clone();
        truth.effects.extend(self.hidden.iter().cloned());
        let run = |system: &System| -> Result<Simulation, StudyError> {
            let run = Simulation::of(system, &driven, Init::Samples(0))?;
            match run.diverged_at {
                Some(sample) => Err(StudyError::Diverges { sample }),
                None => Ok(run),
            }
        };
        let measured = run(&truth)?.outputs;
        let without = if self.hidden.is_empty() { measured.clone() } else { run(system)?.outputs };
        let mut record = driven.slice(self.transient..all);
        record.start = 0.0;
        let mut truths = BTreeMap::new();
        let mut clean_columns = vec![];
        for (o, (output, (name, values))) in signals.outputs.iter().zip(&measured).enumerate() {
            let clean = &values[self.transient..];
            let noise = match self.snr_db {
                Some(snr) => noise::at_snr(clean, snr, seed_of(seed, number, 1000 + o as u64))?,
                None => vec![0.0; samples],
            };
            let y: Vec<f64> = clean.iter().zip(&noise).map(|(y, e)| y + e).collect();
            let off: Vec<f64> =
                clean.iter().zip(&without[o].1[self.transient..]).map(|(a, b)| a - b).collect();
            let truth = OutputTruth {
                std: deviation(clean),
                noise_rms: rms(&noise),
                hidden_rmse: rms(&off),
            };
            truths.insert(name.clone(), truth);
            record = record.output(&header(name, &output.unit), y)?;
            clean_columns.push((format!("{name}_clean"), &output.unit, clean.to_vec()));
        }
        if self.clean {
            for (name, unit, values) in clean_columns {
                record = record.output(&header(&name, unit), values)?;
            }
        }
        Ok((record, truths))
    }
}

fn header(name: &str, unit: &str) -> String {
    if unit.is_empty() { name.into() } else { format!("{name} [{unit}]") }
}

pub(super) fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64).sqrt()
}

pub(super) fn deviation(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    rms(&values.iter().map(|v| v - mean).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbouring_seeds_have_no_record_in_common() {
        let records = (0..100).flat_map(|seed| (0..25).map(move |r| seed_of(apart(seed), r, 0)));
        assert_eq!(records.collect::<std::collections::HashSet<_>>().len(), 2500);
    }
}
