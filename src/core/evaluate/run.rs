//! A system and a record, compiled: inputs, starts, tracks.

use super::error::EvaluateError;
use crate::data::Record;
use crate::model::Signals;
use crate::optimise::{Levenberg, Settings, Unknown};
use crate::statistics::gross;
use crate::system::{Drive, Lane, Plan, System, Track};

/// Share of a start's influence at which it counts as forgotten.
const FORGOTTEN: f64 = 1e-3;
/// Share of a record that may go into finding the start.
const MOST: f64 = 0.1;

/// The inputs of a record in the order of a model.
pub fn drive(signals: &Signals, record: &Record) -> Result<Drive, EvaluateError> {
    let names = |signals: &[crate::data::Signal]| signals.iter().map(|s| s.name.clone()).collect();
    let mut inputs = vec![];
    for (i, input) in signals.inputs.iter().enumerate() {
        let by_name = record.inputs.iter().find(|s| s.name == input.name);
        // a library user's record may use other names in the same order
        let by_position =
            (record.inputs.len() == signals.inputs.len()).then(|| record.inputs.get(i)).flatten();
        let found = by_name.or(by_position).ok_or_else(|| EvaluateError::NoSignal {
            record: record.source.clone(),
            role: "input",
            name: input.name.clone(),
            known: names(&record.inputs),
        })?;
        inputs.push(found.values.clone());
    }
    Ok(Drive {
        inputs,
        segments: record.segments.clone(),
        clocks: vec![record.start; record.segments.len()],
    })
}

/// The measured outputs of a record in the order of a model; `None` where not measured.
pub fn measured(signals: &Signals, record: &Record) -> Vec<Option<Vec<f64>>> {
    let by_position = record.outputs.len() == signals.outputs.len();
    signals
        .outputs
        .iter()
        .enumerate()
        .map(|(i, output)| {
            let by_name = record.outputs.iter().find(|s| s.name == output.name);
            by_name.or(record.outputs.get(i).filter(|_| by_position)).map(|s| s.values.clone())
        })
        .collect()
}

/// How many samples the initial state is estimated from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Init {
    /// Until the start's influence on the outputs is below 1e-3, at most 10 % of the record.
    #[default]
    Forgotten,
    /// This many; 0 holds the model's `initial`.
    Samples(usize),
}

/// A system and a record, compiled.
pub struct Run<'a> {
    pub system: &'a System,
    pub plan: Plan,
    pub drive: Drive,
    pub measured: Vec<Option<Vec<f64>>>,
    /// Rows of gross errors in what was measured, which no start is fitted to.
    gross: Vec<Vec<usize>>,
}

impl<'a> Run<'a> {
    pub fn new(system: &'a System, record: &Record) -> Result<Self, EvaluateError> {
        let signals = system.signals();
        let needed = 2 * signals.states.len().max(1);
        if record.len() < needed {
            return Err(EvaluateError::TooShort {
                record: record.source.clone(),
                samples: record.len(),
                needed,
            });
        }
        let step = record.sampling_time;
        if let (false, Some(own)) = (signals.time.is_continuous(), system.sampling.sampling_time)
            && (step - own).abs() > 0.01 * own
        {
            return Err(EvaluateError::Step {
                record: record.source.clone(),
                record_step: step,
                model_step: own,
            });
        }
        let plan = system.plan(system.sampling_time(Some(step))?)?;
        let measured = measured(&plan.signals, record);
        Ok(Self {
            drive: drive(&plan.signals, record)?,
            gross: measured.iter().map(|y| y.as_deref().map_or(vec![], gross)).collect(),
            measured,
            plan,
            system,
        })
    }

    /// The drive of the first `most` samples of every segment.
    pub fn first(&self, most: usize) -> Drive {
        let mut drive = self.drive.clone();
        for segment in &mut drive.segments {
            segment.end = segment.end.min(segment.start.saturating_add(most));
        }
        drive
    }

    /// The parameters of the system, from given initial states, one per segment.
    pub fn lane(&self, starts: Vec<Vec<f64>>) -> Lane {
        Lane {
            theta: self.plan.signals.theta(),
            effect_values: self.plan.effect_values(),
            starts,
            ..Lane::default()
        }
    }

    /// The free run from given initial states, one per segment.
    pub fn track(&self, starts: Vec<Vec<f64>>) -> Track {
        self.system.run(&self.plan, &self.drive, &[self.lane(starts)]).swap_remove(0)
    }

    /// Samples after which the start does not matter any more.
    pub fn init_samples(&self, init: Init) -> usize {
        let n = self.drive.len();
        match init {
            Init::Samples(count) => count.min(n),
            Init::Forgotten => {
                let most = ((MOST * n as f64) as usize).max(1).min(n);
                let reached = self.memory(2 * most);
                reached
                    .clamp(2 * self.plan.sizes.x.max(1), most.max(2 * self.plan.sizes.x.max(1)))
                    .min(n)
            }
        }
    }

