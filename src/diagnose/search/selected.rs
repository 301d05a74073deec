//! What a search found: the headline, its look-alikes, and how probable each of them is.

use std::sync::Arc;

use super::beam::{Beam, Fit, SetKey, name};
use super::contribution::tangents;
use super::dictionary::Item;
use super::study::Study;
use crate::candidates::candidate::Candidate;
use crate::candidates::screen::{Scored, Screen};
use crate::criteria::LOOK_ALIKE;
use crate::fit::found::{Belief, OtherLaws, SET, Slot};
use crate::fit::problem::{Added, Grain, Part, Problem};
use crate::statistics::{add_to_basis, dot, project, wald};

/// Candidates that are listed.
const LISTED: usize = 200;
/// Others that are said beside a set, and laws of its place that are drawn.
const OTHERS: usize = 4;
const DRAWN: usize = 4;

/// Whether a model has a cause of this name.
fn has(fit: &Fit, wanted: &Candidate) -> bool {
    fit.model.added.iter().any(|added| added.cause.same_cause(wanted))
}

/// Whether a model has a cause at the place of another.
fn has_place(fit: &Fit, wanted: &Candidate) -> bool {
    let here = |cause: &Candidate| cause.into == wanted.into && cause.of == wanted.of;
    fit.model.added.iter().any(|added| here(&added.cause))
}

/// The causes of a headline with what could stand in the place of each: laws of one place share it.
pub(super) fn slots(problem: &Problem<'_>, beam: &Beam, headline: &Fit) -> Vec<Slot> {
    let known = headline.model.known();
    let mut slots: Vec<Slot> =
        headline.model.added.iter().map(|added| Slot::of(&added.cause)).collect();
    for own in headline.model.places().into_iter().filter(|own| own[0] >= known) {
        let slot = slot(problem, beam, headline, &own);
        own.into_iter().for_each(|i| slots[i] = slot.clone());
    }
    slots
}

fn slot(problem: &Problem<'_>, beam: &Beam, headline: &Fit, own: &[usize]) -> Slot {
    let model = &headline.model;
    let laws: Vec<&Arc<Candidate>> = own.iter().map(|&i| &model.added[i].cause).collect();
    let is_own = |cause: &Candidate| laws.iter().any(|law| law.same_cause(cause));
    let bare = model.without_all(own);
    let rest = SetKey::new(headline.free, bare.added.iter().map(|a| name(&a.cause)));
    let without = beam.get(&rest);
    // what a member leaves, against what is left without any
    let squares = |fit: &Fit| dot(&fit.residual, &fit.residual);
    let base = without.map_or(f64::INFINITY, squares);
    let gain = |fit: &Fit| match base.is_finite() {
        true => (base - squares(fit)) / (base - squares(headline)).max(1e-300),
        false => 1.0,
    };
    let mut members: Vec<(f64, Arc<Candidate>, f64, &Fit)> = vec![];
    for fit in beam.fits().filter(|fit| fit.free == headline.free) {
        let is_rest = |cause: &Candidate| bare.added.iter().any(|a| a.cause.same_cause(cause));
        let causes = fit.model.added.iter().map(|added| &added.cause);
        let (stay, new): (Vec<_>, Vec<_>) = causes.partition(|cause| is_rest(cause));
        // in the place of one law or of all of them: one other, or several of one place
        let (still, other): (Vec<_>, Vec<_>) = new.into_iter().partition(|cause| is_own(cause));
        let one_place =
            other.iter().all(|cause| cause.same_cause(other[0]) || cause.same_place(other[0]));
        if stay.len() == bare.added.len() && still.len() < own.len() && one_place {
            let member = |c: &Arc<Candidate>| (fit.posterior(), c.clone(), gain(fit), fit);
            members.extend(other.into_iter().map(member));
        }
    }
    members.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut seen: Vec<Arc<Candidate>> = vec![];
    members.retain(|(_, cause, ..)| {
        let is_new = !seen.iter().any(|known| known.same_cause(cause));
        seen.push(cause.clone());
        is_new
    });
    let chance = |cause: &Candidate| beam.probability(|fit| has(fit, cause));
    let in_place = members.iter().filter(|(_, cause, ..)| cause.same_place(laws[0]));
    let in_place = in_place.map(|(_, cause, _, fit)| (cause, *fit));
    let other_laws = other_laws(laws[0], in_place, chance);
    let top = beam.best().map_or(0.0, Fit::posterior);
    let near = members.iter().filter(|m| (m.0 - top).exp() > LOOK_ALIKE).count();
    let mut others = members.split_off(near.min(SET - 1));
    others.truncate(OTHERS);
    let mut set = vec![(laws[0].clone(), 1.0)];
    set.extend(members.into_iter().map(|(_, cause, gain, _)| (cause, gain)));
    let others: Vec<_> = others.into_iter().map(|(_, cause, gain, _)| (cause, gain)).collect();
    let chances = |of: &[(Arc<Candidate>, f64)]| of.iter().map(|(c, _)| chance(c)).collect();
    let belief = Belief {
        law: beam.probability(|fit| laws.iter().all(|law| has(fit, law))),
        place: beam.probability(|fit| has_place(fit, laws[0])),
        odds: without.map(|without| headline.posterior() - without.posterior()),
        members: chances(&set),
        others: chances(&others),
    };
    let y = |fit: &Fit| problem.simulate(&fit.model, Grain::Coarse);
    let both = without.and_then(|without| y(without).zip(y(headline)));
    let score = both.map_or(0.0, |(a, b)| problem.better(&a, &b, Part::Choose));
    Slot { set, others, laws: other_laws, score, belief: Some(belief) }
}

