//! What a record can see and tell apart: plain data, as `lacuna plan --json` prints it.

use std::collections::{BTreeMap, HashSet};

use serde::Serialize;

use crate::{NoiseFloor, Track};

/// A supposed cause by name.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize)]
pub struct Supposed {
    /// Effect.
    pub effect: String,
    /// Where it enters.
    pub into: String,
    /// What it depends on.
    pub of: Option<String>,
}

impl std::fmt::Display for Supposed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} into {}", self.effect, self.into)?;
        match &self.of {
            Some(of) => write!(f, " of {of}"),
            None => Ok(()),
        }
    }
}

/// How well a record would see one cause.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Visibility {
    /// The cause.
    #[serde(flatten)]
    pub cause: Supposed,
    /// Further places where it would be the same thing in the model's equations.
    pub same_as: Vec<String>,
    /// Values of the shape parameters at which it was looked at.
    pub shape: BTreeMap<String, f64>,
    /// Whether the record shows it at a size that is no larger than what drives the place anyway.
    pub visible: bool,
    /// Smallest first parameter that shows (3.5 standard errors), the model's parameters being
    /// trusted; `None` where it has no such size or leaves no trace.
    pub smallest_visible: Option<f64>,
    /// The same with the model's parameters free.
    pub smallest_visible_free: Option<f64>,
    /// Unit of both.
    pub unit: String,
    /// Share of its effect on the outputs that free parameters and initial states cannot
    /// imitate; `None` for a parameter, which is free itself, and for what leaves no trace.
    pub kappa: Option<f64>,
}

/// Two causes that would show in a record and that it cannot tell apart.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LookAlikes {
    /// The two.
    pub causes: [Supposed; 2],
    /// `parameters_trusted` if they are alike even then, else `parameters_free`.
    pub track: Track,
    /// Correlation of their effects on the outputs, from 0 to 1.
    pub rho: f64,
    /// Square of what tells them apart over the noise, when each moves the outputs as much as
    /// the noise does; 10 are needed.
    pub separation: f64,
    /// Names of the experiments that tell them apart.
    #[serde(rename = "told_apart_by")]
    pub distinguished_by: Vec<String>,
    /// Whether no experiment with these inputs and sensors tells them apart: small effects of the
    /// two are one and the same, to rounding, in the record and in every experiment simulated.
    pub twins: bool,
}

/// Another experiment, simulated.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Experiment {
    /// Short name, such as `level x2`.
    pub name: String,
    /// What is to be done.
    pub description: String,
    /// Look-alikes that it tells apart, of those that are alike with parameters trusted.
    #[serde(rename = "tells_apart")]
    pub distinguishes: usize,
    /// And of those that are alike only where parameters are free.
    #[serde(rename = "tells_apart_free")]
    pub distinguishes_free: usize,
    /// Causes that the record does not show and this does.
    pub also_shows: Vec<Supposed>,
    /// Why it could not be simulated, if it could not.
    pub failed: Option<String>,
}

/// What a record can see and tell apart, and the experiment that would tell more.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Outlook {
    /// Always 1.
    pub schema: u32,
    /// Samples that count.
    pub samples: usize,
    /// Noise of the outputs, which everything is measured by.
    pub noise_floor: BTreeMap<String, NoiseFloor>,
    /// All causes that were looked at, in the library's order.
    pub causes: Vec<Visibility>,
    /// Pairs that look alike, most alike first.
    pub look_alikes: Vec<LookAlikes>,
    /// Experiments, the one that tells most pairs apart first.
    pub experiments: Vec<Experiment>,
    /// Whether somebody stopped the work before its end.
    pub interrupted: bool,
}

impl Outlook {
    /// Whether two causes are one and the same in the model's equations, each at a place of its
    /// own: an effect of the same coordinate, at places that [`Visibility::same_as`] puts together.
    pub fn is_same(&self, pair: [&Supposed; 2]) -> bool {
        self.causes.iter().any(|known| {
            pair.iter().all(|cause| {
                let places = std::iter::once(&known.cause.into).chain(&known.same_as);
                cause.effect == known.cause.effect
                    && cause.of == known.cause.of
                    && places.into_iter().any(|place| *place == cause.into)
            })
        })
    }

    /// Look-alikes as sets in which every two are alike, the parameters being trusted; the most
    /// alike are put together first, and each cause stands in one set at most.
    pub fn sets(&self) -> Vec<Vec<&Supposed>> {
        let trusted = || self.look_alikes.iter().filter(|p| p.track == Track::ParametersTrusted);
        let alike: HashSet<(&Supposed, &Supposed)> = trusted()
            .flat_map(|p| [(&p.causes[0], &p.causes[1]), (&p.causes[1], &p.causes[0])])
            .collect();
        let mut sets: Vec<Vec<&Supposed>> = vec![];
        for pair in trusted() {
            let own = |cause: &Supposed| sets.iter().position(|set| set.contains(&cause));
            let (a, b) = (own(&pair.causes[0]), own(&pair.causes[1]));
            if a.is_some() && a == b {
                continue;
            }
            let of = |set: Option<usize>, cause| set.map_or(vec![cause], |i| sets[i].clone());
            let (left, right) = (of(a, &pair.causes[0]), of(b, &pair.causes[1]));
            if left.iter().all(|x| right.iter().all(|y| alike.contains(&(*x, *y)))) {
                let at = a.or(b).unwrap_or(sets.len());
                let joined = [left, right].concat();
                match sets.get_mut(at) {
                    Some(set) => *set = joined,
                    None => sets.push(joined),
                }
                // the other one, if there were two
                if let Some(gone) = a.and(b) {
                    sets.remove(gone);
                }
            }
        }
        sets
    }

    /// What tells a set of look-alikes apart best: experiment, pairs of the set told apart, pairs
    /// there are.
    pub fn best_for(&self, set: &[&Supposed]) -> Option<(&str, usize, usize)> {
        let inside: Vec<&LookAlikes> = self
            .look_alikes
            .iter()
            .filter(|pair| pair.causes.iter().all(|cause| set.contains(&cause)))
            .collect();
        let count = |e: &Experiment| {
            inside.iter().filter(|pair| pair.distinguished_by.contains(&e.name)).count()
        };
        let mut best: Option<(&str, usize, usize)> = None;
        for experiment in &self.experiments {
            let number = count(experiment);
            if number > best.map_or(0, |(_, most, _)| most) {
                best = Some((&experiment.name, number, inside.len()));
            }
        }
        best
    }
}
