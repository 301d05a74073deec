//! How long one step of joint training takes: one JSON line per case.
//!
//! ```text
//! cargo bench --bench training_step
//! LACUNA_ISA=avx2 cargo bench --bench training_step
//! ```
//!
//! 3000 sections of 200 samples of the two-mass record of Hoekstra et al., RK4 in 10 steps
//! per sample, learned part and encoder with two layers of 16 units, 9 past samples: loss
//! and gradient of all 1172 weights. Times are processor time of this process, the least of
//! several runs. The oracle is the same task in plain nalgebra (`training/oracle.rs`), timed
//! on 150 sections in the same run and scaled.

#[path = "training/oracle.rs"]
mod oracle;
#[path = "training/peak.rs"]
mod peak;
#[path = "../paper_msd/record.rs"]
#[allow(dead_code)]
mod record;
#[path = "../paper_msd/without_adjoint.rs"]
mod without_adjoint;

use std::hint::black_box;
use std::time::Instant;

use lacuna::data::Record;
use lacuna::encoder::{Baseline as Known, ResNetEncoder, Spread, Window};
use lacuna::file::{Format, parse};
use lacuna::lfr::{Baseline, Block, Scales, Structure};
use lacuna::system::System;
use lacuna::train::{Arithmetic, Augmented, MultipleShooting, Shooting};
use serde_json::json;
use without_adjoint::WithoutAdjoint;

const SECTIONS: usize = 3000;
const LENGTH: usize = 200;
/// Operations of one sample of one section, forward and back, counted by hand: twice the
/// 420 weights of the learned part forward and four times on the way back (2.5 thousand),
/// its 32 tanh (0.8), Runge-Kutta forward (1.3), again and back (3.3).
const FLOP_PER_SAMPLE: f64 = 7.9e3;

/// The same physics typed as equations.
const EQUATIONS: &str = r#"
[model.equations]
inputs = [{ name = "u", unit = "N" }]
outputs = [{ name = "y", unit = "m", value = "p2" }]
states = [
  { name = "p1", unit = "m", derivative = "v1" },
  { name = "v1", unit = "m/s", derivative = "(u - first + second) / m1" },
  { name = "p2", unit = "m", derivative = "v2" },
  { name = "v2", unit = "m/s", derivative = "-second / m2" },
]
variables = [
  { name = "first", value = "k1*p1 + c1*v1 + d1*v1*v1*v1" },
  { name = "r", value = "p2 - p1" },
  { name = "second", value = "(k2 + a2*r*r)*r + c2*(v2 - v1)" },
]
parameters = [
  { name = "m1", value = 0.5 }, { name = "k1", value = 100.0 }, { name = "c1", value = 0.5 },
  { name = "d1", value = 0.05 }, { name = "m2", value = 0.4 }, { name = "k2", value = 100.0 },
  { name = "a2", value = 1000.0 }, { name = "c2", value = 0.5 },
]
"#;

fn system(kind: &str) -> System {
    match kind {
        "generic" => System::new(WithoutAdjoint(record::model(0.05)), record::sampling()),
        "equations" => {
            let mut system = parse(EQUATIONS, "equations", Format::Toml).unwrap();
            system.sampling = record::sampling();
            system
        }
        _ => record::system(0.05),
    }
}

fn pairs(spreads: &[Spread]) -> Vec<(f64, f64)> {
    spreads.iter().map(|s| (s.offset, s.scale)).collect()
}

/// Model and encoder with weights that are no longer 0.
fn augmented(system: System, record: &Record) -> Augmented {
    let known = Known::new(&system, record).unwrap();
    let mut encoder = ResNetEncoder::new(Window::past(9), &[16, 16]);
    known.prepare(&mut encoder, 3).unwrap();
    let scaling = known.scaling().unwrap();
    let scales = Scales {
        states: pairs(&scaling.states),
        inputs: pairs(&scaling.inputs),
        outputs: pairs(&scaling.outputs),
    };
    let baseline =
        Baseline { system: system.clone(), sampling_time: 0.1, free: vec![], theta: None };
    let mut model = Structure::default().build(baseline, &scales, 5).unwrap();
    let mut random = lacuna::data::Random::new(17);
    if let Block::Network(learned) = &mut model.blocks[1] {
        learned.net.weights_mut().iter_mut().for_each(|w| *w += 0.02 * random.normal());
    }
    Augmented::new(model, Box::new(encoder)).unwrap()
}

/// Processor time of this process, and time on the wall, of the fastest of several runs, ms.
fn least(runs: usize, mut work: impl FnMut()) -> (f64, f64) {
    let (mut cpu, mut wall) = (f64::INFINITY, f64::INFINITY);
    work();
    for _ in 0..runs {
        let (start, before) = (Instant::now(), peak::processor_seconds());
        work();
        cpu = cpu.min(peak::processor_seconds() - before);
        wall = wall.min(start.elapsed().as_secs_f64());
    }
    (1e3 * cpu, 1e3 * wall)
}

struct Step<'a> {
    loss: MultipleShooting<'a>,
    parameters: Vec<f64>,
    gradient: Vec<f64>,
}

impl<'a> Step<'a> {
    fn new(model: &'a Augmented, record: &Record, shooting: Shooting) -> Self {
        let records = std::slice::from_ref(record);
        let loss = MultipleShooting::new(model, records, shooting, &[1.0]).unwrap();
        let parameters = model.parameters();
        Self { gradient: vec![0.0; parameters.len()], parameters, loss }
    }

    /// Loss and gradient over sections spread over the record.
    fn run(&mut self, sections: usize) -> f64 {
        let all = self.loss.starts();
        let starts: Vec<usize> = (0..sections).map(|i| all[i * all.len() / sections]).collect();
        self.loss.loss(&self.parameters, &starts, Some(&mut self.gradient)).unwrap()
    }
}

