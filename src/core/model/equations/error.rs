//! Problems with their places.

use super::problem::Problem;
use crate::fault::{Explain, Kind, Place};
use crate::model::Fault;

/// A problem with its place in an expression.
#[derive(Debug, Clone, PartialEq)]
pub struct Located {
    /// First character concerned, from 0.
    pub at: usize,
    /// Characters concerned, at least 1.
    pub length: usize,
    /// What is wrong.
    pub problem: Problem,
}

impl Located {
    pub(super) fn new(at: usize, length: usize, problem: Problem) -> Self {
        Self { at, length: length.max(1), problem }
    }
}

/// Something wrong in `[model.equations]`.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("`{key}`{}: {problem}", character(*.at))]
pub struct EquationsError {
    /// Key path inside the model's table: `states[1].derivative`.
    pub key: String,
    /// First character concerned, from 0, where the fault is inside an expression, and
    /// how many are.
    pub at: Option<(usize, usize)>,
    /// What is wrong.
    pub problem: Problem,
}

fn character(at: Option<(usize, usize)>) -> String {
    at.map(|(at, _)| format!(", character {}", at + 1)).unwrap_or_default()
}

impl EquationsError {
    pub(super) fn new(key: impl Into<String>, problem: Problem) -> Self {
        Self { key: key.into(), at: None, problem }
    }

    pub(super) fn inside(key: &str, located: Located) -> Self {
        Self { key: key.into(), at: Some((located.at, located.length)), problem: located.problem }
    }
}

impl Explain for EquationsError {
    fn kind(&self) -> Kind {
        Kind::Input
    }

    fn place(&self) -> Place {
        Place { key: Some(self.key.clone()), ..Place::default() }
    }

    fn hint(&self) -> Option<String> {
        self.problem.hint()
    }
}

impl From<&EquationsError> for Fault {
    fn from(error: &EquationsError) -> Self {
        let found = format!("{}{}", error.problem, character(error.at));
        Fault::new(&error.key, found, error.problem.hint().unwrap_or_default())
    }
}
