//! Arguments of `lacuna look`.

use std::path::PathBuf;

use clap::Args as Arguments;

use super::Columns;

#[derive(Debug, Clone, Arguments)]
pub struct Look {
    /// Model file (TOML or JSON)
    #[arg(long, value_name = "FILE")]
    pub model: Option<PathBuf>,
    /// Record (CSV); may be repeated for several records of one machine
    #[arg(long, value_name = "FILE", required = true)]
    pub data: Vec<PathBuf>,
    #[command(flatten)]
    pub columns: Columns,
    /// Folder for the page
    #[arg(long, value_name = "DIR", default_value = "lacuna-out")]
    pub out: PathBuf,
}
