//! A record looked at: every cause, every pair, every other experiment.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::look::{Left, Look, with_sensors};
use super::outlook::{Experiment, LookAlikes, Outlook};
use super::visible::{shows, supposed, visibility};
use super::{ALIKE, ENOUGH, TWINS, experiments};
use crate::candidates::candidate::{Candidate, Wire};
use crate::candidates::library::{Allowed, library};
use crate::fit::hypothesis::Track;
use crate::fit::nuisance::Nuisance;
use crate::fit::problem::Part;
use crate::prepare::prepared::Prepared;
use crate::validate::noise_floor::NoiseFloor;
use crate::watch::Watch;

/// A model and a record, about to be looked at.
pub(super) struct Planning<'p, 'a> {
    pub prepared: &'p Prepared<'a>,
    pub noise: &'p [NoiseFloor],
    pub watch: &'p dyn Watch,
}

/// A pair that looks alike: the two, on which track, rho, D.
type Pair = (usize, usize, Track, f64, f64);

impl Planning<'_, '_> {
    pub fn look(&self, allowed: &Allowed) -> Option<Outlook> {
        let Prepared { problem, start, nominal, .. } = self.prepared;
        let mut causes: Vec<Arc<Candidate>> = vec![];
        for cause in library(problem, nominal, start, vec![], allowed, self.watch) {
            // a curve of any shape is alike to every shape
            if !cause.is_drawn() && !causes.iter().any(|c| c.same_cause(&cause)) {
                causes.push(cause);
            }
        }
        let asked = self.sizes(&causes)?;
        let trusted = Nuisance::new(problem, nominal);
        let free = trusted.clone().with_parameters(problem, &allowed.fixed);
        let nuisance = (&trusted, &free);
        let look = Look::outputs(problem, start, &asked, nuisance)?;
        let (held, moved) = (look.left(&look.trusted), look.left(&look.free));
        let count = problem.residual(&problem.y, Part::Fit).len() as f64;
        // effects that move the outputs as much as the noise does
        let sizes: Vec<f64> = held
            .before
            .iter()
            .map(|size| if *size > 0.0 { count.sqrt() / size } else { 0.0 })
            .collect();
        let is_free = |i: usize| match causes[i].wire {
            Wire::Parameter(p) => free.free.iter().any(|&(q, _)| q == p),
            _ => false,
        };
        let visible: Vec<bool> = (0..causes.len()).map(|i| shows(&causes[i], &held, i)).collect();
        let pairs = self.pairs((&held, &moved), &sizes, &visible, &is_free);
        let mut by: Vec<Vec<String>> = vec![vec![]; pairs.len()];
        // one and the same: not for the record alone, but under every input that is tried
        let mut twins: Vec<bool> = pairs.iter().map(|pair| pair.3 >= TWINS).collect();
        let mut experiments = vec![];
        let mut judge = |name: &str, description: &str, look: Option<Look>, is_sensor: bool| {
            let Some(look) = look else {
                let failed = Some("the model cannot be simulated under these inputs".into());
                experiments.push(Experiment {
                    name: name.into(),
                    description: description.into(),
                    distinguishes: 0,
                    distinguishes_free: 0,
                    also_shows: vec![],
                    failed,
                });
                return;
            };
            let (held, moved) = (look.left(&look.trusted), look.left(&look.free));
            let mut count = [0, 0];
            let of_pairs = by.iter_mut().zip(&mut twins).zip(&pairs);
            for ((by, twins), &(i, j, track, ..)) in of_pairs {
                let left = if track == Track::ParametersTrusted { &held } else { &moved };
                *twins &= is_sensor || left.rho(i, j) >= TWINS;
                if left.rho(i, j) <= ALIKE && left.separation(i, j, &sizes) >= ENOUGH {
                    by.push(name.into());
                    count[usize::from(track == Track::ParametersFree)] += 1;
                }
            }
            let also = (0..causes.len()).filter(|&i| !visible[i] && shows(&causes[i], &held, i));
            experiments.push(Experiment {
                name: name.into(),
                description: description.into(),
                distinguishes: count[0],
                distinguishes_free: count[1],
                also_shows: also.map(|i| supposed(&causes[i])).collect(),
                failed: None,
            });
        };
        for (i, other) in experiments::others(&problem.drive).into_iter().enumerate() {
            if self.watch.stopped() {
                break;
            }
            self.watch.report(0.3 + 0.1 * i as f64, &format!("simulating: {}", other.name));
            let look = self.under(other.drive, &asked, nuisance);
            judge(&other.name, &other.description, look, false);
        }
        let sensors = if self.watch.stopped() { vec![] } else { self.sensors() };
        self.watch.report(0.8, "simulating further sensors");
        if let Some(looks) = with_sensors(problem, start, &asked, nuisance, &sensors) {
            for (sensor, look) in sensors.iter().zip(looks) {
                let unit = if sensor.unit.is_empty() { "" } else { " " };
                let size = crate::digits::number(sensor.noise, None);
                let described = format!(
                    "a sensor of {} beside those there are, with noise of {size}{unit}{}",
                    sensor.name, sensor.unit
                );
                judge(&format!("sensor {}", sensor.name), &described, Some(look), true);
            }
        }
        experiments.sort_by_key(|e| {
            std::cmp::Reverse((e.distinguishes, e.distinguishes_free, e.also_shows.len()))
        });
        let names = problem.base.signals.outputs.iter().map(|s| s.name.clone());
        let look_alikes = pairs.iter().zip(by.into_iter().zip(twins)).map(|(pair, (by, twins))| {
            let &(i, j, track, rho, separation) = pair;
            let causes = [supposed(&causes[i]), supposed(&causes[j])];
            LookAlikes { causes, track, rho, separation, distinguished_by: by, twins }
        });
        Some(Outlook {
            schema: 1,
            samples: problem.samples(Part::Fit).count(),
            noise_floor: names.zip(self.noise.iter().cloned()).collect::<BTreeMap<_, _>>(),
            look_alikes: look_alikes.collect(),
            causes: (0..causes.len())
                .map(|i| visibility(&asked[i], visible[i], &held, &moved, i, is_free(i)))
                .collect(),
            experiments,
            interrupted: self.watch.stopped(),
        })
    }

