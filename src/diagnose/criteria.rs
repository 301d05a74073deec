//! Every decision threshold of the search, in natural logarithms of odds unless said otherwise.
//!
//! A model is judged by one number, ln p(data | model) + ln p(model) (`evidence`); the first six
//! entries are the prior p(model), the next two say how a posterior is read, the last four only save
//! work: a larger value never names anything else but slower. What samples that were not fitted refute,
//! `likelihood::refutes` says for a search by free runs and by innovations alike.

/// What one more cause takes beyond the choice among all names: a cause has ln odds of
/// -(this + ln(number of names)).
pub(crate) const MORE: f64 = 1.0;
/// What each number of a law beyond its first takes: of two laws the one with more numbers is less
/// probable by itself.
pub(crate) const PER_NUMBER: f64 = 1.5;
/// What letting all parameters move takes.
pub(crate) const ALL_PARAMETERS: f64 = 5.0;
/// Range of sizes that a coefficient may have, as a natural logarithm; its prior is flat in it.
pub(crate) const SIZES: f64 = 9.0;
/// What a law without a name takes beyond its numbers: any of the library is more probable.
pub(crate) const UNNAMED: f64 = 10.0;
/// What the free run of a model may leave, mean square, in units of what the one without causes leaves.
/// That is error and noise, so noise alone is less: the prior of its variance ends there, whatever likelihood
/// a larger one would have (a disturbance with a pole near 1 forgives any drift); a tenth is left to chance.
pub(crate) const LEAVES: f64 = 1.1;

/// How much less probable than the best a plainer law or set may be and still be the headline.
pub(crate) const AS_GOOD: f64 = 1.5;
/// Odds against the best above which a look-alike is said.
pub(crate) const LOOK_ALIKE: f64 = 0.02;

/// How far below the best a first-order prediction may be to be fitted.
pub(crate) const PREDICTED: f64 = 6.0;
/// The same where it would stand in the place of one cause, and where it has the channel of that.
pub(crate) const NEIGHBOUR: f64 = 15.0;
pub(crate) const NEAR_NEIGHBOUR: f64 = 80.0;
/// How far below the best a fit may be after two iterations to go on.
pub(crate) const RACE: f64 = 40.0;
