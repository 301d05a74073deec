//! What a search found: the headline, its look-alikes, and how probable each of them is.

use std::sync::Arc;

use super::beam::{Beam, Fit, SetKey, name};
use super::dictionary::Item;
use crate::candidate::Candidate;
use crate::criteria::LOOK_ALIKE;
use crate::found::{Belief, Slot};
use crate::problem::{Grain, Part, Problem};
use crate::screen::{Scored, Screen};
use crate::sets::SET;
use crate::statistics::{dot, project, wald};

/// Candidates that are listed.
const LISTED: usize = 200;
/// Others that are said beside a set.
const OTHERS: usize = 4;

/// Whether a model has a cause of this name.
fn has(fit: &Fit, wanted: &Candidate) -> bool {
    fit.model.added.iter().any(|added| added.cause.same_cause(wanted))
}

/// Whether a model has a cause at the place of another.
fn has_place(fit: &Fit, wanted: &Candidate) -> bool {
    fit.model.added.iter().any(|a| a.cause.into == wanted.into && a.cause.of == wanted.of)
}

/// The causes of a headline with what could stand in the place of each.
pub(super) fn slots(problem: &Problem<'_>, beam: &Beam, headline: &Fit) -> Vec<Slot> {
    let known = headline.model.known();
    let limits = headline.model.added[..known].iter().map(|added| Slot::of(&added.cause));
    let causes = (known..headline.model.added.len()).map(|i| slot(problem, beam, headline, i));
    limits.chain(causes).collect()
}

fn slot(problem: &Problem<'_>, beam: &Beam, headline: &Fit, index: usize) -> Slot {
    let own = &headline.model.added[index].cause;
    let bare = headline.model.without(index);
    let rest = SetKey::new(headline.free, bare.added.iter().map(|a| name(&a.cause)));
    let without = beam.get(&rest);
    // what a member leaves, against what is left without any
    let squares = |fit: &Fit| dot(&fit.residual, &fit.residual);
    let base = without.map_or(f64::INFINITY, squares);
    let gain = |fit: &Fit| match base.is_finite() {
        true => (base - squares(fit)) / (base - squares(headline)).max(1e-300),
        false => 1.0,
    };
    let mut members: Vec<(f64, Arc<Candidate>, f64)> = vec![];
    for fit in beam.fits().filter(|fit| fit.free == headline.free) {
        let new = fit.model.added.iter().find(|added| {
            let others = fit.model.added.iter().filter(|a| !std::ptr::eq(*a, *added));
            SetKey::new(fit.free, others.map(|a| name(&a.cause))) == rest
        });
        let Some(new) = new.filter(|new| !new.cause.same_cause(own)) else { continue };
        members.push((fit.posterior(), new.cause.clone(), gain(fit)));
    }
    members.sort_by(|a, b| b.0.total_cmp(&a.0));
    let top = beam.best().map_or(0.0, Fit::posterior);
    let near = members.iter().filter(|m| (m.0 - top).exp() > LOOK_ALIKE).count();
    let others = members.split_off(near.min(SET - 1));
    let mut set = vec![(own.clone(), 1.0)];
    set.extend(members.into_iter().map(|(_, cause, gain)| (cause, gain)));
    let chances = set.iter().map(|(c, _)| beam.probability(|fit| has(fit, c))).collect();
    let belief = Belief {
        law: beam.probability(|fit| has(fit, own)),
        place: beam.probability(|fit| has_place(fit, own)),
        members: chances,
    };
    let y = |fit: &Fit| problem.simulate(&fit.model, Grain::Coarse);
    let both = without.and_then(|without| y(without).zip(y(headline)));
    let score = both.map_or(0.0, |(a, b)| problem.better(&a, &b, Part::Choose));
    let others = others.into_iter().take(OTHERS).map(|(_, cause, gain)| (cause, gain)).collect();
    Slot { set, others, score, belief: Some(belief) }
}

/// The ranking of candidates before any fit.
pub(super) fn ranking(
    problem: &Problem<'_>,
    items: &[Item],
    residual: &[f64],
    basis: Vec<Vec<f64>>,
) -> Screen {
    let mut left = residual.to_vec();
    project(&basis, &mut left);
    let mut scored: Vec<Scored> = vec![];
    let mut at: std::collections::BTreeMap<usize, usize> = Default::default();
    for item in items {
        let mut own = item.columns[0].clone();
        let before = dot(&own, &own);
        project(&basis, &mut own);
        let size = dot(&own, &own);
        if !(size > 1e-6 * before) {
            continue;
        }
        let estimate = dot(&own, &left) / size;
        if item.sign * estimate < 0.0 {
            continue;
        }
        let fitted: Vec<f64> = own.iter().map(|v| estimate * v).collect();
        let new = Scored {
            cause: item.cause.clone(),
            explained: dot(&fitted, &left),
            estimate: vec![estimate],
            start: item.start,
            score: wald(&problem.per_sample(&fitted, &fitted), &problem.per_sample(&fitted, &left)),
            kappa: (size / before).sqrt(),
            unit_effect: size.sqrt(),
            probe: item.probe,
        };
        match at.get(&item.candidate) {
            Some(&known) if scored[known].explained >= new.explained => {}
            Some(&known) => scored[known] = new,
            None => {
                at.insert(item.candidate, scored.len());
                scored.push(new);
            }
        }
    }
    scored.sort_by(|a, b| b.explained.total_cmp(&a.explained));
    scored.truncate(LISTED);
    let (total, columns) = (dot(&left, &left), items.len());
    Screen { scored, total, far: 0.0, columns, basis, left, tangents: vec![] }
}
