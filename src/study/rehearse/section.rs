//! Rehearsals in words, and as a part of a report.

use super::rehearsed::{Rehearsed, Smallest};
use crate::digits::number;
use crate::report::Page;
use crate::share::Share;

/// Name of a cause in words: `effect>place<coordinate`.
fn words(name: &str) -> String {
    let (effect, place) = name.split_once('>').unwrap_or((name, ""));
    match place.rsplit_once('<') {
        Some((into, "-")) => format!("{effect} into {into}"),
        Some((into, of)) => format!("{effect} into {into} of {of}"),
        None => effect.into(),
    }
}

fn times(share: &Share) -> String {
    let [low, high] = share.interval95;
    let percent = |share: f64| format!("{:.0}", 100.0 * share);
    match share.of {
        0 => "not rehearsed".into(),
        of => format!(
            "{} of {of} times (95 % interval {} to {} %)",
            share.count,
            percent(low),
            percent(high)
        ),
    }
}

fn size(smallest: &Smallest) -> String {
    let Smallest { parameter, unit, factor, value, .. } = smallest;
    match (factor, value) {
        (None, _) => "no size up to four times what was found is found so often".into(),
        (Some(factor), None) => format!("{} of what was found", number(*factor, None)),
        (Some(factor), Some(value)) => {
            let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
            let (value, factor) = (number(*value, None), number(*factor, None));
            format!("{parameter} = {value}{unit} ({factor} of what was found)")
        }
    }
}

impl Rehearsed {
    /// In sentences.
    pub fn sentences(&self) -> Vec<String> {
        let mut all = vec![format!(
            "Rehearsed {} times on records like this one. With nothing hidden, something is named {}.",
            self.runs,
            times(&self.false_alarms)
        )];
        if let (Some(names), Some(heads), Some(more)) =
            (&self.same_names, &self.same_headlines, &self.something_else)
        {
            all.push(format!(
                "With what was found in the machine, the same names come back {}, as headlines {}; \
                 something else is named {}.",
                times(names),
                times(heads),
                times(more)
            ));
        }
        for other in &self.look_alikes {
            all.push(format!(
                "With {} in the machine in place of {}, it is named {}, and taken for {1} {}.",
                words(&other.name),
                words(&other.in_place_of),
                times(&other.named),
                times(&other.taken_for_the_cause)
            ));
        }
        for smallest in &self.smallest {
            let name = words(&smallest.name);
            all.push(format!("Found nine times of ten, {name}: {}.", size(smallest)));
        }
        all
    }

    /// As a part of a report.
    pub fn section(&self, page: &mut Page) {
        page.heading("How often this record would mislead");
        for sentence in self.sentences() {
            page.element("p", "", &sentence);
        }
        let rows = self.smallest.iter().flat_map(|smallest| {
            smallest.levels.iter().map(|level| {
                vec![
                    words(&smallest.name),
                    number(level.factor, None),
                    level.value.map_or_else(String::new, |value| number(value, None)),
                    smallest.unit.clone(),
                    level.found.of.to_string(),
                    level.found.count.to_string(),
                ]
            })
        });
        let rows: Vec<Vec<String>> = rows.collect();
        if !rows.is_empty() {
            let header = ["cause", "#of what was found", "#value", "unit", "#rehearsed", "#found"];
            page.table(&header, &rows);
        }
        page.element(
            "p",
            "note",
            &format!(
                "The found model is simulated along the record's inputs; noise is drawn from what it \
                 leaves (an autoregression of order {} at most, its innovations resampled), and the \
                 whole diagnosis is run again. All of this holds if what was found is right.",
                self.noise_order
            ),
        );
    }
}
