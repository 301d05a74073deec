//! Arguments of `lacuna look`.

use std::path::PathBuf;

use clap::Args as Arguments;

use super::Columns;

#[derive(Debug, Clone, Arguments)]
pub struct Look {
    /// Model file (TOML or JSON): shows the missing force instead of the record
    #[arg(long, value_name = "FILE")]
    pub model: Option<PathBuf>,
    /// Record (CSV, .npz, .mat..; - is stdin); may be repeated for several records of one machine
    #[arg(long, value_name = "FILE", required = true)]
    pub data: Vec<PathBuf>,
    #[command(flatten)]
    pub columns: Columns,
    /// Time between two samples in s, for records without a column `time`
    #[arg(long, value_name = "S", value_parser = super::estimate::seconds, conflicts_with = "model")]
    pub sampling_time: Option<f64>,
    /// Folder for the page
    #[arg(long, value_name = "DIR", default_value = "lacuna-out", value_parser = super::folder::folder())]
    pub out: PathBuf,
}
