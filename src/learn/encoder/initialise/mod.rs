//! First weights for an encoder.

mod least_squares;
mod model_based;
mod prefit;
mod random;

pub use least_squares::LeastSquares;
pub(super) use least_squares::solve_within;
pub use model_based::{About, Innovation, Linearised, Reconstruct};
pub use prefit::{Prefit, PrefitStart};
pub use random::Random;

use super::baseline::Examples;
use super::{Baseline, Encoder, EncoderError, LinearMap, Outputs, Started};
use crate::optimise::Outcome;

/// Gives an encoder its first weights; configuration files name it.
///
/// # Example
///
/// ```
/// use lacuna::encoder::EncoderInitialiser;
///
/// let initialiser: Box<dyn EncoderInitialiser> = toml::from_str("[prefit]\nadam_steps = 50")?;
/// assert_eq!(initialiser.typetag_name(), "prefit");
/// # Ok::<(), toml::de::Error>(())
/// ```
#[typetag::serde]
pub trait EncoderInitialiser: std::fmt::Debug + Send + Sync {
    /// Prepares the encoder for the baseline ([`Baseline::prepare`]), gives it weights and
    /// says how good they are. What is left to chance follows from `seed` alone.
    ///
    /// # Errors
    ///
    /// A baseline that this method does not work for, a record that does not fit, or an
    /// encoder without what the method sets.
    fn initialise(
        &self,
        encoder: &mut dyn Encoder,
        baseline: &Baseline<'_>,
        seed: u64,
    ) -> Result<Started, EncoderError>;
}

/// What a method found out on its way.
#[derive(Debug, Default)]
struct Found {
    rank: Option<usize>,
    condition: Option<f64>,
    optimised: Vec<Outcome>,
    notes: Vec<String>,
}

/// Scores the finished encoder, also on what it learned from.
fn started(
    initialiser: &'static str,
    encoder: &dyn Encoder,
    baseline: &Baseline<'_>,
    found: Found,
    seen: Option<(Outputs, &Examples)>,
) -> Result<Started, EncoderError> {
    let score = |of: Outputs| match seen {
        Some((outputs, examples)) if outputs == of => baseline.score_on(encoder, examples),
        _ => baseline.score(encoder, of),
    };
    let states = score(Outputs::Simulated)?;
    let measured = if baseline.is_measured() { score(Outputs::Measured)? } else { vec![] };
    let Found { rank, condition, optimised, notes } = found;
    Ok(Started { initialiser, rank, condition, states, measured, optimised, notes })
}

/// Prepares an encoder and, where that has no weights (an extrapolation, an observer of one's
/// own), scores it as it is: there is nothing to start.
fn as_it_is(
    initialiser: &'static str,
    encoder: &mut dyn Encoder,
    baseline: &Baseline<'_>,
    seed: u64,
) -> Result<Option<Started>, EncoderError> {
    baseline.prepare(encoder, seed)?;
    if !encoder.weights().is_empty() {
        return Ok(None);
    }
    let notes = vec!["the encoder has no weights: it is used as it is".into()];
    started(initialiser, encoder, baseline, Found { notes, ..Found::default() }, None).map(Some)
}

/// Sets the linear part, naming the method if there is none.
fn set_linear(
    initialiser: &'static str,
    encoder: &mut dyn Encoder,
    map: &LinearMap,
) -> Result<(), EncoderError> {
    encoder.set_linear(map).map_err(|error| match error {
        EncoderError::NoLinearPart { encoder, .. } => {
            EncoderError::NoLinearPart { initialiser, encoder }
        }
        other => other,
    })
}
