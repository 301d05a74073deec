//! Residuals of an output-error fit, many points at once in the lanes of one simulation.

use rayon::prelude::*;

use super::{Fit, Key};
use crate::optimise::{Levenberg, Settings, Unknown};
use crate::system::Lane;

impl Fit<'_> {
    /// Parameters of effects at a point, friction that is fitted no steeper than the integrator follows.
    pub(super) fn effect_values(&self, point: &[f64]) -> Vec<f64> {
        let mut values = self.runs[0].plan.effect_values();
        for (&key, &value) in self.keys.iter().zip(point) {
            if let Key::EffectParameter(k) = key {
                values[k] = value;
            }
        }
        for steep in &self.steep {
            values[steep.width] = values[steep.width].max(steep.least(&values));
        }
        values
    }

    pub(super) fn lane(&self, point: &[f64], r: usize) -> Lane {
        let run = &self.runs[r];
        let mut lane = Lane {
            theta: run.plan.signals.theta(),
            effect_values: self.effect_values(point),
            starts: vec![run.plan.signals.initial(); run.drive.segments.len()],
            ..Lane::default()
        };
        for (&key, &value) in self.keys.iter().zip(point) {
            match key {
                Key::Theta(p) => lane.theta[p] = value,
                Key::Start(of, s, i) if of == r => lane.starts[s][i] = value,
                Key::EffectParameter(_) | Key::Start(..) => {}
            }
        }
        lane
    }

    /// Residuals of many points, over the first `most` samples of every record.
    pub(super) fn residuals(&self, points: &[Vec<f64>], most: usize) -> Vec<Option<Vec<f64>>> {
        let chunks: Vec<&[Vec<f64>]> = points.chunks(16).collect();
        chunks
            .into_par_iter()
            .flat_map_iter(|points| {
                let mut all: Vec<Option<Vec<f64>>> = vec![Some(vec![]); points.len()];
                for (r, run) in self.runs.iter().enumerate() {
                    let lanes: Vec<Lane> = points.iter().map(|p| self.lane(p, r)).collect();
                    let drive = run.first(most);
                    let tracks = self.system.run(&run.plan, &drive, &lanes);
                    for (all, track) in all.iter_mut().zip(tracks) {
                        if !track.is_finite() {
                            *all = None;
                        }
                        let Some(all) = all else { continue };
                        for (o, measured) in run.measured.iter().enumerate() {
                            let Some(measured) = measured else { continue };
                            let over = 1.0 / self.spreads[o];
                            let known = drive.segments.iter().cloned().flatten();
                            all.extend(
                                known
                                    .filter(|&k| measured[k].is_finite())
                                    .map(|k| (measured[k] - track.y[o][k]) * over),
                            );
                        }
                    }
                }
                all
            })
            .collect()
    }

    /// Runs the method from several points at once.
    pub(super) fn run(
        &self,
        points: &[Vec<f64>],
        settings: Settings,
        most: usize,
    ) -> Vec<Levenberg> {
        let mut fits: Vec<Levenberg> = points
            .iter()
            .map(|point| {
                let start = |(u, &value): (&Unknown, &f64)| Unknown { start: value, ..*u };
                Levenberg::new(self.unknowns.iter().zip(point).map(start).collect(), settings)
            })
            .collect();
        loop {
            let proposals: Vec<Vec<Vec<f64>>> = fits.iter_mut().map(Levenberg::propose).collect();
            let all: Vec<Vec<f64>> = proposals.iter().flatten().cloned().collect();
            if all.is_empty() || self.watch.stopped() {
                return fits;
            }
            let mut answers = self.residuals(&all, most).into_iter();
            for (fit, proposal) in fits.iter_mut().zip(&proposals) {
                let own: Vec<_> = answers.by_ref().take(proposal.len()).collect();
                if !proposal.is_empty() {
                    fit.absorb(own);
                }
            }
        }
    }
}
