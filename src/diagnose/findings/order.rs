//! Which cause comes first: the one that explains most.
//!
//! A free run's answer explains the error of a free run: the share of it that comes back without a cause, by whole
//! per cents, then its log odds. A predictor's answer explains what a predictor does not foresee, which log
//! odds measure, ln p(data, model) less that without the cause (Kass and Raftery, JASA 90, 1995): the free run
//! of a plant that is disturbed inside drifts by whatever else is a little wrong.

use std::cmp::Ordering;

use crate::findings::cause::Cause;
use crate::fit::finished::Finished;
use crate::fit::found::Slot;

/// Orders the causes that begin with the laws of a model's places; the parameters that moved stay behind.
pub(crate) fn most_first(causes: &mut [Cause], chosen: &Finished) {
    let places = chosen.fitted.model.places();
    ordered(causes, &places, &chosen.found.slots, chosen.is_by_innovations());
}

/// What was read off the record comes first, what was not compared last.
fn ordered(causes: &mut [Cause], places: &[Vec<usize>], slots: &[Slot], by_odds: bool) {
    let odds = |at: usize| match &slots[places[at][0]].belief {
        None => f64::INFINITY,
        Some(belief) => belief.odds.unwrap_or(f64::NEG_INFINITY),
    };
    let share = |at: usize| match odds(at) == f64::INFINITY {
        true => f64::INFINITY,
        false => (100.0 * causes[at].error_removed).round(),
    };
    let compared = |&a: &usize, &b: &usize| {
        let first = if by_odds { Ordering::Equal } else { share(b).total_cmp(&share(a)) };
        first.then(odds(b).total_cmp(&odds(a)))
    };
    let mut order: Vec<usize> = (0..places.len().min(causes.len())).collect();
    order.sort_by(compared);
    let sorted: Vec<Cause> = order.iter().map(|&i| std::mem::take(&mut causes[i])).collect();
    for (cause, own) in causes.iter_mut().zip(sorted) {
        *cause = own;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::found::Belief;
    use crate::search::fixture::candidate;
    use std::sync::Arc;

    #[test]
    fn what_explains_most_comes_first() {
        let slot = |odds: Option<Option<f64>>| {
            let belief = odds.map(|odds| Belief {
                law: 1.0,
                place: 1.0,
                odds,
                members: vec![],
                others: vec![],
            });
            Slot { belief, ..Slot::of(&Arc::new(candidate("a"))) }
        };
        // two laws of one place share its slot; a limit that was read off; one without a rival
        let odds = [Some(Some(3.0)), Some(Some(40.0)), Some(Some(40.0)), Some(None), None];
        let slots: Vec<Slot> = odds.map(slot).into();
        let places = [vec![0], vec![1, 2], vec![3], vec![4]];
        let shares =
            [("wide", 0.8), ("sure", 0.001), ("unknown", 0.002), ("limit", 0.0), ("moved", 0.9)];
        let order = |by_odds: bool| -> Vec<String> {
            let cause = |(into, error_removed): (&str, f64)| Cause {
                into: into.into(),
                error_removed,
                ..Cause::default()
            };
            let mut causes: Vec<Cause> = shares.map(cause).into();
            ordered(&mut causes, &places, &slots, by_odds);
            causes.into_iter().map(|cause| cause.into).collect()
        };
        assert_eq!(order(true), ["limit", "sure", "wide", "unknown", "moved"]);
        assert_eq!(order(false), ["limit", "wide", "sure", "unknown", "moved"]);
    }
}
