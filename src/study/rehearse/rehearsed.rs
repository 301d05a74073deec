//! What rehearsals say: error rates of this record.

use serde::Serialize;

use super::Outcome;
use super::scene::{Question, Scene, Stage, named};
use crate::diagnose::Finding;
use crate::share::Share;

/// How often a cause of some size has to be found.
const OFTEN: f64 = 0.9;

/// How a look-alike is taken.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LookAlike {
    /// What is in the machine.
    pub name: String,
    /// The cause whose place it takes.
    pub in_place_of: String,
    /// It stands in the set of a cause.
    pub named: Share,
    /// The cause heads one instead.
    pub taken_for_the_cause: Share,
}

/// A cause at one size.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Level {
    /// Times what was found.
    pub factor: f64,
    /// The cause's first number at that size.
    pub value: Option<f64>,
    /// How often it was found.
    pub found: Share,
}

/// How small a cause may be.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Smallest {
    /// The cause.
    pub name: String,
    /// Its first number, and the unit of that.
    pub parameter: String,
    /// Unit.
    pub unit: String,
    /// Size that would be found nine times of ten, in what was found; `None` where no size that was
    /// rehearsed was found so often.
    pub factor: Option<f64>,
    /// The same as the cause's first number.
    pub value: Option<f64>,
    /// Sizes that were rehearsed, the smallest first.
    pub levels: Vec<Level>,
}

/// What all rehearsals came to.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Rehearsed {
    /// Rehearsals that are done.
    pub runs: usize,
    /// Order of the autoregression that the record's noise is drawn from.
    pub noise_order: usize,
    /// With nothing hidden, something was named.
    pub false_alarms: Share,
    /// With the found causes, each stands in a set again; absent where none was found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub same_names: Option<Share>,
    /// The same names head the causes again.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub same_headlines: Option<Share>,
    /// Something is named beside them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub something_else: Option<Share>,
    /// Look-alikes in the place of causes.
    pub look_alikes: Vec<LookAlike>,
    /// Smallest sizes.
    pub smallest: Vec<Smallest>,
}

fn in_a_set(outcome: &Outcome, name: &String) -> bool {
    outcome.sets.iter().any(|set| set.contains(name))
}

fn heads(outcome: &Outcome, name: &String) -> bool {
    outcome.sets.iter().any(|set| set.first() == Some(name))
}

impl Rehearsed {
    pub(super) fn of(
        finding: &Finding,
        scenes: &[Scene],
        outcomes: &[Outcome],
        stage: &Stage<'_>,
    ) -> Self {
        let of = |scene: usize| outcomes.iter().filter(move |o| o.scene == scene);
        let names = named(finding);
        let (mut false_alarms, mut look_alikes) = (Share::of([]), vec![]);
        let (mut same_names, mut same_headlines, mut something_else) = (None, None, None);
        let mut levels: Vec<Vec<Level>> = names.iter().map(|_| vec![]).collect();
        for (number, scene) in scenes.iter().enumerate() {
            let of = || of(number);
            match &scene.question {
                Question::Nothing => false_alarms = Share::of(of().map(|o| !o.sets.is_empty())),
                Question::Found => {
                    let all = |o: &Outcome, is: fn(&Outcome, &String) -> bool| {
                        names.iter().all(|name| is(o, name))
                    };
                    same_names = Some(Share::of(of().map(|o| all(o, in_a_set))));
                    same_headlines = Some(Share::of(of().map(|o| all(o, heads))));
                    let more = |o: &Outcome| {
                        o.sets.iter().any(|set| !set.iter().any(|name| names.contains(name)))
                    };
                    something_else = Some(Share::of(of().map(more)));
                }
                Question::LookAlike { name, of: cause } => look_alikes.push(LookAlike {
                    name: name.clone(),
                    in_place_of: cause.clone(),
                    named: Share::of(of().map(|o| in_a_set(o, name))),
                    taken_for_the_cause: Share::of(
                        of().map(|o| heads(o, cause) && !heads(o, name)),
                    ),
                }),
                Question::Size { cause, factor, value } => levels[*cause].push(Level {
                    factor: *factor,
                    value: *value,
                    found: Share::of(of().map(|o| in_a_set(o, &names[*cause]))),
                }),
            }
        }
        let causes = finding.in_the_machine().zip(&names).zip(levels);
        let smallest =
            causes.filter(|(_, levels)| !levels.is_empty()).map(|((cause, name), levels)| {
                let factor = smallest(&levels);
                let first = cause.parameters.first();
                Smallest {
                    name: name.clone(),
                    parameter: first.map_or_else(String::new, |p| p.name.clone()),
                    unit: first.map_or_else(String::new, |p| p.unit.clone()),
                    factor,
                    value: factor.and_then(|factor| valued(&levels, factor)),
                    levels,
                }
            });
        Self {
            runs: outcomes.len(),
            noise_order: stage.noise.iter().map(|noise| noise.order()).max().unwrap_or(0),
            false_alarms,
            same_names,
            same_headlines,
            something_else,
            look_alikes,
            smallest: smallest.collect(),
        }
    }
}