    /// Pairs that look alike, those that do even when parameters are trusted first.
    fn pairs(
        &self,
        (held, moved): (&Left, &Left),
        sizes: &[f64],
        visible: &[bool],
        is_free: &dyn Fn(usize) -> bool,
    ) -> Vec<Pair> {
        let mut pairs: Vec<Pair> = vec![];
        // what would not show is not taken for anything
        let seen: Vec<usize> = (0..visible.len()).filter(|&i| visible[i]).collect();
        for (count, &j) in seen.iter().enumerate() {
            for &i in &seen[..count] {
                // what is too weak to show is no look-alike of everything
                let is_strong = |left: &Left| left.strength(i, j, sizes) >= ENOUGH;
                let alike = |left: &Left| {
                    let (rho, separation) = (left.rho(i, j), left.separation(i, j, sizes));
                    let is_alike = rho > ALIKE || separation < ENOUGH;
                    (is_strong(left) && is_alike).then_some((rho, separation))
                };
                if let Some((rho, separation)) = alike(held) {
                    pairs.push((i, j, Track::ParametersTrusted, rho, separation));
                } else if !is_free(i)
                    && !is_free(j)
                    && let Some((rho, separation)) = alike(moved)
                {
                    pairs.push((i, j, Track::ParametersFree, rho, separation));
                }
            }
        }
        let last = |track: Track| track == Track::ParametersFree;
        pairs.sort_by(|a, b| last(a.2).cmp(&last(b.2)).then(b.3.total_cmp(&a.3)));
        pairs
    }
}
