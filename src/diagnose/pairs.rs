//! Two causes at once, where the best one alone only stood in for them.

use std::sync::Arc;

use super::candidate::Candidate;
use super::problem::{Model, Part};
use super::screen::Screen;
use super::search::Search;
use super::stage::{Trial, stage};

/// Relative change of a first cause's size beyond which it is not believed.
const STAYED: f64 = 0.25;
/// First causes that are expanded when one is not enough.
const BEAM: usize = 5;
/// Candidates of each screen that may be the second of a pair.
const LEADING: usize = 60;

impl Search<'_, '_> {
    /// Expands other first causes too; all pairs with the first cause of the best one, best
    /// first, if it beats one cause alone. Where the residual does not visibly depend on the
    /// inputs, it has to be as good as two strong causes.
    pub(super) fn pairs(
        &mut self,
        model: &Model,
        before: &Arc<Vec<Vec<f64>>>,
        previous: &[Trial],
        trials: &[Trial],
        candidates: &[Arc<Candidate>],
        visible: bool,
    ) -> Option<Vec<Trial>> {
        let first = model.added.get(model.known()).map(|a| a.cause.clone());
        let is_first = |cause: &Candidate| first.as_ref().is_some_and(|f| cause.same_cause(f));
        let base = self.problem.mean_square(before, Part::Choose);
        let sibling = |t: &Trial| {
            first.as_ref().is_some_and(|f| t.cause.into == f.into && t.cause.of == f.of)
        };
        let mut others: Vec<&Trial> = previous.iter().filter(|t| !is_first(&t.cause)).collect();
        others.sort_by(|a, b| sibling(b).cmp(&sibling(a)).then(a.held.total_cmp(&b.held)));
        let mut taken: Vec<Arc<Vec<Vec<f64>>>> = vec![before.clone()];
        let mut pool = if first.is_some() { trials.to_vec() } else { vec![] };
        let mut expanded = 0;
        for other in others {
            if expanded >= BEAM || self.watch.stopped() {
                break;
            }
            let near = |y: &Arc<Vec<Vec<f64>>>| {
                let left = |y: &[Vec<f64>]| self.problem.residual(y, Part::Choose);
                let (a, b) = (left(&other.y), left(y));
                let off: f64 =
                    a.iter().zip(&b).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / a.len() as f64;
                off < 0.01 * other.held.min(base)
            };
            if taken.iter().any(near) {
                continue;
            }
            taken.push(other.y.clone());
            expanded += 1;
            if let Some(found) =
                stage(self.problem, &self.nuisance, &other.model, candidates, false, 6)
            {
                pool.extend(found.trials);
            }
        }
        pool.sort_by(|a, b| a.held.total_cmp(&b.held));
        let best = pool.first()?;
        let new_first = best.model.added.get(best.model.known())?.cause.clone();
        let worth = match visible {
            true => self.accepts(before, &best.y, best.weak),
            false => self.is_doubly_strong(before, &best.y),
        };
        if !worth || is_first(&new_first) {
            return None;
        }
        let before_last = best.model.added.len() - 1;
        let firsts = best.model.added[..before_last].to_vec();
        let same_firsts = |t: &Trial| {
            t.model.added.len() == before_last + 1
                && t.model.added.iter().zip(&firsts).all(|(a, b)| a.cause.same_cause(&b.cause))
        };
        Some(pool.iter().filter(|t| same_firsts(t)).cloned().collect())
    }
}

/// Whether the first cause kept its size when a second one joined it: one that only stood in
/// for two others does not.
pub(super) fn stayed(alone: &Model, joined: &Model, first: usize) -> bool {
    let (Some(a), Some(b)) = (alone.added.get(first), joined.added.get(first)) else { return true };
    a.cause.linear.iter().all(|&i| (a.knobs[i] - b.knobs[i]).abs() < STAYED * a.knobs[i].abs())
}

/// The candidates that lead one of the screens: what is far behind alone and beside the first
/// cause is not the second one of another pair.
pub(super) fn shortlist(
    candidates: &[Arc<Candidate>],
    screens: [&Option<Screen>; 2],
) -> Vec<Arc<Candidate>> {
    let leads = |cause: &Candidate| {
        let mut leading = screens.into_iter().flatten().flat_map(|s| s.scored.iter().take(LEADING));
        leading.any(|s| s.cause.same_cause(cause))
    };
    candidates.iter().filter(|cause| leads(cause)).cloned().collect()
}
