//! An outlook in sentences.

use std::fmt;

use super::outlook::{Experiment, LookAlikes, Outlook, Visibility};
use crate::{Track, number};

/// Names in one list at most.
const NAMES: usize = 12;
/// Share that free parameters leave of an effect, below which they are said to imitate it.
const IMITATED: f64 = 0.1;

/// Some names, and how many more there are.
fn names<T: fmt::Display>(all: &[T]) -> String {
    let shown: Vec<String> = all.iter().take(NAMES).map(ToString::to_string).collect();
    let more = all.len().saturating_sub(NAMES);
    let more = if more > 0 { format!("; and {more} more") } else { String::new() };
    format!("{}{more}", shown.join("; "))
}

impl Visibility {
    /// One line: the cause, its smallest size, and what parameters leave of it.
    pub fn line(&self) -> String {
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        let size = match self.smallest_visible {
            _ if !self.visible => "not visible".into(),
            Some(size) => format!("from {}{unit}", number(size, None)),
            None => "visible".into(),
        };
        let kappa = self.kappa.map_or_else(String::new, |kappa| {
            let left = number(100.0 * kappa, Some(100.0 * kappa * 0.03));
            format!(", {left} % left if parameters are free")
        });
        format!("{}: {size}{kappa}", self.cause)
    }
}

impl LookAlikes {
    /// One line: the two, how alike they are, and what tells them apart.
    pub fn line(&self) -> String {
        let [a, b] = &self.causes;
        let told = match &self.told_apart_by[..] {
            [] => "nothing tried here tells them apart".into(),
            by => format!("told apart by: {}", by.join(", ")),
        };
        format!("{a} | {b}: correlation {:.4}; {told}", self.rho)
    }
}

impl Experiment {
    /// One line: what to do and what it would tell.
    pub fn line(&self, [trusted, free]: [usize; 2]) -> String {
        let Self { name, description, tells_apart, tells_apart_free, also_shows, failed } = self;
        if let Some(why) = failed {
            return format!("{name} ({description}): {why}");
        }
        let also = match &also_shows[..] {
            [] => String::new(),
            shown => format!("; also shows {}", names(shown)),
        };
        let more = match free {
            0 => String::new(),
            free => format!(" ({tells_apart_free} of {free} if parameters are free)"),
        };
        format!("{name} ({description}): tells apart {tells_apart} of {trusted} pairs{more}{also}")
    }
}

impl fmt::Display for Outlook {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (output, floor) in &self.noise_floor {
            let size = number(floor.std, None);
            writeln!(f, "Noise of {output}: {size} ({}), {} samples", floor.method, self.samples)?;
        }
        let hidden: Vec<_> = self.causes.iter().filter(|c| !c.visible).map(|c| &c.cause).collect();
        match &hidden[..] {
            [] => writeln!(f, "Every cause of the library would show in this record.")?,
            hidden => writeln!(
                f,
                "{} of {} causes would not show, even as large as what drives their place: {}",
                hidden.len(),
                self.causes.len(),
                names(hidden)
            )?,
        }
        let imitated: Vec<String> = self
            .causes
            .iter()
            .filter(|c| c.visible)
            .filter_map(|c| Some((c, c.kappa.filter(|k| *k < IMITATED)?)))
            .map(|(c, kappa)| format!("{} ({:.1} % left)", c.cause, 100.0 * kappa))
            .collect();
        if !imitated.is_empty() {
            writeln!(f, "Free parameters imitate: {}", names(&imitated))?;
        }
        let sets = self.sets();
        if sets.is_empty() {
            writeln!(f, "With the parameters trusted, no two causes look alike.")?;
        }
        for set in &sets {
            let told = match self.best_for(set) {
                None => "nothing tried here tells any of them apart".into(),
                Some((name, told, pairs)) if told == pairs => format!("told apart by {name}"),
                Some((name, told, pairs)) => format!("{name} tells {told} of {pairs} pairs apart"),
            };
            writeln!(f, "Look alike: {} -- {told}", names(set))?;
        }
        let only_free = |p: &&LookAlikes| p.track == Track::ParametersFree;
        let more = self.look_alikes.iter().filter(only_free).count();
        if more > 0 {
            writeln!(f, "With the parameters free, {more} more pairs look alike.")?;
        }
        let pairs = self.look_alikes.len();
        let counts = [pairs - more, more];
        if pairs > 0 || !hidden.is_empty() {
            writeln!(f, "Experiments that would tell more:")?;
            let telling = |e: &&Experiment| {
                e.tells_apart + e.tells_apart_free > 0 || !e.also_shows.is_empty()
            };
            let mut any = false;
            for experiment in self.experiments.iter().filter(telling) {
                any = true;
                writeln!(f, "  {}", experiment.line(counts))?;
            }
            if !any {
                writeln!(f, "  none of those tried")?;
            }
        }
        let never = self.look_alikes.iter().filter(|p| p.told_apart_by.is_empty()).count();
        match never {
            0 => write!(f, "Each pair is told apart by one of them."),
            never => write!(f, "{never} of {pairs} pairs are told apart by none of those tried."),
        }
    }
}
