//! What findings are told from: a search's problem, its records, and the data that score.

use crate::candidates::library::Allowed;
use crate::data::Record;
use crate::fit::problem::{Model, Problem};
use crate::prepare::joined_records::Joined;
use crate::prepare::operating_range::Nominal;
use crate::system::System;
use crate::validate::test_error::TestData;
use crate::watch::Watch;

/// What is reported from.
pub(crate) struct Context<'a, 'b> {
    pub system: &'a System,
    pub problem: &'a Problem<'b>,
    pub nominal: &'a Nominal,
    pub joined: &'a Joined,
    /// What may be named.
    pub allowed: &'a Allowed,
}

/// Where findings are from: the records that were used, and those that score.
pub(crate) struct Source<'a> {
    pub start: &'a Model,
    pub test: &'a TestData,
    pub used: &'a [Record],
    /// Rows of the first samples of joined records.
    pub firsts: &'a [usize],
    /// Says whether somebody asks to stop.
    pub watch: &'a dyn Watch,
}
