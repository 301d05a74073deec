//! Searches by innovations that were made: whatever answer they are weighed against, one that begins with the same
//! causes ends where it ended.

use std::cell::RefCell;

use crate::likelihood::{Explanation, Given};
use crate::system::Placed;

/// Causes and parameters by name.
type Names = Vec<(String, String, Option<String>)>;

/// What was found, by the causes that a search began with; none of them: from nothing.
#[derive(Default)]
pub(super) struct Made(RefCell<Vec<(Names, Option<Explanation>)>>);

impl Made {
    /// What a search from given causes finds.
    pub fn begun_with(
        &self,
        given: &Given,
        search: impl FnOnce() -> Option<Explanation>,
    ) -> Option<Explanation> {
        let law =
            |law: &Placed| (law.effect.typetag_name().into(), law.into.clone(), law.of.clone());
        let moved = given.parameters.iter().map(|(p, _)| (String::new(), p.to_string(), None));
        let names: Names = given.laws.iter().map(law).chain(moved).collect();
        let is_made = |made: &&(Names, Option<Explanation>)| made.0 == names;
        let made = self.0.borrow().iter().find(is_made).map(|made| made.1.clone());
        made.unwrap_or_else(|| {
            let found = search();
            self.0.borrow_mut().push((names, found.clone()));
            found
        })
    }
}
