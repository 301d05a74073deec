//! Causes that are compromises: two others take the place of one, or of two.

use super::candidate::Preference;
use super::found::{Begun, Slot, named};
use super::problem::Model;
use super::search::Search;
use super::sets::RULED_OUT;
use super::split::MANY;
use super::stage::Trial;

/// Places that are looked at, those of the causes of which the record says least.
const PLACES: usize = 6;
/// Difference of two gains below which the plainer pair is taken.
const TIE: f64 = 0.01;

impl Search<'_, '_> {
    /// Puts two causes in the place of one, of two, or of none, where that is more probable by far.
    /// Where nothing but noise is left, one that stands alone has to be a rich one. `visible`: the
    /// first residual depends on the inputs, so that two may be looked for where there is none.
    /// Whether it did.
    pub(super) fn rejoin(
        &mut self,
        model: &mut Model,
        slots: &mut Vec<Slot>,
        visible: bool,
    ) -> bool {
        let Some(now) = self.present(model) else { return false };
        let (known, count) = (model.known(), model.added.len());
        let mut places = self.places(model, slots, visible);
        let in_noise = self.is_noise(&now);
        if in_noise {
            let is_rich = |i: usize| model.added[i].cause.unknowns() >= MANY;
            places.retain(|place| place.first().is_some_and(|&i| count > known + 1 || is_rich(i)));
        }
        let mut best: Option<(f64, Vec<usize>, Trial)> = None;
        for out in places {
            if self.watch.stopped() {
                return false;
            }
            let mut candidates = self.candidates(&self.fitted(model.without_all(&out)));
            if let (true, [i]) = (in_noise && count == known + 1, &out[..]) {
                candidates.retain(|c| c.unknowns() < model.added[*i].cause.unknowns());
            }
            for trial in self.joint(model, &out, &candidates) {
                let gained = self.gained((model, &now), (&trial.model, &trial.y));
                let is_better = gained > RULED_OUT && count > known
                    || gained > 0.0 && self.accepts(&now, &trial.y, false);
                let is_best = best.as_ref().is_none_or(|(most, _, best)| {
                    let plainer = order(&trial.model) < order(&best.model);
                    gained > *most + TIE || gained > *most - TIE && plainer
                });
                // plainer ones need not be better over blocks, only not worse
                let bar = if trial.model.cost() < model.cost() { -1.0 } else { 1.0 };
                if is_better && is_best && self.score(&now, &trial.y) > bar {
                    best = Some((gained, out.clone(), trial));
                }
            }
        }
        let Some((_, out, trial)) = best else { return false };
        let (before, its_slots) = (model.clone(), slots.clone());
        for &i in out.iter().rev() {
            slots.remove(i);
        }
        *model = trial.model;
        slots.extend(model.added[slots.len()..].iter().map(|added| Slot::of(&added.cause)));
        self.prune(model, slots, 0);
        self.swap(model, slots, 0);
        self.prune(model, slots, 0);
        // what is left when some of it turned out not to be needed
        let after = self.present(model);
        let is_better = after.is_some_and(|y| self.gained((&before, &now), (model, &y)) > 0.0);
        if is_better {
            self.stand_on(model);
        } else {
            (*model, *slots) = (before, its_slots);
        }
        is_better
    }

    /// Two causes that have names and are more probable than a curve or a learned law that was
    /// `drawn` where `bare` names nothing, as one cause at a time is worth nothing there.
    pub(super) fn named_instead(
        &mut self,
        drawn: &Model,
        (mut bare, mut slots): (Model, Vec<Slot>),
    ) -> Option<Vec<Begun>> {
        let is_drawn = drawn.added.iter().any(|added| added.cause.is_drawn());
        let open = is_drawn && bare.added.len() == bare.known();
        if !open || !self.rejoin(&mut bare, &mut slots, true) {
            return None;
        }
        let is_better = self.is_gained(drawn, &bare);
        if !is_better {
            self.stand_on(drawn);
        }
        is_better.then(|| named(&bare, &slots))
    }

    /// Every two causes; where there may be more, every one and the place beside them all.
    fn places(&self, model: &Model, slots: &[Slot], visible: bool) -> Vec<Vec<usize>> {
        let (known, count) = (model.known(), model.added.len());
        let mut places: Vec<Vec<usize>> = vec![];
        if (visible || count > known) && count - known + 1 < self.most {
            places.push(vec![]);
        }
        for i in known..count {
            if count - known < self.most {
                places.push(vec![i]);
            }
            places.extend((i + 1..count).map(|j| vec![i, j]));
        }
        let said = |place: &Vec<usize>| place.iter().map(|&i| slots[i].score).sum::<f64>();
        places.sort_by(|a, b| said(a).total_cmp(&said(b)));
        places.truncate(PLACES);
        places
    }
}

/// How pairs that explain alike are ordered: the least comes first.
fn order(model: &Model) -> Vec<(Preference, usize, u8, Preference)> {
    let mut both: Vec<_> = model.added.iter().rev().take(2).map(|a| a.cause.order()).collect();
    both.sort();
    both
}
