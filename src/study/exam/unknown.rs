//! Names in answers that a case does not know: effects that no plug-in registers, places and coordinates that
//! its model does not have. They count as names of something that was not hidden, and are most often typing.

use super::answer::Answer;
use crate::fault::nearest;
use crate::register::Card;
use crate::system::System;

/// A name in an answer that its case does not know.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownName {
    /// Number of the case.
    pub case: usize,
    /// What it should be: `effect`, `place` or `coordinate`.
    pub role: &'static str,
    /// The name.
    pub name: String,
    /// A name there is that is like it.
    pub near: Option<String>,
}

/// The unknown names of an answer, each once, in order.
pub(super) fn unknown_names(answer: &Answer, cards: &[&Card], model: &System) -> Vec<UnknownName> {
    let effects: Vec<String> = cards.iter().map(|card| card.name.to_string()).collect();
    let signals = model.signals();
    let names = |list: &[crate::model::Signal]| -> Vec<String> {
        list.iter().map(|signal| signal.name.clone()).collect()
    };
    let columns = [names(&signals.inputs), names(&signals.outputs)].concat();
    let parameters = signals.parameters.iter().map(|own| own.name.clone()).collect();
    let time = vec!["time".to_string()];
    let places =
        [columns.clone(), names(&signals.own_channels()), parameters, time.clone()].concat();
    let coordinates = [columns, names(&signals.own_coordinates()), time].concat();
    let mut found: Vec<UnknownName> = vec![];
    let mut ask = |role, name: &str, known: &[String]| {
        let new = found.iter().all(|other| other.role != role || other.name != name);
        if new && known.iter().all(|own| own != name) {
            let near = nearest(name, known.iter().map(String::as_str));
            found.push(UnknownName { case: answer.case, role, name: name.into(), near });
        }
    };
    for cause in &answer.causes {
        let own = (&cause.effect, &cause.into, &cause.of);
        let others =
            cause.indistinguishable.iter().map(|other| (&other.effect, &other.into, &other.of));
        for (effect, into, of) in std::iter::once(own).chain(others) {
            ask("effect", effect, &effects);
            ask("place", into, &places);
            of.iter().for_each(|of| ask("coordinate", of, &coordinates));
        }
        cause.parts.iter().for_each(|part| ask("effect", &part.effect, &effects));
    }
    found
}
