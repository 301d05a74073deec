//! What `lacuna man` is told.

use std::path::PathBuf;

use clap::Args as Arguments;

#[derive(Debug, Clone, Arguments)]
pub struct Man {
    /// Folder for one page a command [default: the main page on stdout]
    #[arg(long, value_name = "DIR", value_parser = super::folder::folder())]
    pub out: Option<PathBuf>,
    /// Writes the reference of the book instead: Markdown pages of all commands, models, effects and
    /// JSON fields
    #[arg(long, requires = "out")]
    pub markdown: bool,
}
