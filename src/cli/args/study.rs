//! What `lacuna study` takes.

use std::path::PathBuf;

use clap::{Args as Arguments, Subcommand};
use lacuna::diagnose::Memory;

#[derive(Debug, Clone, Arguments)]
pub struct Study {
    #[command(subcommand)]
    pub verb: Option<StudyVerb>,
    /// What is compared (TOML or JSON)
    #[arg(long, value_name = "FILE", required = true)]
    pub config: Option<PathBuf>,
    /// Only every n-th training, from the i-th on; `merge` puts the shards together
    #[arg(long, value_name = "I/N", value_parser = shard)]
    pub shard: Option<(usize, usize)>,
    /// Only lists the keys of all cases, one a line
    #[arg(long, conflicts_with_all = ["shard", "case"])]
    pub cases: bool,
    /// Only these cases, by their keys; each writes one file, and what is there is not done again
    #[arg(long, value_name = "KEY", num_args = 1.., conflicts_with = "shard")]
    pub case: Vec<String>,
    /// Memory that one diagnosis of an exam may take, such as 2GB or 512MiB, as many at once as there are
    /// threads; what does not fit is left out by rule [default: half of the machine's]
    #[arg(long, value_name = "SIZE")]
    pub memory: Option<Memory>,
    /// Folder for the results
    #[arg(long, value_name = "DIR", default_value = "lacuna-out", value_parser = super::folder::folder())]
    pub out: PathBuf,
}

#[derive(Debug, Clone, Subcommand)]
pub enum StudyVerb {
    /// Puts the results of all shards together
    #[command(after_help = "Example:\n  lacuna study merge shard1 shard2 --out study")]
    Merge(Merge),
}

#[derive(Debug, Clone, Arguments)]
pub struct Merge {
    /// Folders that shards wrote into
    #[arg(value_name = "DIR", required = true)]
    pub folders: Vec<PathBuf>,
    /// Folder for the results
    #[arg(long, value_name = "DIR", default_value = "lacuna-out", value_parser = super::folder::folder())]
    pub out: PathBuf,
}

pub(super) fn shard(text: &str) -> Result<(usize, usize), String> {
    let parts = text.split_once('/').map(|(i, n)| (i.parse(), n.parse()));
    match parts {
        Some((Ok(i), Ok(n))) if 1 <= i && i <= n => Ok((i, n)),
        _ => Err("i/n with i from 1 to n is needed, such as 2/4".into()),
    }
}
