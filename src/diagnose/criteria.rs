//! Every decision threshold of the search, in natural logarithms of odds unless said otherwise.
//!
//! A model is judged by one number, ln p(data | model) + ln p(model) (`evidence`); the first five
//! entries are the prior p(model), the next three say how a posterior is read, the last four only save
//! work: a larger value never names anything else but slower.

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

/// How much less probable than the best a plainer law or set may be and still be the headline.
pub(crate) const AS_GOOD: f64 = 1.5;
/// Odds against the best above which a look-alike is said.
pub(crate) const LOOK_ALIKE: f64 = 0.02;
/// Odds, as a natural logarithm, by which samples that were not fitted must speak against a cause
/// for it to be withdrawn, or those that the fitted ones gave it where they are less: 20 to 1 (Kass and
/// Raftery, JASA 90, 1995: strong). Samples that a cause does not reach say next to nothing.
pub(crate) const REFUTED: f64 = 3.0;

/// How far below the best a first-order prediction may be to be fitted.
pub(crate) const PREDICTED: f64 = 6.0;
/// The same where it would stand in the place of one cause, and where it has the channel of that.
pub(crate) const NEIGHBOUR: f64 = 15.0;
pub(crate) const NEAR_NEIGHBOUR: f64 = 80.0;
/// How far below the best a fit may be after two iterations to go on.
pub(crate) const RACE: f64 = 40.0;
