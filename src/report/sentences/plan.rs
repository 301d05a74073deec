//! What a record can see and tell apart, in sentences.

use super::names;
use crate::diagnose::{Experiment, LookAlikes, Outlook, Supposed, Track, Visibility};
use crate::digits::{number, spaced};

/// Names in one list at most.
const NAMES: usize = 12;
/// Share that free parameters leave of an effect, below which they are said to imitate it.
const IMITATED: f64 = 0.1;

/// One line: the cause, its smallest size, and what parameters leave of it.
pub fn visibility(cause: &Visibility) -> String {
    let unit = spaced(&cause.unit);
    let size = match cause.smallest_visible {
        _ if !cause.visible => "not visible".into(),
        Some(size) => format!("from {}{unit}", number(size, None)),
        None => "visible".into(),
    };
    let kappa = cause.kappa.map_or_else(String::new, |kappa| {
        let left = number(100.0 * kappa, Some(100.0 * kappa * 0.03));
        format!(", {left} % left if parameters are free")
    });
    format!("{}: {size}{kappa}", cause.cause)
}

/// One line: the two, how alike they are, and what tells them apart.
pub fn look_alikes(pair: &LookAlikes) -> String {
    let [a, b] = &pair.causes;
    let reported = match &pair.distinguished_by[..] {
        [] if pair.twins => {
            "no experiment with these inputs tells them apart: while they are small \
                             the predicted difference is zero"
                .into()
        }
        [] => "nothing tried here tells them apart".into(),
        by => format!("told apart by: {}", by.join(", ")),
    };
    format!("{a} | {b}: correlation {:.4}; {reported}", pair.rho)
}

/// One line: what to do and what it would tell, of so many pairs that look alike with parameters
/// trusted, and so many more with free ones.
pub fn experiment(of: &Experiment, [trusted, free]: [usize; 2]) -> String {
    let Experiment { name, description, distinguishes, distinguishes_free, also_shows, failed } =
        of;
    if let Some(why) = failed {
        return format!("{name} ({description}): {why}");
    }
    let also = match &also_shows[..] {
        [] => String::new(),
        listed => format!("; also shows {}", names(listed, NAMES)),
    };
    let more = match free {
        0 => String::new(),
        free => format!(" ({distinguishes_free} of {free} if parameters are free)"),
    };
    format!("{name} ({description}): tells apart {distinguishes} of {trusted} pairs{more}{also}")
}

/// Whether every two of a set are one and the same under every input.
fn are_twins(outlook: &Outlook, set: &[&Supposed]) -> bool {
    let inside = |pair: &&LookAlikes| pair.causes.iter().all(|cause| set.contains(&cause));
    outlook.look_alikes.iter().filter(inside).all(|pair| pair.twins)
}

/// The causes that are the same at several places of the model's equations.
fn same(outlook: &Outlook) -> Option<String> {
    let all: Vec<String> = outlook
        .causes
        .iter()
        .filter(|cause| !cause.same_as.is_empty())
        .map(|cause| format!("{}, or into {}", cause.cause, cause.same_as.join(" or ")))
        .collect();
    (!all.is_empty()).then(|| {
        format!(
            "The same in the model's equations, so that no experiment with these inputs tells the \
             places apart: {}",
            names(&all, NAMES)
        )
    })
}

/// Everything that a record can see and tell apart.
pub fn outlook(outlook: &Outlook) -> String {
    let mut lines: Vec<String> = vec![];
    for (output, floor) in &outlook.noise_floor {
        let size = number(floor.std, None);
        lines.push(format!(
            "Noise of {output}: {size} ({}), {} samples",
            floor.method, outlook.samples
        ));
    }
    let hidden: Vec<_> = outlook.causes.iter().filter(|c| !c.visible).map(|c| &c.cause).collect();
    match &hidden[..] {
        [] => lines.push("Every cause of the library would show in this record.".into()),
        hidden => lines.push(format!(
            "{} of {} causes would not show, even as large as what drives their place: {}",
            hidden.len(),
            outlook.causes.len(),
            names(hidden, NAMES)
        )),
    }
    let imitated: Vec<String> = outlook
        .causes
        .iter()
        .filter(|c| c.visible)
        .filter_map(|c| Some((c, c.kappa.filter(|k| *k < IMITATED)?)))
        .map(|(c, kappa)| format!("{} ({:.1} % left)", c.cause, 100.0 * kappa))
        .collect();
    if !imitated.is_empty() {
        lines.push(format!("Free parameters imitate: {}", names(&imitated, NAMES)));
    }
    let sets = outlook.sets();
    if sets.is_empty() {
        lines.push("With the parameters trusted, no two causes look alike.".into());
    }
    for set in &sets {
        let reported = match outlook.best_for(set) {
            None if are_twins(outlook, set) => "no experiment with these inputs tells any of them \
                                                apart: the predicted difference is zero"
                .into(),
            None => "nothing tried here tells any of them apart".into(),
            Some((name, reported, pairs)) if reported == pairs => format!("told apart by {name}"),
            Some((name, reported, pairs)) => {
                format!("{name} tells {reported} of {pairs} pairs apart")
            }
        };
        lines.push(format!("Look alike: {} -- {reported}", names(set, NAMES)));
    }
    lines.extend(same(outlook));
    let only_free = |p: &&LookAlikes| p.track == Track::ParametersFree;
    let more = outlook.look_alikes.iter().filter(only_free).count();
    if more > 0 {
        lines.push(format!("With the parameters free, {more} more pairs look alike."));
    }
    let pairs = outlook.look_alikes.len();
    let counts = [pairs - more, more];
    if pairs > 0 || !hidden.is_empty() {
        lines.push("Experiments that would tell more:".into());
        let informative = |e: &&Experiment| {
            e.distinguishes + e.distinguishes_free > 0 || !e.also_shows.is_empty()
        };
        let mut any = false;
        for other in outlook.experiments.iter().filter(informative) {
            any = true;
            lines.push(format!("  {}", experiment(other, counts)));
        }
        if !any {
            lines.push("  none of those tried".into());
        }
    }
    let never = outlook.look_alikes.iter().filter(|p| p.distinguished_by.is_empty()).count();
    match never {
        0 => lines.push("Each pair is told apart by one of them.".into()),
        never => {
            lines.push(format!("{never} of {pairs} pairs are told apart by none of those tried."))
        }
    }
    lines.join("\n")
}
