//! Arguments of `lacuna check`.

use clap::Args as Arguments;
use lacuna::diagnose::Memory;

use super::ModelAndData;

#[derive(Debug, Clone, Arguments)]
pub struct Check {
    #[command(flatten)]
    pub on: ModelAndData,
    /// Probability of rejecting a model that is right
    #[arg(long, value_name = "P", default_value_t = 0.01, value_parser = probability)]
    pub level: f64,
    /// Memory that it may take, such as 2GB or 512MiB; what does not fit is left out by rule and said
    /// [default: half of the machine's]
    #[arg(long, value_name = "SIZE")]
    pub memory: Option<Memory>,
}

fn probability(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(level) if level > 0.0 && level < 1.0 => Ok(level),
        _ => Err("a number between 0 and 1 is needed".into()),
    }
}
