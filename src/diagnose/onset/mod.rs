//! Causes that begin within a record: detection of an abrupt change and of its moment.
//!
//! ```text
//! rise      when what the model leaves grows: generalised likelihood ratio of two levels
//! since     what a search names in the samples from then on, against what one names in all of them
//! moment    when it begins: profile likelihood over the sample at which the extended model takes over
//! ```
//!
//! Sources: Willsky and Jones, IEEE Trans. Automatic Control 21, 1976; Basseville and Nikiforov, "Detection
//! of Abrupt Changes", 1993, sections 2.4 and 7.2.

mod moment;
mod rise;
mod since;
