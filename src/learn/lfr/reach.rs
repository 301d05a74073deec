//! Which signals of a baseline a learned part may see and move.

use super::{LfrError, Sink, Source};
use crate::model::Signals;

/// Refuses names that are none of those of the baseline.
pub(super) fn known<'n>(
    key: &str,
    names: &[String],
    of: impl Iterator<Item = &'n str> + Clone,
) -> Result<(), LfrError> {
    match names.iter().find(|name| !of.clone().any(|known| known == name.as_str())) {
        None => Ok(()),
        Some(name) => {
            let all = of.collect::<Vec<&str>>().join(", ");
            let reason = format!("`{key}` names `{name}`, and the baseline has {all}");
            Err(LfrError::Baseline { block: 0, reason })
        }
    }
}

fn named(list: &[String], name: Option<&String>) -> bool {
    list.is_empty() || name.is_none_or(|name| list.contains(name))
}

/// Whether a network sees a signal: any that is not the baseline's own, and those in the list.
pub(super) fn is_seen(list: &[String], signals: &Signals, from: Source) -> bool {
    match from {
        Source::State(i) => named(list, signals.states.get(i).map(|state| &state.signal.name)),
        Source::Input(i) => named(list, signals.inputs.get(i).map(|input| &input.name)),
        Source::Block(..) | Source::Error(_) => true,
    }
}

/// Whether it may add to a signal: any but the states of the baseline that are not in the list.
pub(super) fn is_moved(list: &[String], signals: &Signals, to: Sink) -> bool {
    match to {
        Sink::State(i) => named(list, signals.states.get(i).map(|state| &state.signal.name)),
        Sink::Output(_) | Sink::Block(..) => true,
    }
}
