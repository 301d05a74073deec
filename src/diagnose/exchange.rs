//! Two causes in one path that cannot be told from the same two in each other's place: a delay
//! before and a lag behind a slow plant, or the lag before and the delay behind.

use std::sync::Arc;

use super::candidate::{Candidate, Wire};
use super::found::Slot;
use super::problem::{Added, Model};
use super::search::Search;
use super::sets::{RULED_OUT, SET};

impl Search<'_, '_> {
    /// Asks of every two causes in paths whether they may have changed places, which shows in
    /// neither of them alone: the better way is kept, and one that is as good is named beside it.
    pub(super) fn exchange(&self, model: &mut Model, slots: &mut [Slot]) {
        for i in model.known()..model.added.len() {
            for j in i + 1..model.added.len() {
                if self.watch.stopped() {
                    return;
                }
                let Some(other) = self.exchanged(model, i, j) else { continue };
                let both = self.present(model).zip(self.present(&other));
                let Some((y, y_other)) = both else { continue };
                let gained = self.problem.odds(&y, &y_other, self.is_white(&y_other));
                if gained < -RULED_OUT {
                    continue;
                }
                let kept = if gained > RULED_OUT { &other } else { &*model };
                let named = if gained > RULED_OUT { &*model } else { &other };
                for at in [i, j] {
                    let (kept, beside) = (&kept.added[at].cause, &named.added[at].cause);
                    let set = &mut slots[at].set;
                    set.retain(|(c, _)| !c.same_cause(kept) && !c.same_cause(beside));
                    set.insert(0, (kept.clone(), 1.0));
                    if gained > RULED_OUT {
                        // the others could not be told from a cause that is not there any more
                        set.truncate(1);
                    } else {
                        set.insert(1, (beside.clone(), 1.0));
                        set.truncate(SET);
                    }
                }
                if gained > RULED_OUT {
                    *model = other;
                }
            }
        }
    }

    /// The model with two causes in each other's place, fitted; `None` where they cannot be there.
    fn exchanged(&self, model: &Model, i: usize, j: usize) -> Option<Model> {
        let (a, b) = (&model.added[i], &model.added[j]);
        let in_paths = matches!((&a.cause.wire, &b.cause.wire), (Wire::Path, Wire::Path));
        if !in_paths || a.cause.effect == b.cause.effect || a.cause.into == b.cause.into {
            return None;
        }
        let mut bare = model.clone();
        bare.added.retain(|added| added.cause.is_known_limit());
        let library = self.candidates(&bare);
        let there = |of: &Added, place: &Candidate| -> Option<Added> {
            let found = library.iter().find(|c| {
                (c.effect, &c.into, &c.of) == (of.cause.effect, &place.into, &place.of)
            })?;
            Some(Added { cause: Arc::clone(found), knobs: of.knobs.clone() })
        };
        let (first, second) = (there(a, &b.cause)?, there(b, &a.cause)?);
        let mut other = model.clone();
        (other.added[i], other.added[j]) = (first, second);
        Some(self.fitted(other))
    }
}