fn oracle<'a>(model: &Augmented, u: &'a [f64], y: &'a [f64]) -> oracle::Oracle<'a> {
    let Block::Network(learned) = &model.model.blocks[1] else { panic!("no network") };
    let augmentation = oracle::Net::new(
        learned.net.weights(),
        [5, 16, 16, 4],
        learned.input_scales.clone(),
        learned.output_scales.clone(),
    );
    let scaling = model.encoder.scaling().unwrap();
    let rows = [vec![scaling.outputs[0]; 9], vec![scaling.inputs[0]; 9]].concat();
    let encoder = oracle::Net::new(
        model.encoder.weights(),
        [18, 16, 16, 4],
        pairs(&rows),
        pairs(&scaling.states),
    );
    let physics = oracle::TwoMasses {
        m: [0.5, 0.4],
        k: [100.0, 100.0],
        c: [0.5, 0.5],
        a: [0.0, 1000.0],
        d: [0.05, 0.0],
    };
    let (lags, length) = (9, LENGTH);
    oracle::Oracle { physics, substeps: 10, step: 0.01, augmentation, encoder, lags, length, u, y }
}

fn main() {
    let quick = std::env::args().any(|argument| argument == "--quick");
    let runs = if quick { 3 } else { 9 };
    let only = std::env::args().skip_while(|argument| argument != "--only").nth(1);
    let record = record::make(2, 1).record;
    let (u, y) = (&record.inputs[0].values, &record.outputs[0].values);
    let peaks = [peak::f64(), peak::f32()];
    let load = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    println!(
        "{}",
        json!({
            "isa": format!("{:?}", lacuna::real::Isa::detect()),
            "fma_peak_gflops": { "f64": peaks[0], "f32": peaks[1] },
            "load": load.split(' ').next(),
        })
    );
    let shooting = |threads, arithmetic| Shooting { length: LENGTH, threads, arithmetic };

    // the oracle, and that it does the same
    let model = augmented(system("adjoint"), &record);
    let oracle = oracle(&model, u, y);
    let mut step = Step::new(&model, &record, shooting(1, Arithmetic::Double));
    let some: Vec<usize> = step.loss.starts().iter().copied().step_by(130).take(150).collect();
    let (loss, gradient) = oracle.run(&some);
    let own = step.loss.loss(&step.parameters, &some, Some(&mut step.gradient)).unwrap();
    let largest = gradient.iter().fold(0.0, |m: f64, g| m.max(g.abs()));
    let off = gradient.iter().zip(&step.gradient).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!((loss - own).abs() < 1e-12 * loss && off < 1e-10 * largest, "{loss} {own} {off}");
    let (cpu, _) = least(3, || drop(black_box(oracle.run(&some))));
    let oracle_ms = cpu * SECTIONS as f64 / some.len() as f64;

    for kind in ["generic", "adjoint", "equations"] {
        let model = augmented(system(kind), &record);
        for (arithmetic, name, peak) in
            [(Arithmetic::Double, "f64", peaks[0]), (Arithmetic::Single, "f32", peaks[1])]
        {
            let case = format!("{kind}_{name}");
            if only.as_ref().is_some_and(|only| *only != case) {
                continue;
            }
            let mut step = Step::new(&model, &record, shooting(1, arithmetic));
            let (ms, wall) = least(runs, || {
                black_box(step.run(SECTIONS));
            });
            let flop = FLOP_PER_SAMPLE * (SECTIONS * LENGTH) as f64;
            println!(
                "{}",
                json!({
                    "case": case,
                    "ms": ms,
                    "wall_ms": wall,
                    "oracle_ms": oracle_ms,
                    "times_faster": oracle_ms / ms,
                    "fma_peak_share": flop / (ms * 1e-3) / (peak * 1e9),
                    "peak_mib_per_thread": step.loss.bytes_per_thread() as f64 / (1 << 20) as f64,
                })
            );
        }
    }
    if only.is_some() {
        return;
    }
    for arithmetic in [Arithmetic::Double, Arithmetic::Single] {
        let time = |threads| {
            let mut step = Step::new(&model, &record, shooting(threads, arithmetic));
            least(runs, || {
                black_box(step.run(SECTIONS));
            })
        };
        let ((_, one), (cpu, two)) = (time(1), time(2));
        let load = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
        println!(
            "{}",
            json!({
                "case": "two_threads", "arithmetic": arithmetic, "wall_ms_1": one,
                "wall_ms_2": two, "cpu_ms_2": cpu, "times_faster": one / two,
                "load": load.split(' ').next(),
            })
        );
    }
    // cost against each size: sections, samples of a section, samples of the record
    for sections in [750, 1500, 3000] {
        let (ms, _) = least(runs, || {
            black_box(step.run(sections));
        });
        println!("{}", json!({ "case": "linear", "sections": sections, "ms": ms }));
    }
    for length in [50, 100, 200] {
        let shooting = Shooting { length, ..shooting(1, Arithmetic::Double) };
        let mut step = Step::new(&model, &record, shooting);
        let (ms, _) = least(runs, || {
            black_box(step.run(SECTIONS));
        });
        println!("{}", json!({ "case": "linear", "length": length, "ms": ms }));
    }
    for samples in [5_000, 10_000, 20_000] {
        let part = record.slice(0..samples);
        let mut step = Step::new(&model, &part, shooting(1, Arithmetic::Double));
        let all = step.loss.starts().len();
        let (ms, _) = least(runs.min(3), || {
            black_box(step.run(all));
        });
        println!("{}", json!({ "case": "linear", "samples": samples, "epoch_ms": ms }));
    }
}
