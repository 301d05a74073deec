//! What has to be added at each channel for the model that was handed in to follow its records.

use super::compete::predictor;
use super::reconsidered::is_white;
use crate::candidates::library::Allowed;
use crate::findings::cause::{ExplainedBy, MissingForce};
use crate::findings::hand_over::Searched;
use crate::findings::note::Note;
use crate::fit::affordable::affordable_forces;
use crate::fit::finished::Finished;
use crate::fit::nuisance::PRIOR;
use crate::fit::problem::Grain;
use crate::prepare::prepared::Prepared;
use crate::watch::Watch;

/// Probability that parameters are off from which on it is said: what a 95 % interval leaves out.
const DOUBTED: f64 = 0.05;
/// Coordinates that are told of each channel.
const REPORTED: usize = 4;

/// What a search says, with the missing force and what disturbs the plant.
pub(crate) fn completed(
    prepared: &Prepared<'_>,
    chosen: &Finished,
    of: Searched,
    watch: &dyn Watch,
) -> Searched {
    // a model that leaves white noise lacks no force
    let bare = prepared.problem.simulate(&prepared.start, Grain::Fine);
    let lacks = !bare.is_some_and(|y| is_white(prepared, &y));
    let sizes = prepared.problem.base.sizes;
    let most = affordable_forces(&prepared.problem).filter(|_| lacks);
    let missing = match most {
        Some(0) => vec![],
        _ if lacks => missing(prepared, most.unwrap_or(usize::MAX), watch),
        _ => vec![],
    };
    let mut of = Searched { missing, ..of };
    if let Some(channels) = most {
        of.notes.push(Note::ForcesLeftOut { channels, of: sizes.w + sizes.u });
    }
    if let Some(disturbances) = chosen.inside.clone().filter(|all| !all.is_empty()) {
        of.notes.push(Note::Inside { disturbances });
    }
    if chosen.causes() > 0 && chosen.doubt > DOUBTED {
        of.notes.push(Note::ParametersDoubted { doubt: chosen.doubt, prior: PRIOR });
    }
    of
}

/// The missing force of every channel where one is seen, or of those that the records call for most where
/// all of them are too much work; none where the records do not tell.
fn missing(prepared: &Prepared<'_>, most: usize, watch: &dyn Watch) -> Vec<MissingForce> {
    watch.report(0.98, "smoothing the missing force");
    let found = predictor(&prepared.problem, &prepared.start, &Allowed::default());
    let found = found
        .and_then(|predictor| predictor.missing_of(most, &|| watch.stopped()))
        .unwrap_or_default();
    let seen = found.into_iter().filter(|force| force.is_seen());
    seen.map(|force| MissingForce {
        channel: force.channel,
        unit: force.unit,
        rms: force.rms,
        explained_by: force
            .explained_by
            .into_iter()
            .take(REPORTED)
            .map(|by| ExplainedBy { coordinate: by.coordinate, share: by.share })
            .collect(),
    })
    .collect()
}