/// The laws that fits have at the place of one, in the stead of those that were named.
fn other_laws<'a>(
    here: &Candidate,
    fits: impl Iterator<Item = (&'a Arc<Candidate>, &'a Fit)>,
    chance: impl Fn(&Candidate) -> f64,
) -> Vec<OtherLaws> {
    let mut found: Vec<OtherLaws> = vec![];
    for (cause, fit) in fits {
        let added = fit.model.added.iter().filter(|a| a.cause.same_place(here));
        let mut added: Vec<Added> = added.cloned().collect();
        // the one that is new here gives the sum its name
        added.sort_by_key(|a| !a.cause.same_cause(cause));
        let same = |known: &OtherLaws| {
            let has = |a: &Added| known.added.iter().any(|b| b.cause.same_cause(&a.cause));
            known.added.len() == added.len() && added.iter().all(has)
        };
        if added.iter().all(|a| a.cause.is_curve()) && !found.iter().any(same) {
            found.push(OtherLaws { added, probability: chance(cause) });
        }
        if found.len() == DRAWN {
            break;
        }
    }
    found
}

/// An item against what is left to explain.
struct FirstOrder<'a> {
    item: &'a Item,
    explained: f64,
    kappa: f64,
    unit_effect: f64,
    /// What it explains, sample by sample.
    fitted: Vec<f64>,
}

/// What the first column of an item explains by itself of what the model's numbers leave; none where
/// they imitate it, or its sign is another.
fn first_order<'a>(item: &'a Item, left: &[f64], basis: &[Vec<f64>]) -> Option<FirstOrder<'a>> {
    let mut own = item.columns[0].clone();
    let before = dot(&own, &own);
    project(basis, &mut own);
    let size = dot(&own, &own);
    let estimate = dot(&own, left) / size;
    let counts = size > 1e-6 * before && !(item.sign * estimate < 0.0);
    counts.then(|| {
        let fitted: Vec<f64> = own.iter().map(|v| estimate * v).collect();
        let explained = dot(&fitted, left);
        let (kappa, unit_effect) = ((size / before).sqrt(), size.sqrt());
        FirstOrder { item, explained, kappa, unit_effect, fitted }
    })
}

/// The ranking of the dictionary against the model without causes.
pub(super) fn screened(study: &Study<'_, '_>, first: &Fit) -> Option<Screen> {
    let nuisance = study.nuisance(first.free);
    let mut basis = vec![];
    for (_, column) in tangents(study.problem, nuisance, &first.model, &first.residual) {
        add_to_basis(&mut basis, column);
    }
    (!study.items.is_empty()).then(|| ranking(study.problem, &study.items, &first.residual, &basis))
}

/// The ranking of candidates before any fit, each by the grid point of it that explains most.
fn ranking(problem: &Problem<'_>, items: &[Item], residual: &[f64], basis: &[Vec<f64>]) -> Screen {
    let mut left = residual.to_vec();
    project(basis, &mut left);
    let mut best: Vec<(f64, &Item)> = vec![];
    let mut at: std::collections::BTreeMap<usize, usize> = Default::default();
    for item in items {
        let Some(FirstOrder { explained, .. }) = first_order(item, &left, basis) else { continue };
        match at.get(&item.candidate) {
            Some(&known) if best[known].0 >= explained => {}
            Some(&known) => best[known] = (explained, item),
            None => {
                at.insert(item.candidate, best.len());
                best.push((explained, item));
            }
        }
    }
    best.sort_by(|a, b| b.0.total_cmp(&a.0));
    best.truncate(LISTED);
    // only of these it is asked how sure that is
    let leading = best.iter().filter_map(|(_, item)| first_order(item, &left, basis));
    let scored = leading.map(|FirstOrder { item, explained, kappa, unit_effect, fitted }| Scored {
        cause: item.cause.clone(),
        explained,
        score: wald(&problem.per_sample(&fitted, &fitted), &problem.per_sample(&fitted, &left)),
        kappa,
        unit_effect,
    });
    let scored = scored.collect();
    let (total, columns) = (dot(&left, &left), items.len());
    Screen { scored, total, columns }
}
