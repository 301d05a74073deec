//! What `lacuna diagnose` is told.

use std::path::PathBuf;

use clap::Args as Arguments;

use super::{Columns, positive};
use lacuna::diagnose::Memory;

#[derive(Debug, Clone, Arguments)]
pub struct Diagnose {
    /// Model file (TOML or JSON) [default: a linear model of the record]
    #[arg(long, value_name = "FILE")]
    pub model: Option<PathBuf>,
    /// Record (CSV, .npz, .mat..; - is stdin); may be repeated for several records of one machine
    #[arg(long, value_name = "FILE", required = true)]
    pub data: Vec<PathBuf>,
    #[command(flatten)]
    pub columns: Columns,
    /// Time between two samples in s, for records without a column `time` and without a model
    #[arg(long, value_name = "S", value_parser = super::estimate::seconds, conflicts_with = "model")]
    pub sampling_time: Option<f64>,
    /// Record for scoring, used for nothing else [default: the last 20 % of the data]
    #[arg(long, value_name = "FILE")]
    pub test: Option<PathBuf>,
    /// Folder for the results
    #[arg(long, value_name = "DIR", default_value = "lacuna-out", value_parser = super::folder::folder())]
    pub out: PathBuf,
    /// Effects to look for, and no others
    #[arg(long, value_name = "EFFECT", value_delimiter = ',', num_args = 1..)]
    pub only: Vec<String>,
    /// Effects not to look for
    #[arg(long, value_name = "EFFECT", value_delimiter = ',', num_args = 1..)]
    pub without: Vec<String>,
    /// Parameters that are right
    #[arg(long, value_name = "PARAMETER", value_delimiter = ',', num_args = 1..)]
    pub fix: Vec<String>,
    /// Suppose that all noise sits at the sensors; without this, noise inside the machine (process
    /// noise, noisy inputs, wandering sensors) is weighed where a free run leaves coloured noise
    #[arg(long)]
    pub sensor_noise_only: bool,
    /// Causes at most
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = positive)]
    pub max_causes: usize,
    /// Memory that it may take, such as 2GB or 512MiB; what does not fit is left out by rule and said
    /// [default: half of the machine's]
    #[arg(long, value_name = "SIZE")]
    pub memory: Option<Memory>,
    /// Simulates what was found so many times with noise like the record's, diagnoses each, and says
    /// how often this record would mislead [default: not at all]
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub rehearse: usize,
    /// Only every n-th rehearsal, from the i-th on; a call without --shard and with the same --out
    /// does what is left and tells all
    #[arg(long, value_name = "I/N", value_parser = super::study::shard, requires = "rehearse")]
    pub shard: Option<(usize, usize)>,
    /// Samples from which the test record's initial state is estimated; its figures leave
    /// them out [default: until the start is forgotten, at most 10 %]
    #[arg(long, value_name = "N")]
    pub init: Option<usize>,
}
