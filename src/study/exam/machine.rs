//! Hides effects of a wanted size in a machine and makes its records.

use super::disturbed::Disturbance;
use super::{Case, Concealed, Machine};
use crate::StudyError;
use crate::data::{Random, Record, noise};
use crate::digits::number;
use crate::effect::EffectParameter;
use crate::evaluate::Run;
use crate::generate::{apart, deviation, rms, seed_of};
use crate::model::with_parameters;
use crate::system::{MOST_SUBSTEPS, Placed, System};

/// How far half the step may move the simulation with what is hidden, as a share of the noise;
/// and how many times as far as it moves the one without.
const STEADY: f64 = 0.1;
const TIMES: f64 = 2.0;

/// What belongs to one case.
pub(super) struct Made {
    /// What is handed to the diagnosis.
    pub baseline: System,
    /// The truth.
    pub machine: System,
    /// The records to diagnose.
    pub records: Vec<Record>,
    /// A third record without noise, of another input.
    pub third: Record,
}

impl Machine {
    /// Checks that every effect can be where it is to be hidden.
    pub(super) fn check(&self, system: &System) -> Result<(), StudyError> {
        let sampling_time = system.sampling_time(self.sampling_time)?;
        for concealed in &self.concealed()? {
            let mut machine = system.clone();
            machine.effects.extend(concealed.grown(1.0, system)?);
            machine.plan(sampling_time)?;
        }
        Ok(())
    }

    /// A driven record without outputs.
    fn driven(&self, system: &System, samples: usize, seed: u64) -> Result<Record, StudyError> {
        let sampling_time = system.sampling_time(self.sampling_time)?;
        let all = samples + self.transient;
        let mut record = Record::new(sampling_time);
        for (i, input) in system.signals().inputs.iter().enumerate() {
            let excitation = self.inputs.get(&input.name).unwrap_or(&self.excitation);
            let offset = self.offset.get(&input.name).copied().unwrap_or(0.0);
            let mut u = excitation.generate(all, sampling_time, seed_of(seed, 0, i as u64))?;
            u.iter_mut().for_each(|u| *u += offset);
            record = record.input(&input.name, u)?;
        }
        Ok(record)
    }

    /// What a system makes of an input; `None` if it diverges.
    fn outputs(&self, of: &System, driven: &Record) -> Result<Option<Vec<Vec<f64>>>, StudyError> {
        let mut run = Run::new(of, driven)?;
        // the record begins after the transient, and there its time is 0
        run.drive.clocks.fill(-(self.transient as f64) * driven.sampling_time);
        let track = run.track(run.starts(0));
        let cut = |y: Vec<f64>| y[self.transient..].to_vec();
        Ok(track.diverged_at.is_none().then(|| track.y.into_iter().map(cut).collect()))
    }

    fn measured(
        &self,
        driven: &Record,
        of: &System,
        y: Vec<Vec<f64>>,
    ) -> Result<Record, StudyError> {
        let mut record = driven.slice(self.transient..driven.len());
        record.start = 0.0;
        for (signal, y) in of.signals().outputs.iter().zip(y) {
            record = record.output(&signal.name, y)?;
        }
        Ok(record)
    }

    /// Everything of a case.
    pub(super) fn make(&self, truth: &System, case: &Case, seed: u64) -> Result<Made, StudyError> {
        let own = seed_of(apart(seed), case.seed, case.system as u64);
        let samples = case.conditions.samples;
        let driven = self.driven(truth, samples, own)?;
        let diverges = || StudyError::Diverges { sample: 0 };
        let base = self.outputs(truth, &driven)?.ok_or_else(diverges)?;
        let sigma = |y: &Vec<f64>| deviation(y) * 10f64.powf(-case.conditions.snr_db / 20.0);
        let sigmas: Vec<f64> = base.iter().map(sigma).collect();
        let (mut machine, all) = (truth.clone(), self.concealed()?);
        for &hidden in &case.hidden {
            let grown = self.sized(&all[hidden], truth, &driven, &base, &sigmas, case.g)?;
            machine.effects.push(grown);
            if let Some(outside) = hidden.checked_sub(self.hidden.len()) {
                machine.written.push(self.outside[outside].written()?);
            }
        }
        let y = self.outputs(&machine, &driven)?.ok_or_else(diverges)?;
        self.check_steps(case, (truth, &base), (&machine, &y), &driven, &sigmas)?;
        let mut records = vec![self.taken(case, (truth, &machine), &driven, y, &sigmas, own)?];
        for number in 1..case.conditions.records {
            let own = seed_of(own, 10 + number as u64, 0);
            let driven = self.driven(truth, samples, own)?;
            let y = self.outputs(&machine, &driven)?.ok_or_else(diverges)?;
            records.push(self.taken(case, (truth, &machine), &driven, y, &sigmas, own)?);
        }
        let other = self.driven(truth, samples, seed_of(own, 2, 0))?;
        let y = self.outputs(&machine, &other)?.ok_or_else(diverges)?;
        let third = self.measured(&other, truth, y)?;
        Ok(Made { baseline: off(truth, case, own)?, machine, records, third })
    }

