//! What `lacuna report` takes.

use std::path::PathBuf;

use clap::Args as Arguments;

#[derive(Debug, Clone, Arguments)]
pub struct Report {
    /// Folder of a diagnosis, or its diagnosis.json
    #[arg(value_name = "DIR", default_value = "lacuna-out")]
    pub of: PathBuf,
    /// File for the page; - is stdout [default: report.html in that folder]
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}
