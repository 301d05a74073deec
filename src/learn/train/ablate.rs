//! What every part of a fitted model is worth: the error without it over the error with it.

use serde::Serialize;

use super::fit::Fit;
use super::groups::{Group, GroupKind, groups};
use super::innovations::{judged, judged_at};
use super::shooting::{Arithmetic, Shooting};
use super::validate::{Scorer, Validation};
use super::{Augmented, TrainError};
use crate::data::Record;
use crate::lfr::Source;

/// A part whose absence leaves the error within this share of what it was is not needed: one
/// standard error of a root mean square over some five thousand independent samples.
const NOT_NEEDED: f64 = 1.01;

/// One part switched off.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Ablation {
    /// What it is.
    pub kind: GroupKind,
    /// Name of the signal.
    pub name: String,
    /// Error on the validation records without it, over that with it.
    pub ratio: f64,
    /// Whether it has been taken out.
    pub removed: bool,
}

impl std::fmt::Display for Ablation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { name, ratio, .. } = self;
        let what = match self.kind {
            GroupKind::State => format!("The added state `{name}`"),
            GroupKind::Input => format!("`{name}` as what the learned part sees"),
            GroupKind::Output => format!("What the learned part adds to `{name}`"),
        };
        match (self.removed, ratio.is_finite()) {
            (true, _) => write!(f, "{what} is not needed and was taken out"),
            (_, false) => write!(f, "{what} is needed: without it the simulation diverges"),
            (_, true) => write!(f, "{what}: without it the error is {ratio:.2} times as large"),
        }
    }
}

/// Switches every signal of the learned part off in turn: an input is held at its mean over the
/// training records, an output and an added state are 0 (Breiman, Machine Learning 45, 2001, sec.
/// 10, with the part removed instead of shuffled). With `prune`, what is not needed is taken out
/// of the model for good, the least needed first, each judged without those before it (backward
/// elimination).
///
/// # Errors
///
/// If the records do not fit the model.
pub fn ablate(fit: &mut Fit, records: &[Record], prune: bool) -> Result<Vec<Ablation>, TrainError> {
    let settings = Validation { lengths: vec![1], ..Validation::default() };
    let ones = vec![1.0; fit.model.model.outputs];
    let by = By { settings: &settings, length: 1, deviations: &ones, innovations: 0.0, settle: 0 };
    ablate_by(fit, records, prune, &by)
}

/// What decides whether a part is needed.
pub(super) struct By<'a> {
    pub settings: &'a Validation,
    /// Samples in a section.
    pub length: usize,
    /// What each output's error is counted in.
    pub deviations: &'a [f64],
    /// Weight of the likelihood of innovations beside the simulation.
    pub innovations: f64,
    /// Samples in which a simulation settles.
    pub settle: usize,
}

/// The same where predictions may count beside the simulation: a part is then needed that either of
/// them needs, by the number that training chose its model by.
pub(super) fn ablate_by(
    fit: &mut Fit,
    records: &[Record],
    prune: bool,
    by: &By<'_>,
) -> Result<Vec<Ablation>, TrainError> {
    let model = fit.model.clone();
    let all = groups(&model.model, model.signals().as_ref());
    let shooting = Shooting { length: by.length, threads: 1, arithmetic: Arithmetic::Double };
    let mut scorer = Scorer::new(&model, records, by.settings, shooting)?.settling(by.settle);
    let mut score = |parameters: &[f64]| scorer.score(parameters);
    let mut present = model.parameters();
    let mut whole = score(&present)?;
    let mut found: Vec<Ablation> = vec![];
    for group in &all {
        let ratio =
            score(&without(&present, group))?.whole(by.deviations) / whole.whole(by.deviations);
        found.push(Ablation { kind: group.kind, name: group.name.clone(), ratio, removed: false });
    }
    loop {
        if !prune {
            return Ok(found);
        }
        let mut least: Option<(usize, f64)> = None;
        let most = judged_at(&whole, by.deviations, by.innovations, NOT_NEEDED);
        for (i, group) in all.iter().enumerate().filter(|(i, _)| !found[*i].removed) {
            let there = group.entries.iter().any(|&entry| present[entry] != 0.0);
            let other = judged(&score(&without(&present, group))?, by.deviations, by.innovations);
            if there && other <= most && least.is_none_or(|(_, best)| other < best) {
                least = Some((i, other));
            }
        }
        let Some((i, _)) = least else { break };
        found[i].removed = true;
        present = without(&present, &all[i]);
        whole = score(&present)?;
    }
    fit.model.set_parameters(&present)?;
    Ok(found)
}

/// Parameters with a group of them switched off.
pub(super) fn without(parameters: &[f64], group: &Group) -> Vec<f64> {
    let mut changed = parameters.to_vec();
    group.entries.iter().for_each(|&entry| changed[entry] = 0.0);
    changed
}

/// What the course of a training gives reason to say: the best model is the start, or errors a
/// few samples ahead fall while those of the simulation rise.
pub fn warnings(fit: &Fit) -> Vec<String> {
    let mut said = vec![];
    if fit.epoch == 0 && fit.history.len() > 1 {
        said.push(
            "the best model is the one before training: no epoch was better on the validation \
             records; lower the rate, lengthen the sections or check the records"
                .to_string(),
        );
    }
    let mean = |errors: &[f64]| {
        (errors.iter().map(|e| e * e).sum::<f64>() / errors.len().max(1) as f64).sqrt()
    };
    let scored = fit.history.iter().filter_map(|epoch| {
        let score = epoch.score.as_ref()?;
        let ahead = score.ahead.first().map(|ahead| mean(ahead))?;
        (!score.simulation.is_empty()).then(|| (epoch.epoch, ahead, mean(&score.simulation)))
    });
    let scored: Vec<(usize, f64, f64)> = scored.collect();
    // with a gain of innovations errors ahead are those of predictions, which may fall alone
    let gains = |from| matches!(from, Source::Error(_));
    let predicts = fit.model.model.s.entries().any(|(_, from, _)| gains(from));
    let best = scored.iter().copied().min_by(|a, b| a.2.total_cmp(&b.2));
    if let (Some(best), Some(last), false) = (best, scored.last(), predicts)
        && last.1 < best.1
        && last.2 > 1.1 * best.2
    {
        said.push(format!(
            "after epoch {} errors a few samples ahead fell by {:.0} % while those of the \
             simulation rose by {:.0} %: the sections are shorter than what the model \
             remembers",
            best.0,
            100.0 * (1.0 - last.1 / best.1),
            100.0 * (last.2 / best.2 - 1.0)
        ));
    }
    said
}

impl Augmented {
    /// Groups of parameters, one per signal of the learned part.
    pub fn groups(&self) -> Vec<Group> {
        groups(&self.model, self.signals().as_ref())
    }
}