    /// One record as it is taken: disturbed, by noisy sensors, of inputs that are not known exactly.
    fn taken(
        &self,
        case: &Case,
        (truth, machine): (&System, &System),
        driven: &Record,
        mut y: Vec<Vec<f64>>,
        sigmas: &[f64],
        own: u64,
    ) -> Result<Record, StudyError> {
        let at = &case.conditions;
        let onset = at.onset > 0.0 && !case.hidden.is_empty();
        if onset || at.process_noise > 0.0 {
            let forces = self.forces(truth, driven, sigmas, at.process_noise, own)?;
            let sample = self.transient + (at.onset * at.samples as f64) as usize;
            let before = onset.then_some((truth, sample));
            let disturbed =
                self.outputs_disturbed(machine, driven, &Disturbance { before, forces })?;
            y = disturbed.ok_or(StudyError::Diverges { sample: 0 })?;
        }
        let noisy = y.into_iter().zip(sigmas).enumerate();
        let noisy =
            noisy.map(|(o, (y, &sigma))| at.noise.measured(y, sigma, seed_of(own, 1, o as u64)));
        let mut record = self.measured(driven, truth, noisy.collect::<Result<_, _>>()?)?;
        if at.input_noise > 0.0 {
            for (i, input) in record.inputs.iter_mut().enumerate() {
                let sigma = at.input_noise * deviation(&input.values);
                let e = noise::white(input.values.len(), sigma, seed_of(own, 5, i as u64))?;
                input.values.iter_mut().zip(e).for_each(|(u, e)| *u += e);
            }
        }
        Ok(record)
    }

    /// Checks that what is hidden is the machine's and not the integrator's: a law that is too
    /// steep for the step gives another record with steps half as long.
    fn check_steps(
        &self,
        case: &Case,
        bare: (&System, &[Vec<f64>]),
        guilty: (&System, &[Vec<f64>]),
        driven: &Record,
        sigmas: &[f64],
    ) -> Result<(), StudyError> {
        let moves = |(system, y): (&System, &[Vec<f64>])| -> Result<Vec<f64>, StudyError> {
            let mut finer = system.clone();
            let substeps = &mut finer.sampling.integrator.substeps;
            *substeps = (2 * *substeps).min(MOST_SUBSTEPS);
            let Some(finer) = self.outputs(&finer, driven)? else {
                return Ok(vec![f64::INFINITY; y.len()]);
            };
            Ok(finer.iter().zip(y).map(|(a, b)| rms(&difference(a, b))).collect())
        };
        let (with, without) = (moves(guilty)?, moves(bare)?);
        let mut moved = with.iter().zip(without).zip(sigmas);
        if moved.all(|((with, without), sigma)| *with <= (STEADY * sigma).max(TIMES * without)) {
            return Ok(());
        }
        let sizes = |p: &Placed| -> String {
            let parameters = p.effect.card().parameters;
            let one = |k: &EffectParameter| format!("{} = {}", k.name, number(k.value, None));
            parameters.iter().map(one).collect::<Vec<_>>().join(", ")
        };
        let hidden = guilty.0.effects[bare.0.effects.len()..].iter();
        let hidden = hidden.map(|p| format!("{} ({})", p.effect.typetag_name(), sizes(p)));
        Err(StudyError::Unresolved {
            case: case.number,
            hidden: hidden.collect::<Vec<_>>().join(" + "),
        })
    }

    /// A hidden effect so large that it makes the residual 1 + g times the noise.
    fn sized(
        &self,
        concealed: &Concealed,
        truth: &System,
        driven: &Record,
        base: &[Vec<f64>],
        sigmas: &[f64],
        g: f64,
    ) -> Result<Placed, StudyError> {
        let want = ((1.0 + g).powi(2) - 1.0).sqrt();
        let size = |factor: f64| -> Result<f64, StudyError> {
            let Some(placed) = concealed.grown(factor, truth)? else {
                return Ok(f64::INFINITY);
            };
            let mut machine = truth.clone();
            machine.effects.push(placed);
            let Some(y) = self.outputs(&machine, driven)? else { return Ok(f64::INFINITY) };
            let of = |(o, y): (usize, &Vec<f64>)| rms(&difference(y, &base[o])) / sigmas[o];
            Ok(y.iter().enumerate().map(of).fold(0.0, f64::max))
        };
        let (mut low, mut high) = (1e-7, 1.0);
        while size(high)? < want {
            high *= 2.0;
            if high > 1e7 {
                let found = format!("{} at g = {g}", concealed.name());
                return Err(StudyError::setting("hidden", found, "an effect that can be so large"));
            }
        }
        for _ in 0..40 {
            let middle = f64::sqrt(low * high);
            if size(middle)? < want { low = middle } else { high = middle }
        }
        let placed = concealed.grown(low, truth)?;
        placed.ok_or_else(|| StudyError::setting("hidden", concealed.name(), "a possible effect"))
    }
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

/// The model that is handed out: its free parameters off by a share, up or down by lot.
fn off(truth: &System, case: &Case, seed: u64) -> Result<System, StudyError> {
    if case.conditions.parameter_error == 0.0 {
        return Ok(truth.clone());
    }
    let mut random = Random::new(seed_of(seed, 3, 0));
    let signals = truth.signals();
    let changes: Vec<(String, f64)> = signals
        .parameters
        .iter()
        .filter(|p| !p.fixed)
        .map(|p| {
            let sign = if random.uniform() < 0.5 { -1.0 } else { 1.0 };
            (
                p.name.clone(),
                (p.value * (1.0 + sign * case.conditions.parameter_error)).clamp(p.min, p.max),
            )
        })
        .collect();
    let model = with_parameters(truth.model.as_ref(), &changes)
        .map_err(|e| StudyError::setting("parameter_error", e, "values that the model takes"))?;
    let (written, effects) = (truth.written.clone(), truth.effects.clone());
    Ok(System { sampling: truth.sampling, model, written, effects })
}