/// The smallest factor that is found often enough: the share found is taken as one that grows with
/// the size (isotonic regression by pooling adjacent violators: Barlow and others, 1972), and as a
/// straight line over the logarithm of the factor between sizes.
fn smallest(levels: &[Level]) -> Option<f64> {
    let mut pools: Vec<(f64, f64, usize)> = vec![];
    for level in levels.iter().filter(|level| level.found.of > 0) {
        pools.push((level.found.count as f64, level.found.of as f64, 1));
        while let [.., a, b] = pools[..]
            && a.0 / a.1 > b.0 / b.1
        {
            pools.truncate(pools.len() - 2);
            pools.push((a.0 + b.0, a.1 + b.1, a.2 + b.2));
        }
    }
    let shares = pools.iter().flat_map(|(count, of, n)| std::iter::repeat_n(count / of, *n));
    let known = levels.iter().filter(|level| level.found.of > 0);
    let points: Vec<(f64, f64)> = known.map(|level| level.factor).zip(shares).collect();
    let at = points.iter().position(|(_, share)| *share >= OFTEN)?;
    let Some(before) = at.checked_sub(1) else { return Some(points[0].0) };
    let ((low, below), (high, above)) = (points[before], points[at]);
    let along = (OFTEN - below) / (above - below);
    Some((low.ln() + along * (high / low).ln()).exp())
}

/// The value at a factor, between those of the sizes beside it.
fn valued(levels: &[Level], factor: f64) -> Option<f64> {
    let after = levels.iter().position(|level| level.factor >= factor)?;
    let Some(before) = after.checked_sub(1) else { return levels[0].value };
    let (low, high) = (&levels[before], &levels[after]);
    let along = (factor - low.factor) / (high.factor - low.factor);
    Some(low.value? + along * (high.value? - low.value?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smallest_size_lies_where_nine_of_ten_are_found() {
        let level = |factor: f64, count: usize| Level {
            factor,
            value: Some(-2.0 * factor),
            found: Share::of((0..10).map(|k| k < count)),
        };
        let levels = [level(0.1, 0), level(0.2, 8), level(0.4, 10)];
        let factor = smallest(&levels).unwrap();
        assert!((factor - 0.2 * 2f64.sqrt()).abs() < 1e-9, "{factor}");
        assert!((valued(&levels, factor).unwrap() + 2.0 * factor).abs() < 1e-12);
        // a size at which luck was better than at the next one is no evidence
        let lucky = [level(0.1, 9), level(0.2, 5), level(0.4, 10)];
        assert!(smallest(&lucky).unwrap() > 0.3, "{:?}", smallest(&lucky));
        assert_eq!(smallest(&[level(0.1, 0), level(0.2, 8)]), None);
        assert_eq!(smallest(&[level(0.1, 10)]), Some(0.1));
    }
}
