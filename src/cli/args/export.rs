//! What `lacuna export` takes.

use std::path::PathBuf;

use clap::{Args as Arguments, ValueEnum};

/// What a model is written as.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum ExportTo {
    /// C99 without dependencies
    C,
    /// FMI 2.0 and 3.0 co-simulation units
    Fmu,
    /// A MATLAB function
    Matlab,
    /// A Python class that needs numpy
    Python,
}

#[derive(Debug, Clone, Arguments)]
pub struct Export {
    /// Model file (TOML or JSON)
    #[arg(value_name = "MODEL")]
    pub model: PathBuf,
    /// What to write it as
    #[arg(long, value_name = "FORMAT")]
    pub to: ExportTo,
    /// Name of functions and files
    #[arg(long, value_name = "NAME", default_value = "model")]
    pub name: String,
    /// Folder for the files
    #[arg(long, value_name = "DIR", default_value = "lacuna-out", value_parser = super::folder::folder())]
    pub out: PathBuf,
}
