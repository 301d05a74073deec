//! Causes that are compromises: two others take the place of one, or of two.

use super::found::Slot;
use super::problem::Model;
use super::search::Search;
use super::sets::RULED_OUT;
use super::stage::Trial;

/// Places that are looked at, those of the causes of which the record says least.
const PLACES: usize = 6;

impl Search<'_, '_> {
    /// Puts two causes in the place of one, of two, or of none, where that is more probable by far.
    /// Where nothing but noise is left, two in the place of two only. `visible`: the first residual
    /// depends on the inputs, so that two may be looked for where there is none. Whether it did.
    pub(super) fn rejoin(
        &mut self,
        model: &mut Model,
        slots: &mut Vec<Slot>,
        visible: bool,
    ) -> bool {
        let Some(now) = self.present(model) else { return false };
        let (known, count) = (model.known(), model.added.len());
        let mut places = self.places(model, slots, visible);
        if self.is_noise(&now) {
            places.retain(|place| place.len() == 2);
        }
        let mut best: Option<(f64, Vec<usize>, Trial)> = None;
        for out in places {
            if self.watch.stopped() {
                return false;
            }
            // as in a swap, the others stay what they are
            let mut rest = model.clone();
            for &i in out.iter().rev() {
                rest = rest.without(i);
            }
            let candidates = self.candidates(&self.fitted(rest.clone()));
            for trial in self.joint(&rest, &candidates) {
                let gained = self.gained((model, &now), (&trial.model, &trial.y));
                let is_better =
                    gained > RULED_OUT && count > known || self.accepts(&now, &trial.y, false);
                let is_best = best.as_ref().is_none_or(|(most, ..)| gained > *most);
                if is_better && is_best && self.score(&now, &trial.y) > 1.0 {
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
        self.swap(model, slots);
        self.prune(model, slots, 0);
        // what is left when some of it turned out not to be needed
        let is_better = self.present(model).is_some_and(|y| {
            self.gained((&before, &now), (model, &y)) > 0.0 || self.accepts(&now, &y, false)
        });
        if is_better {
            self.stand_on(model);
        } else {
            (*model, *slots) = (before, its_slots);
        }
        is_better
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
