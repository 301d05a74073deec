//! What `lacuna estimate` is told.

use std::path::PathBuf;

use clap::Args as Arguments;

use super::{Columns, positive};

#[derive(Debug, Clone, Arguments)]
pub struct Estimate {
    /// Model file (TOML or JSON)
    #[arg(long, value_name = "FILE", required_unless_present = "lti", conflicts_with = "lti")]
    pub model: Option<PathBuf>,
    /// A linear model of this order instead of a given model [default order: as many states as
    /// stand above the noise]
    #[arg(long, value_name = "N", num_args = 0..=1, value_parser = positive)]
    pub lti: Option<Option<usize>>,
    /// Record (CSV, .npz, .mat..; - is stdin); may be repeated for several records of one machine
    #[arg(long, value_name = "FILE", required = true)]
    pub data: Vec<PathBuf>,
    /// Model file to write; - is stdout, which then holds nothing else
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
    /// Parameters that are right
    #[arg(long, value_name = "PARAMETER", value_delimiter = ',', num_args = 1.., conflicts_with = "lti")]
    pub fix: Vec<String>,
    /// Another optimiser: its name, its settings (`lbfgs = { memory = 20 }`), or a file with them
    #[arg(long, value_name = "OPTIMISER", conflicts_with = "lti")]
    pub optimiser: Option<String>,
    #[command(flatten)]
    pub columns: Columns,
    /// Time between two samples in s, for records without a column `time`
    #[arg(long, value_name = "S", value_parser = seconds, conflicts_with = "model")]
    pub sampling_time: Option<f64>,
}

pub(super) fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(step) if step > 0.0 && step.is_finite() => Ok(step),
        _ => Err("a positive number of seconds is needed".into()),
    }
}
