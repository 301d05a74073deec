//! What a learned part is: the channel that it enters, the coordinate that it depends on, and the
//! law of the library that it most probably is.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::learned::LearnedCurve;
use crate::data::Record;
use crate::digits::number;
use crate::estimate::law::{Candidate, Pairs, Part, Reading, read};
use crate::model::Signal;
use crate::register;
use crate::train::{Added, Augmented, Contribution, Coordinate, TrainError};

/// Laws that are listed.
const LISTED: usize = 5;

/// A learned part read along a record.
#[derive(Debug)]
pub struct ReadBack {
    added: Added,
    others: Vec<(String, f64)>,
    /// Coordinates with what they decide, the one that decides most first.
    coordinates: Vec<(Coordinate, Reading)>,
}

/// Share from which on something is mostly a law of a coordinate.
const MOSTLY: f64 = 0.5;
/// Share of what is added that rounds to nothing.
const NO_FORCE: f64 = 0.005;

impl ReadBack {
    /// Reads the learned part of a model along a record: one entry for what enters the states, and
    /// one for each output that something is added to.
    ///
    /// # Errors
    ///
    /// A record that the model cannot be run along.
    pub fn of(model: &Augmented, record: &Record) -> Result<Vec<Self>, TrainError> {
        let Some(contribution) = model.added(record)? else { return Ok(vec![]) };
        let library: Vec<_> = register::effects()
            .into_iter()
            .map(|(card, law)| (card.name.to_string(), law))
            .collect();
        let Contribution { channels, outputs, coordinates, sampling_time } = contribution;
        let others = channels.iter().skip(1).map(|c| (c.channel.name.clone(), c.share)).collect();
        let entered = channels.into_iter().next().map(|first| (first, others));
        let all = entered.into_iter().chain(outputs.into_iter().map(|added| (added, vec![])));
        let each = all.map(|(added, others)| {
            let read = |coordinate: &Coordinate| {
                let Coordinate { signal, values, .. } = coordinate;
                let pairs =
                    Pairs { coordinate: signal, z: values, w: &added.values, sampling_time };
                (coordinate.clone(), read(&pairs, &library))
            };
            let mut coordinates: Vec<(Coordinate, Reading)> =
                coordinates.iter().map(read).collect();
            coordinates.sort_by(|a, b| b.1.share.total_cmp(&a.1.share));
            Self { added, others, coordinates }
        });
        Ok(each.collect())
    }

    /// A sentence: "The learned part enters force and depends on v (97 %): it is ...".
    pub fn sentence(&self) -> String {
        let channel = &self.added.channel.name;
        let percent = |share: f64| format!("{:.0} %", 100.0 * share);
        let mut text = format!("The learned part enters `{channel}`");
        if self.added.share < NO_FORCE {
            return "The learned part enters no channel of the model: what it adds to the states is no \
                    force at any of them."
                .into();
        }
        if self.added.share < 1.0 {
            let _ = write!(text, " ({} of what it adds)", percent(self.added.share));
        }
        let Some((coordinate, reading)) = self.coordinates.first() else { return text + "." };
        let of = &coordinate.signal.name;
        if reading.share < MOSTLY {
            let share = percent(reading.share);
            let _ = write!(
                text,
                " and is no law of one coordinate: `{of}` makes up for {share} of it."
            );
            return text;
        }
        let _ = write!(text, " and depends on `{of}` ({})", percent(reading.share));
        let _ = match reading.named() {
            Some(law) => write!(
                text,
                ": most probably {} (probability {}, {} of it).",
                named(law),
                number(law.probability, None),
                percent(law.share)
            ),
            None => match reading.candidates.iter().find(|law| !law.parts.is_empty()) {
                None => write!(text, ": a curve of `{of}` without a name in the library."),
                Some(nearest) => write!(
                    text,
                    ": a curve of `{of}` without a name in the library; nearest is {} ({} of it).",
                    named(nearest),
                    percent(nearest.share)
                ),
            },
        };
        text
    }

    /// The same as data.
    pub fn document(&self) -> Value {
        let coordinate = |(coordinate, reading): &(Coordinate, Reading)| {
            let curve: Vec<[f64; 3]> =
                reading.curve.iter().map(|drawn| [drawn.z, drawn.w, drawn.band]).collect();
            let laws: Vec<Value> = reading.candidates.iter().take(LISTED).map(law).collect();
            json!({
                "coordinate": coordinate.signal.name,
                "unit": coordinate.signal.unit,
                "share": reading.share,
                "laws": laws,
                "curve": curve,
                "baseline": coordinate.own,
            })
        };
        let others: Vec<Value> = self
            .others
            .iter()
            .map(|(name, share)| json!({"channel": name, "share": share}))
            .collect();
        json!({
            "channel": self.added.channel.name,
            "unit": self.added.channel.unit,
            "share": self.added.share,
            "other_channels": others,
            "of": self.coordinates.iter().map(coordinate).collect::<Vec<_>>(),
            "sentence": self.sentence(),
        })
    }

    /// The learned term against its coordinate, as the report draws it.
    pub fn curve(&self) -> Option<LearnedCurve> {
        let (coordinate, reading) = self.coordinates.first()?;
        let text = |signal: &Signal| (signal.name.clone(), signal.unit.clone());
        let points = reading.curve.iter().map(|d| (d.z, d.w - 2.0 * d.band, d.w + 2.0 * d.band));
        Some(LearnedCurve {
            coordinate: text(&coordinate.signal),
            channel: text(&self.added.channel),
            middle: reading.curve.iter().map(|drawn| (drawn.z, drawn.w)).collect(),
            band: points.collect(),
            baseline: coordinate.own.clone(),
            sentence: self.sentence(),
        })
    }
}

/// A law in words: effects with their numbers.
fn named(law: &Candidate) -> String {
    let parts = law.parts.iter().map(|part| {
        let parameters =
            part.law.card().parameters.into_iter().filter(|parameter| parameter.value.is_finite());
        let parameters: Vec<String> = parameters
            .map(|parameter| format!("{} {}", parameter.name, number(parameter.value, None)))
            .collect();
        format!("{} ({})", part.effect, parameters.join(", "))
    });
    parts.collect::<Vec<_>>().join(" + ")
}

fn law(law: &Candidate) -> Value {
    let part = |part: &Part| {
        let parameters =
            part.law.card().parameters.into_iter().filter(|parameter| parameter.value.is_finite());
        let parameters: serde_json::Map<String, Value> = parameters
            .map(|parameter| (parameter.name.to_string(), json!(parameter.value)))
            .collect();
        json!({ "effect": part.effect, "parameters": parameters })
    };
    let parts: Vec<Value> = law.parts.iter().map(part).collect();
    json!({ "parts": parts, "probability": law.probability, "share": law.share, "named": !law.parts.is_empty() })
}
