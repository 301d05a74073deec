//! Hides an effect in a machine, makes its records, and reads what a diagnosis says.
#![allow(dead_code, unused_macros)]

pub mod plants;

use lacuna::data::{Lines, Multisine, Phases, Record, noise};
use lacuna::diagnose::{Cause, Diagnosis, Finding};
use lacuna::evaluate::{Init, Simulation};
use lacuna::file::{Format, parse};
use lacuna::system::System;

/// A machine to hide things in.
pub struct Plant {
    pub name: &'static str,
    /// Model file.
    pub model: &'static str,
    pub sampling_time: f64,
    /// Mean, RMS and highest frequency (share of the sampling rate) of the input.
    pub input: (f64, f64, f64),
    /// Samples that let the start fade.
    pub warm_up: usize,
}

/// One hidden effect: its name and place, and its table as a function of its size.
pub struct Hidden {
    pub effect: &'static str,
    pub into: &'static str,
    pub of: Option<&'static str>,
    pub table: fn(f64) -> String,
}

/// A hidden effect whose name and place stand in its table too.
macro_rules! hidden {
    ($effect:literal, $into:literal, $of:expr, $table:expr) => {
        $crate::exam::Hidden {
            effect: $effect,
            into: $into,
            of: $of,
            table: |s: f64| {
                let table: fn(f64) -> String = $table;
                $crate::exam::placed($into, $of, &format!("{} = {}", $effect, table(s)))
            },
        }
    };
}
#[allow(unused_imports)]
pub(crate) use hidden;

/// A table with a value.
pub fn value(value: f64) -> String {
    format!("{{ value = {value:?} }}")
}

/// A table with a coefficient.
pub fn coefficient(value: f64) -> String {
    format!("{{ coefficient = {value:?} }}")
}

/// What a machine's records look like.
#[derive(Clone, Copy)]
pub struct Conditions {
    pub n: usize,
    /// RMS of what the effect adds, against that of the noise: g = 1 makes the residual twice
    /// the noise.
    pub g: f64,
    pub snr_db: f64,
    /// Pole of the noise.
    pub colour: f64,
    pub seed: u64,
}

pub const USUAL: Conditions = Conditions { n: 4000, g: 1.0, snr_db: 20.0, colour: 0.0, seed: 1 };

impl Plant {
    pub fn system(&self) -> System {
        parse(self.model, self.name, Format::Toml).unwrap()
    }

    /// The machine with effects in it.
    pub fn with(&self, effects: &[String]) -> System {
        let text = self.model.to_string() + &effects.concat();
        parse(&text, self.name, Format::Toml).unwrap_or_else(|e| panic!("{}", e.pretty()))
    }

    fn excitation(&self, n: usize, seed: u64) -> Vec<f64> {
        let (mean, rms, share) = self.input;
        let count = n + self.warm_up;
        let lines = Lines::Full { from: 1, to: Some((share * count as f64) as usize) };
        let multisine =
            Multisine { period: count, lines, rms, phases: Phases::Random, crest_iterations: 0 };
        let u = multisine.generate(count, self.sampling_time, seed).unwrap();
        u.into_iter().map(|u| u + mean).collect()
    }

    /// What a machine makes of an input, its first samples left out.
    fn clean(&self, machine: &System, u: &[f64]) -> Option<Vec<Vec<f64>>> {
        let drive = Record::new(self.sampling_time)
            .input(&machine.signals().inputs[0].name, u.to_vec())
            .unwrap();
        let run = Simulation::of(machine, &drive, Init::Samples(0)).unwrap();
        let finite = run.diverged_at.is_none();
        finite.then(|| run.outputs.into_iter().map(|(_, y)| y[self.warm_up..].to_vec()).collect())
    }

    fn record(&self, u: &[f64], outputs: &[Vec<f64>]) -> Record {
        let signals = self.system().signals();
        let mut record = Record::new(self.sampling_time)
            .input(&signals.inputs[0].name, u[self.warm_up..].to_vec())
            .unwrap();
        for (signal, y) in signals.outputs.iter().zip(outputs) {
            record = record.output(&signal.name, y.clone()).unwrap();
        }
        record
    }

    /// A record without noise, of another input.
    pub fn third(&self, machine: &System, n: usize, seed: u64) -> Record {
        let u = self.excitation(n, seed + 7919);
        self.record(&u, &self.clean(machine, &u).unwrap())
    }

    fn noisy(&self, clean: &[Vec<f64>], base: &[Vec<f64>], c: Conditions) -> Vec<Vec<f64>> {
        let mut all = vec![];
        for (o, (y, y0)) in clean.iter().zip(base).enumerate() {
            let sigma = deviation(y0) * 10f64.powf(-c.snr_db / 20.0);
            let seed = c.seed * 100 + o as u64;
            let e = if c.colour == 0.0 {
                noise::white(y.len(), sigma, seed)
            } else {
                noise::ar1(y.len(), c.colour, sigma, seed)
            };
            all.push(y.iter().zip(e.unwrap()).map(|(y, e)| y + e).collect());
        }
        all
    }

