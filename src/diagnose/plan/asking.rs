//! How much of each cause is simulated, under which inputs, with which sensors.

use std::sync::Arc;

use super::look::{Asked, Look, Sensor};
use super::planning::Planning;
use crate::candidates::candidate::Candidate;
use crate::candidates::probes::{Probe, Sharing, steer};
use crate::fit::nuisance::Nuisance;
use crate::fit::problem::{Grain, Part, Problem, Span};
use crate::prepare::prepared::Prepared;
use crate::statistics::{deviation, median, rms};
use crate::system::{Drive, Origin};

/// Share of the outputs' spread that probes move them by.
const GENTLE: f64 = 0.02;

impl Planning<'_, '_> {
    /// Sizes at which the causes' effects are gentle: in the middle of their shapes.
    pub(super) fn sizes(&self, causes: &[Arc<Candidate>]) -> Option<Vec<Asked>> {
        let Prepared { problem, start, .. } = self.prepared;
        let base = problem.job(start, Grain::Coarse)?;
        let y0 = problem.run(&[base], Span::Fit).swap_remove(0)?;
        let r0 = problem.residual(&y0, Part::Fit);
        let spreads: Vec<f64> = (0..problem.y.len())
            .map(|o| deviation(&problem.counted(o, &y0[o], Part::Fit)) / problem.scale[o])
            .collect();
        let spread = rms(&spreads).max(1e-9);
        let mut probes: Vec<Probe> = causes
            .iter()
            .enumerate()
            .map(|(c, cause)| Probe {
                candidate: c,
                start: cause.starts.len() / 2,
                which: 0,
                size: cause.probe * if cause.sign < 0.0 { -1.0 } else { 1.0 },
                done: false,
                failed: false,
            })
            .collect();
        let (kinds, grain) = (vec![], Grain::Coarse);
        let mut sharing = Sharing { problem, model: start, kinds, grain, watch: &() };
        let gentle = (1e-6, GENTLE * spread);
        // the sizes that probes end with are those that hit
        steer(problem, &mut sharing, causes, &mut probes, &r0, gentle, false);
        let asked = probes.into_iter().zip(causes).map(|(probe, cause)| {
            let mut parameters = cause.starts[probe.start].clone();
            let mut blend = 1.0;
            match cause.linear.first() {
                Some(&parameter) => parameters[parameter] = probe.size,
                None => blend = probe.size.abs().min(1.0),
            }
            let size = if cause.blended() { blend } else { probe.size };
            let size = (probe.done && !probe.failed).then_some(size);
            Asked { cause: cause.clone(), parameters, blend, size }
        });
        Some(asked.collect())
    }

    /// The same look under other inputs.
    pub(super) fn under(
        &self,
        drive: Drive,
        asked: &[Asked],
        nuisance: (&Nuisance, &Nuisance),
    ) -> Option<Look> {
        let joined = &self.prepared.joined;
        let (step, spans) = (joined.sampling_time, &joined.spans);
        let system = self.prepared.problem.system;
        let mut other = Problem::new(system, step, drive, &joined.measured, spans, 1.0).ok()?;
        other.scale.clone_from(&self.prepared.problem.scale);
        other.coarsen(&self.prepared.start);
        Look::outputs(&other, &self.prepared.start, asked, nuisance)
    }

    /// States and coordinates of the model that no output shows yet, as noisy for their movement
    /// as the outputs are.
    pub(super) fn sensors(&self) -> Vec<Sensor> {
        let Prepared { problem, nominal, .. } = self.prepared;
        let base = &problem.base;
        let shares: Vec<f64> = (0..problem.y.len())
            .map(|o| {
                let spread = deviation(&problem.counted(o, &problem.y[o], Part::All));
                self.noise[o].std / spread.max(self.noise[o].std)
            })
            .collect();
        let share = median(&shares);
        let entries = &base.sources.entries[..base.sources.named];
        let mut taken: Vec<usize> = (0..entries.len())
            .filter(|&e| matches!(entries[e].1, Origin::Input(_) | Origin::Output(_)))
            .collect();
        let mut sensors = vec![];
        for (entry, (signal, origin)) in entries.iter().enumerate() {
            let own = matches!(origin, Origin::Own(_) | Origin::State(_));
            let size = deviation(nominal.series(entry));
            if own && size > 0.0 && !taken.iter().any(|&t| base.rates.same(t, entry)) {
                taken.push(entry);
                let (name, unit) = (signal.name.clone(), signal.unit.clone());
                sensors.push(Sensor { name, unit, entry, noise: share * size });
            }
        }
        sensors
    }
}
