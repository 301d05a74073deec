//! What `lacuna new` is told.

use std::path::PathBuf;

use clap::Args as Arguments;

use super::{Columns, positive};

#[derive(Debug, Clone, Arguments)]
pub struct New {
    /// A registered model (`lacuna models` lists them)
    #[arg(value_name = "MODEL", required_unless_present = "data", conflicts_with = "data")]
    pub model: Option<String>,
    /// Record (CSV, .npz, .mat..; - is stdin) whose columns the model has
    #[arg(long, value_name = "FILE")]
    pub data: Option<PathBuf>,
    #[command(flatten)]
    pub columns: Columns,
    /// Derivatives of each output that the equations have
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = positive)]
    pub order: usize,
    /// Time between two samples in s, for records without a column `time`
    #[arg(long, value_name = "S", value_parser = super::estimate::seconds)]
    pub sampling_time: Option<f64>,
    /// Model file to write; - is stdout [default: stdout]
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}