    /// A record of the machine as it is modelled.
    pub fn innocent(&self, c: Conditions) -> Record {
        self.noisy_record(&self.system(), c)
    }

    /// A record of a machine.
    pub fn noisy_record(&self, machine: &System, c: Conditions) -> Record {
        let u = self.excitation(c.n, c.seed);
        let y = self.clean(machine, &u).unwrap();
        self.record(&u, &self.noisy(&y, &y, c))
    }

    /// A machine with effects whose sizes make the residual g noises large each, and its record.
    pub fn guilty(&self, hidden: &[&Hidden], c: Conditions) -> (System, Record) {
        let u = self.excitation(c.n, c.seed);
        let base = self.clean(&self.system(), &u).unwrap();
        let sigmas: Vec<f64> =
            base.iter().map(|y| deviation(y) * 10f64.powf(-c.snr_db / 20.0)).collect();
        let want = ((1.0 + c.g).powi(2) - 1.0).sqrt();
        let tables: Vec<String> = hidden
            .iter()
            .map(|hidden| {
                let size = |s: f64| {
                    let Some(y) = self.clean(&self.with(&[(hidden.table)(s)]), &u) else {
                        return f64::INFINITY;
                    };
                    let off = |(o, y): (usize, &Vec<f64>)| {
                        let d: Vec<f64> = y.iter().zip(&base[o]).map(|(a, b)| a - b).collect();
                        rms(&d) / sigmas[o]
                    };
                    y.iter().enumerate().map(off).fold(0.0, f64::max)
                };
                let (mut low, mut high) = (1e-7, 1.0);
                while size(high) < want && high < 1e6 {
                    high *= 2.0;
                }
                for _ in 0..40 {
                    let middle = f64::sqrt(low * high);
                    if size(middle) < want { low = middle } else { high = middle }
                }
                (hidden.table)(low)
            })
            .collect();
        let machine = self.with(&tables);
        let y = self.clean(&machine, &u).unwrap();
        let record = self.record(&u, &self.noisy(&y, &base, c));
        (machine, record)
    }

    /// Runs a diagnosis of the baseline.
    pub fn diagnose(&self, record: &Record) -> Finding {
        let system = self.system();
        Diagnosis::of(&system).run(std::slice::from_ref(record), None, &()).unwrap()
    }

    /// Share of the mean square removed on a record without noise.
    pub fn removed(&self, machine: &System, finding: &Finding, c: Conditions) -> f64 {
        let third = self.third(machine, c.n, c.seed);
        let off = |system: &System| -> f64 {
            let run = Simulation::of(system, &third, Init::Forgotten).unwrap();
            run.metrics.iter().map(|(_, m)| m.rmse * m.rmse).sum()
        };
        1.0 - off(&finding.extended) / off(&self.system())
    }
}

impl Hidden {
    /// Whether a cause is this one, or says that it cannot tell.
    pub fn is_named(&self, cause: &Cause) -> bool {
        let same = |e: &str, into: &str, of: Option<&str>| {
            e == self.effect && into == self.into && of == self.of
        };
        // a part of a sum of laws at one place is named too
        cause.holds(self.effect, self.into, self.of)
            || cause.indistinguishable.iter().any(|a| same(&a.effect, &a.into, a.of.as_deref()))
    }
}

/// An entry of a model file.
pub fn placed(into: &str, of: Option<&str>, effect: &str) -> String {
    let of = of.map_or_else(String::new, |of| format!("of = \"{of}\"\n"));
    format!("\n[[effects]]\ninto = \"{into}\"\n{of}effect.{effect}\n")
}

pub fn names(finding: &Finding) -> String {
    let causes = finding.causes.iter().map(|c| {
        let others: Vec<String> = c.indistinguishable.iter().map(ToString::to_string).collect();
        format!(
            "{}>{}<{} ({})",
            c.effect,
            c.into,
            c.of.as_deref().unwrap_or("-"),
            others.join(", ")
        )
    });
    causes.collect::<Vec<_>>().join(" + ")
}

pub fn rms(x: &[f64]) -> f64 {
    (x.iter().map(|v| v * v).sum::<f64>() / x.len() as f64).sqrt()
}

fn deviation(x: &[f64]) -> f64 {
    let mean = x.iter().sum::<f64>() / x.len() as f64;
    rms(&x.iter().map(|v| v - mean).collect::<Vec<_>>())
}

pub fn median(mut x: Vec<f64>) -> f64 {
    x.sort_by(f64::total_cmp);
    x[x.len() / 2]
}