    /// Samples until a change of the first initial state has faded, looking over `within`.
    pub fn memory(&self, within: usize) -> usize {
        let n = self.plan.sizes.x;
        let initial = self.plan.signals.initial();
        let Some(first) = self.drive.segments.first() else { return 0 };
        let end = (first.start + within).min(first.end);
        let drive = Drive {
            inputs: self.drive.inputs.iter().map(|u| u[..end].to_vec()).collect(),
            segments: std::iter::once(first.start..end).collect(),
            clocks: self.drive.clocks[..1].to_vec(),
        };
        let mut lanes = vec![self.lane(vec![initial.clone()])];
        for i in 0..n {
            let mut x = initial.clone();
            x[i] += 1e-3 * if x[i] == 0.0 { 1.0 } else { x[i].abs() };
            lanes.push(self.lane(vec![x]));
        }
        let tracks = self.system.run(&self.plan, &drive, &lanes);
        let mut reached = 0;
        for moved in &tracks[1..] {
            for (a, b) in tracks[0].y.iter().zip(&moved.y) {
                let off: Vec<f64> = (first.start..end).map(|k| (a[k] - b[k]).abs()).collect();
                let largest =
                    off.iter().fold(0.0, |m: f64, v| if v.is_finite() { m.max(*v) } else { m });
                let last = off.iter().rposition(|v| !(*v <= FORGOTTEN * largest));
                if largest > 0.0 {
                    reached = reached.max(last.map_or(0, |k| k + 1));
                }
            }
        }
        reached
    }

    /// Initial states of all segments, each fitted to its first `count` samples.
    pub fn starts(&self, count: usize) -> Vec<Vec<f64>> {
        let initial = self.plan.signals.initial();
        let segments = &self.drive.segments;
        if count == 0 || !self.measured.iter().any(Option::is_some) {
            return vec![initial; segments.len()];
        }
        segments
            .iter()
            .zip(&self.drive.clocks)
            .map(|(segment, &clock)| self.start_of(segment.clone(), clock, count))
            .collect()
    }

    fn start_of(&self, segment: std::ops::Range<usize>, clock: f64, count: usize) -> Vec<f64> {
        self.start_from(segment, clock, count, self.plan.signals.initial())
    }

    /// The initial state of a segment, fitted to its first `count` samples from a guess.
    pub(super) fn start_from(
        &self,
        segment: std::ops::Range<usize>,
        clock: f64,
        count: usize,
        guess: Vec<f64>,
    ) -> Vec<f64> {
        let initial = self.plan.signals.initial();
        let end = (segment.start + count).min(segment.end);
        let drive = Drive {
            inputs: self.drive.inputs.iter().map(|u| u[..end].to_vec()).collect(),
            segments: std::iter::once(segment.start..end).collect(),
            clocks: vec![clock],
        };
        let (course, track) = self.course(&drive, &initial);
        let reach = self.reach(&drive, &initial, &track);
        let scales = course.iter().zip(&reach).map(|(course, reach)| course.max(reach.abs()));
        let scales: Vec<f64> = scales.map(|size| if size > 0.0 { size } else { 1.0 }).collect();
        let unknowns = initial
            .iter()
            .zip(&guess)
            .zip(&scales)
            // far away only if the data insist: unseen states stay where they were
            .map(|((&x, &guess), &s)| Unknown::new(guess, 0.1 * s).expected(x, 100.0 * s));
        let settings = Settings { iterations: 40, tolerance: 1e-10, difference: 1e-4 };
        let mut fit = Levenberg::new(unknowns.collect(), settings);
        while !fit.is_done() {
            let lanes: Vec<Lane> = fit.propose().into_iter().map(|x| self.lane(vec![x])).collect();
            let answers = self
                .system
                .run(&self.plan, &drive, &lanes)
                .into_iter()
                .map(|track| track.is_finite().then(|| self.residuals(&track, segment.start..end)))
                .collect();
            fit.absorb(answers);
        }
        fit.point
    }

    /// Sizes of the states: their initial values, their course, or 1.
    pub(super) fn state_scales(&self, drive: &Drive, initial: &[f64]) -> Vec<f64> {
        let (sizes, _) = self.course(drive, initial);
        sizes.into_iter().map(|size| if size > 0.0 { size } else { 1.0 }).collect()
    }

    /// Sizes of the states from their initial values and their course, 0 where both are, and the
    /// simulation that shows it.
    fn course(&self, drive: &Drive, initial: &[f64]) -> (Vec<f64>, Track) {
        use crate::system::Origin;
        let seen = self.system.run_seen(&self.plan, drive, &self.lane(vec![initial.to_vec()]));
        let sizes = (0..initial.len()).map(|i| {
            let entry = self.plan.sources.at(Origin::State(i));
            let course = entry.map_or(&[][..], |e| &seen.seen[e][..]);
            let finite = course.iter().filter(|v| v.is_finite());
            let (mut low, mut high) = (initial[i], initial[i]);
            for &v in finite {
                (low, high) = (low.min(v), high.max(v));
            }
            (high - low).max(initial[i].abs())
        });
        (sizes.collect(), seen)
    }

    fn residuals(&self, track: &Track, range: std::ops::Range<usize>) -> Vec<f64> {
        let mut r = vec![];
        for ((y, gross), simulated) in self.measured.iter().zip(&self.gross).zip(&track.y) {
            let Some(y) = y else { continue };
            let usable = |k: &usize| y[*k].is_finite() && gross.binary_search(k).is_err();
            let known: Vec<f64> =
                range.clone().filter(usable).map(|k| y[k] - simulated[k]).collect();
            // outputs of different unit count by their own spread
            let values: Vec<f64> = range.clone().filter(usable).map(|k| y[k]).collect();
            let centre = values.iter().sum::<f64>() / values.len().max(1) as f64;
            let spread = (values.iter().map(|v| (v - centre).powi(2)).sum::<f64>()
                / values.len().max(1) as f64)
                .sqrt();
            let over = if spread > 0.0 && self.measured.len() > 1 { 1.0 / spread } else { 1.0 };
            r.extend(known.iter().map(|v| v * over));
        }
        r
    }
}
