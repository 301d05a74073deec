//! How far ahead a free run says anything: how fast two runs from nearly the same state part.

use rayon::prelude::*;

use super::run::Run;
use crate::system::{Drive, Origin};

/// Relative size of the change of a start.
const NUDGE: f64 = 1e-7;
/// Growth of an error in the start that a fitted stretch can bear.
const BEARABLE: f64 = 100.0;
/// Growth from one length of stretches to twice that length which no integrator shows, and which
/// differences in the size of states cannot feign.
const EXPONENTIAL: f64 = 4.0;
/// Samples of the shortest stretch, and of the longest that is asked.
const SHORTEST: usize = 20;
const LONGEST: usize = 1280;
/// Stretches of one length that are asked how fast runs part in them.
const ASKED: usize = 8;

impl Run<'_> {
    /// Largest change of any state, in units of its size, that a small change of the start has
    /// made up to each sample of a stretch, in units of that change.
    fn growth(&self, range: std::ops::Range<usize>, clock: f64, start: &[f64]) -> Vec<f64> {
        let drive = Drive {
            inputs: self.drive.inputs.iter().map(|u| u[..range.end].to_vec()).collect(),
            segments: std::iter::once(range.clone()).collect(),
            clocks: vec![clock],
        };
        let scales = self.state_scales(&drive, start);
        let states = |x: &[f64]| {
            let seen = self.system.run_seen(&self.plan, &drive, &self.lane(vec![x.to_vec()])).seen;
            let entries = (0..x.len()).map(|i| self.plan.sources.at(Origin::State(i)));
            let own = |e: Option<usize>| e.map(|e| seen[e][range.clone()].to_vec());
            entries.map(own).collect::<Option<Vec<_>>>().unwrap_or_default()
        };
        let from = states(start);
        let mut grown = vec![0.0_f64; range.len()];
        for i in 0..start.len() {
            let mut moved = start.to_vec();
            moved[i] += NUDGE * scales[i];
            for ((a, b), scale) in from.iter().zip(states(&moved)).zip(&scales) {
                for ((grown, a), b) in grown.iter_mut().zip(a).zip(b) {
                    let apart = (b - a).abs() / (NUDGE * scale);
                    *grown = if apart.is_finite() { grown.max(apart) } else { f64::NAN };
                }
            }
        }
        // what left the finite numbers grows no more
        let known = grown.iter().take_while(|g| g.is_finite()).count();
        grown.truncate(known);
        let mut most = 1.0_f64;
        for grown in &mut grown {
            most = most.max(*grown);
            *grown = most;
        }
        grown
    }

    /// The initial state of a stretch, fitted to more and more of it: all at once, the cost has
    /// many minima where runs part.
    fn patient_start(&self, stretch: std::ops::Range<usize>, clock: f64) -> Vec<f64> {
        let mut start = self.plan.signals.initial();
        let mut count = SHORTEST;
        loop {
            start = self.start_from(stretch.clone(), clock, count, start);
            if count >= stretch.len() {
                return start;
            }
            count *= 2;
        }
    }

    /// Initial states of all segments, each fitted to all of it.
    pub fn starts_of_stretches(&self) -> Vec<Vec<f64>> {
        let segments = self.drive.segments.iter().zip(&self.drive.clocks);
        segments.map(|(segment, &clock)| self.patient_start(segment.clone(), clock)).collect()
    }

    /// Growth along stretches of a length, each from a start fitted to it so that it stays near
    /// the data, and followed for `reach` samples.
    fn grown(
        &self,
        (segment, clock): (&std::ops::Range<usize>, f64),
        length: usize,
        reach: usize,
    ) -> Vec<Vec<f64>> {
        let step = ((segment.len() - reach) / ASKED).max(1);
        (segment.start..=segment.end - reach)
            .step_by(step)
            .map(|from| {
                let own = self.patient_start(from..from + length, clock);
                self.growth(from..from + reach, clock, &own)
            })
            .collect()
    }

    /// Samples of the longest stretch over which a start can be fitted, if errors of the start
    /// grow exponentially; `None` where a free run over the whole record makes sense.
    ///
    /// What grows like a power of time, as an integrator's offset does, hardly grows in units of
    /// how far the states move meanwhile; an unstable or chaotic system's error multiplies.
    pub fn horizon(&self) -> Option<usize> {
        let segments = self.drive.segments.iter().zip(&self.drive.clocks);
        let (segment, clock) = segments.max_by_key(|(s, _)| s.len())?;
        let (segment, clock) = (segment.clone(), *clock);
        let shortest = SHORTEST.max(5 * self.plan.sizes.x);
        let longest = segment.len() / 4;
        let quantile = |mut sorted: Vec<f64>, at: f64| {
            sorted.sort_by(f64::total_cmp);
            sorted.get((at * sorted.len() as f64) as usize).copied()
        };
        let reach = longest.min(LONGEST);
        if reach < shortest {
            return None;
        }
        let step = ((segment.len() - reach) / ASKED).max(1);
        let places: Vec<usize> =
            (segment.start..=segment.end - reach).step_by(step).take(ASKED).collect();
        let mut starts = vec![self.plan.signals.initial(); places.len()];
        let (mut length, mut before) = (shortest, f64::INFINITY);
        loop {
            let follow = |(&from, start): (&usize, &mut Vec<f64>)| {
                let stretch = from..from + length;
                let guess = std::mem::take(start);
                *start = self.start_from(stretch.clone(), clock, length, guess);
                self.growth(stretch, clock, start).last().copied()
            };
            let ends: Vec<Option<f64>> = places.par_iter().zip(&mut starts).map(follow).collect();
            let grown = quantile(ends.into_iter().flatten().collect(), 0.5)?;
            if grown > BEARABLE && grown > EXPONENTIAL * before {
                break;
            }
            // what grows too slowly to come that far is not asked any further
            let enough = BEARABLE.powf(length as f64 / reach as f64);
            (length, before) = (2 * length, grown);
            if grown < enough || length > reach {
                return None;
            }
        }
        for _ in 0..2 {
            let reach = (2 * length).min(segment.len());
            let within = self.grown((&segment, clock), length, reach).into_iter().map(|grown| {
                grown.iter().position(|g| *g > BEARABLE).unwrap_or(grown.len()) as f64
            });
            // three stretches of four bear that length
            length = (quantile(within.collect(), 0.25)? as usize).clamp(shortest, longest);
        }
        Some(length)
    }

    /// Cuts the record into stretches of a length, each with a start of its own; `most` of them,
    /// spread over it, are kept.
    pub fn cut(&mut self, length: usize, most: usize) {
        let whole = self.drive.segments.iter().zip(&self.drive.clocks);
        let all: Vec<(std::ops::Range<usize>, f64)> = whole
            .flat_map(|(segment, &clock)| {
                let starts = segment.clone().step_by(length.max(1));
                starts.map(move |from| (from..(from + length).min(segment.end), clock))
            })
            .collect();
        let every = all.len().div_ceil(most.max(1)).max(1);
        (self.drive.segments, self.drive.clocks) = all.into_iter().step_by(every).unzip();
    }

    /// Name and series of every output, simulated in stretches of a length, each from a start of
    /// its own; not a number where nothing can be simulated.
    pub fn in_stretches(mut self, length: usize) -> Vec<(String, Vec<f64>)> {
        self.cut(length, usize::MAX);
        let track = self.track(self.starts_of_stretches());
        let names = self.plan.signals.outputs.iter().map(|s| s.name.clone());
        names.zip(track.y).collect()
    }
}

