//! What findings are told from: a search's problem, its records, and the data that score.

use super::nominal::Nominal;
use super::problem::{Model, Problem};
use super::records::Joined;
use super::score::TestData;
use crate::data::Record;
use crate::system::System;

/// What is reported from.
pub(crate) struct Teller<'a, 'b> {
    pub system: &'a System,
    pub problem: &'a Problem<'b>,
    pub nominal: &'a Nominal,
    pub joined: &'a Joined,
}

/// Where findings are from: the records that were used, and those that score.
pub(crate) struct Source<'a> {
    pub start: &'a Model,
    pub test: &'a TestData,
    pub used: &'a [Record],
    /// Rows of the first samples of joined records.
    pub firsts: &'a [usize],
    /// Parameters that the call holds.
    pub fixed: &'a [String],
}
