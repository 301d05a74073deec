//! Under which conditions a record is taken: its length, its noises, what is off, when a cause begins.

use serde::{Deserialize, Serialize};

use super::Exam;

/// What the sensor adds. Each kind has the mean square that the ratio of output to noise asks for.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Noise {
    /// Gaussian, without memory.
    #[default]
    White,
    /// Gaussian, of first order: e\[k\] = pole e\[k-1\] + w\[k\].
    Coloured {
        /// Between -1 and 1.
        pole: f64,
    },
    /// Student's t, without memory.
    HeavyTailed {
        /// Degrees of freedom, at least 3: below, it has no variance.
        freedom: u32,
    },
    /// White, of a standard deviation that grows along the record.
    Growing {
        /// Last standard deviation over the first.
        times: f64,
    },
    /// White, of a standard deviation that follows the output's distance from its mean; a tenth of
    /// it is there always.
    Proportional,
    /// White, then rounded to the steps of a converter.
    Quantised {
        /// Rounding error over the whole, as standard deviations; between 0 and 1.
        share: f64,
    },
    /// White and a random walk.
    RandomWalk {
        /// The walk over the whole, as root mean squares along the record; between 0 and 1.
        share: f64,
    },
}

impl Noise {
    /// What a noise with this pole is called.
    pub(super) fn of_pole(pole: f64) -> Self {
        if pole == 0.0 { Self::White } else { Self::Coloured { pole } }
    }

    /// Whether its settings are in range.
    pub(super) fn is_possible(self) -> bool {
        match self {
            Self::White | Self::Proportional => true,
            Self::Coloured { pole } => pole.abs() < 1.0,
            Self::HeavyTailed { freedom } => (3..=1000).contains(&freedom),
            Self::Growing { times } => times.is_finite() && times > 0.0,
            Self::Quantised { share } | Self::RandomWalk { share } => share > 0.0 && share < 1.0,
        }
    }
}

impl std::fmt::Display for Noise {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::White => f.write_str("white"),
            Self::Coloured { pole } => write!(f, "pole {pole}"),
            Self::HeavyTailed { freedom } => write!(f, "Student t of {freedom}"),
            Self::Growing { times } => write!(f, "growing {times}-fold"),
            Self::Proportional => f.write_str("proportional"),
            Self::Quantised { share } => write!(f, "quantised {share}"),
            Self::RandomWalk { share } => write!(f, "random walk {share}"),
        }
    }
}

/// What cases have in common beside the machine and what is hidden.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Conditions {
    /// Samples of each record.
    pub samples: usize,
    /// Records.
    pub records: usize,
    /// Ratio of output to noise, dB.
    pub snr_db: f64,
    /// What the sensor adds.
    pub noise: Noise,
    /// What noise in the model's channels does to the outputs: RMS over that of the sensor's noise.
    pub process_noise: f64,
    /// Noise of the recorded inputs: RMS over the standard deviation of the input.
    pub input_noise: f64,
    /// Share of the record after which the hidden effects begin.
    pub onset: f64,
    /// Share by which the model's free parameters are off.
    pub parameter_error: f64,
}

impl Exam {
    /// All conditions, in order.
    pub(super) fn conditions(&self) -> Vec<Conditions> {
        let poles = self.noise_pole.iter().map(|&pole| Noise::of_pole(pole));
        let noises: Vec<Noise> = poles.chain(self.noise.iter().copied()).collect();
        let mut all = vec![];
        for &samples in &self.samples {
            for &snr_db in &self.snr_db {
                for &noise in &noises {
                    for &parameter_error in &self.parameter_error {
                        for &process_noise in &self.process_noise {
                            for &input_noise in &self.input_noise {
                                for &onset in &self.onset {
                                    all.extend(self.records.iter().map(|&records| Conditions {
                                        samples,
                                        records,
                                        snr_db,
                                        noise,
                                        process_noise,
                                        input_noise,
                                        onset,
                                        parameter_error,
                                    }));
                                }
                            }
                        }
                    }
                }
            }
        }
        all
    }
}

impl std::fmt::Display for Conditions {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} samples, {} dB, {}", self.samples, self.snr_db, self.noise)?;
        let percent = |share: f64| 100.0 * share;
        if self.records > 1 {
            write!(f, ", {} records", self.records)?;
        }
        if self.process_noise > 0.0 {
            write!(f, ", noise in the states {}", self.process_noise)?;
        }
        if self.input_noise > 0.0 {
            write!(f, ", inputs {:.0} % noisy", percent(self.input_noise))?;
        }
        if self.onset > 0.0 {
            write!(f, ", from {:.0} % on", percent(self.onset))?;
        }
        if self.parameter_error > 0.0 {
            write!(f, ", parameters {:.0} % off", percent(self.parameter_error))?;
        }
        Ok(())
    }
}
