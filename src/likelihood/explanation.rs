//! What explains a record: causes with their probabilities, and the noise that is left.

use nalgebra::DMatrix;

use super::noise::Noise;
use super::ranked::FittedLaws;
use crate::system::Placed;

/// One place at which something is missing, and its laws.
#[derive(Debug, Clone)]
pub struct NamedCause {
    /// Channel, input, output or parameter.
    pub into: String,
    /// Coordinate, absent where it depends on nothing.
    pub of: Option<String>,
    /// Laws of the place, an offset of its channel among them; empty for a parameter.
    pub laws: Vec<Placed>,
    /// Covariance of the parameters of each law; 0 where they were not fitted.
    pub covariances: Vec<DMatrix<f64>>,
    /// Value of the parameter, and its standard error.
    pub parameter: Option<(f64, Option<f64>)>,
    /// Log odds against all without it.
    pub log_odds: f64,
    /// Probability of these laws at this place.
    pub probability: f64,
    /// Probability of the place, whatever its laws.
    pub place_probability: f64,
    /// Other sets that were fitted in its stead, the most probable first.
    pub others: Vec<FittedLaws>,
    /// Laws that may be another value of a parameter: number of the law, parameter, probability.
    pub disguised: Vec<(usize, String, f64)>,
}

impl NamedCause {
    /// Standard error of a parameter of one of its laws; `None` where it was not fitted.
    #[must_use]
    pub fn std_error(&self, law: usize, parameter: usize) -> Option<f64> {
        let variance = self.covariances.get(law)?.get((parameter, parameter))?;
        (*variance > 0.0).then(|| variance.sqrt())
    }
}

/// Everything that explains records.
#[derive(Debug, Clone)]
pub struct Explanation {
    /// Causes in order of discovery.
    pub causes: Vec<NamedCause>,
    /// Parameters that may have moved beside those that are causes, by number, and their values.
    pub moved: Vec<(usize, f64)>,
    /// Probability that parameters have moved which are no causes, where errors allow for that by how probable it is.
    pub doubt: f64,
    /// Causes that samples which were not fitted speak against.
    pub withdrawn: Vec<NamedCause>,
    /// Probability that nothing is missing.
    pub nothing: f64,
    /// Where no cause is probable enough to be named: sets of laws that were fitted, the most probable first.
    pub suspected: Vec<FittedLaws>,
    /// The noise that is left.
    pub noise: Noise,
    /// Exact log likelihood of all innovations.
    pub log_likelihood: f64,
    /// Numbers that were fitted: of laws and noise.
    pub numbers: usize,
    /// ln of what all causes were chosen from, of how improbable the values of parameters are beforehand, and of how
    /// much narrower the data make them.
    pub choice: f64,
    /// Measured outputs, each sample of each counted.
    pub samples: usize,
    /// Whether the search ended with as many laws as were asked for.
    pub full: bool,
    /// log L - (numbers) / 2 ln(samples) less what the causes were chosen from, of the samples that they were
    /// chosen on.
    pub merit: f64,
    /// Most likely states at the first sample of every segment.
    pub starts: Vec<Vec<f64>>,
}

impl Explanation {
    /// log L - (numbers) / 2 ln(samples), less what the causes were chosen from.
    pub fn criterion(&self) -> f64 {
        let each = 0.5 * (self.samples as f64).ln();
        self.log_likelihood - each * self.numbers as f64 - self.choice
    }
}
