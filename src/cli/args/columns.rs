//! Which columns of a record are what, and whether its clock is repaired.

use clap::Args as Arguments;
use lacuna::data::Reading;

#[derive(Debug, Clone, Default, Arguments)]
#[command(next_help_heading = "Columns")]
pub struct Columns {
    /// Columns for the model's inputs, in its order [default: of the same names, or u, u1..]
    #[arg(long, value_name = "COLUMN", value_delimiter = ',', num_args = 1..)]
    pub inputs: Vec<String>,
    /// Columns for the model's outputs, in its order [default: of the same names, or y, y1..]
    #[arg(long, value_name = "COLUMN", value_delimiter = ',', num_args = 1..)]
    pub outputs: Vec<String>,
    /// Another name for a column, such as t=time
    #[arg(long, value_name = "OLD=NEW", value_delimiter = ',', num_args = 1.., value_parser = pair)]
    pub rename: Vec<(String, String)>,
    /// Makes an irregular clock regular: sorts, fills single missing rows, resamples; says what it
    /// did, and writes repaired.csv where there is a folder for it
    #[arg(long)]
    pub repair: bool,
}

impl Columns {
    /// For a model, whose inputs and outputs are known.
    pub fn reading(&self) -> Reading {
        Reading {
            inputs: self.inputs.clone(),
            outputs: self.outputs.clone(),
            rename: self.rename.clone(),
            repair: self.repair,
        }
    }
}

fn pair(text: &str) -> Result<(String, String), String> {
    match text.split_once('=').map(|(old, new)| (old.trim(), new.trim())) {
        Some((old, new)) if !old.is_empty() && !new.is_empty() => Ok((old.into(), new.into())),
        _ => Err("the old name and the new one are needed, such as t=time".into()),
    }
}