#[cfg(test)]
mod tests {
    use crate::data::Record;
    use crate::evaluate::Run;
    use crate::file::Format;
    use crate::system::System;

    fn horizon(derivatives: [&str; 2], step: f64) -> Option<usize> {
        let [p, v] = derivatives;
        let text = format!(
            "sampling_time = {step}\nintegrator = {{ method = \"rk4\", substeps = 2 }}\n\
             [model.equations]\ninputs = [{{ name = \"u\" }}]\nstates = [{{ name = \"p\", derivative = \"{p}\" }}, \
             {{ name = \"v\", derivative = \"{v}\" }}]\noutputs = [{{ name = \"y\", value = \"p\" }}]\n"
        );
        let system: System = crate::file::parse(&text, "test.toml", Format::Toml).unwrap();
        let u: Vec<f64> = (0..1500).map(|k| (k as f64 * 0.07).sin()).collect();
        let record = Record::new(step).input("u", u).unwrap();
        // near 0, as a controller would hold it
        let record = record.output("y", vec![0.0; 1500]).unwrap();
        Run::new(&system, &record).unwrap().horizon()
    }

    #[test]
    fn what_forgets_or_integrates_needs_no_stretches() {
        assert_eq!(horizon(["v", "u - 100*p - v"], 0.02), None);
        assert_eq!(horizon(["v", "u"], 0.02), None);
        assert_eq!(horizon(["v", "u - 0.001*v"], 0.1), None);
    }

    #[test]
    fn what_falls_over_is_cut() {
        // errors grow as exp(5 t): by a hundred in 0.92 s
        let length = horizon(["v", "u + 25*p"], 0.02).unwrap();
        assert!((35..70).contains(&length), "{length}");
    }
}
