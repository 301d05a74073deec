//! How long encoder initialisers take on the paper's record and how good they are: one JSON
//! line each.
//!
//! Run with `cargo bench --bench encoder -- FOLDER`, where FOLDER holds `train.csv` and
//! `val.csv` with the columns of the paper's records; without it, records are made by the
//! paper's recipe. Windows hold 9 past samples and the current one.

#[path = "../paper_msd/record.rs"]
#[allow(dead_code)]
mod record;

use std::time::Instant;

use lacuna::data::Record;
use lacuna::encoder::{
    About, Baseline, Encoder, EncoderInitialiser, LeastSquares, LinearEncoder, Linearised, Outputs,
    Prefit, PrefitStart, Random, Reconstruction, ResNetEncoder, SampledLinear, Started, Window,
};
use serde_json::json;

const WINDOW: Window = Window { n_a: 9, n_b: 9, current_sample: true };

/// Processor seconds of this process so far.
fn processor_seconds() -> f64 {
    let Ok(stat) = std::fs::read_to_string("/proc/self/stat") else { return f64::NAN };
    // after the name in parentheses: utime and stime are fields 14 and 15, in 1/100 s
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or("").split_whitespace().collect();
    let ticks = |i: usize| fields.get(i).and_then(|f| f.parse::<f64>().ok()).unwrap_or(f64::NAN);
    (ticks(11) + ticks(12)) / 100.0
}

/// Least and median of several runs, in s.
fn times(runs: usize, mut work: impl FnMut()) -> (f64, f64) {
    let mut all: Vec<f64> = (0..runs)
        .map(|_| {
            let start = Instant::now();
            work();
            start.elapsed().as_secs_f64()
        })
        .collect();
    all.sort_by(f64::total_cmp);
    (all[0], all[runs / 2])
}

fn states(of: &[lacuna::encoder::StateError]) -> Vec<f64> {
    of.iter().map(|s| s.rmse).collect()
}

/// One line on a finished encoder, scored on the validation record.
fn line(
    name: &str,
    seed: u64,
    wall: f64,
    cpu: f64,
    started: &Started,
    encoder: &dyn Encoder,
    validation: &Baseline<'_>,
) {
    let steps: Vec<usize> = started.optimised.iter().map(|o| o.steps).collect();
    let evaluations: Vec<usize> = started.optimised.iter().map(|o| o.evaluations).collect();
    println!(
        "{}",
        json!({
            "initialiser": name,
            "seed": seed,
            "wall_s": wall,
            "cpu_s": cpu,
            "normalised_squared_error": started.squared_error(),
            "rank": started.rank,
            "condition": started.condition,
            "steps": steps,
            "evaluations": evaluations,
            "train_rmse_simulated": states(&started.states),
            "train_rmse_measured": states(&started.measured),
            "validation_rmse_simulated": states(&validation.score(encoder, Outputs::Simulated).unwrap()),
            "validation_rmse_measured": states(&validation.score(encoder, Outputs::Measured).unwrap()),
        })
    );
}

fn main() {
    let folder = std::env::args().skip(1).find(|a| !a.starts_with("--"));
    let load = |file: &str, periods, seed| -> Record {
        let read = folder.as_ref().and_then(|folder| record::read(folder, file, "y"));
        read.unwrap_or_else(|| record::make(periods, seed).record)
    };
    let (train, validation) = (load("train.csv", 2, 1), load("val.csv", 1, 2));
    let system = record::system(0.05);
    println!("{}", json!({ "folder": folder, "samples": train.len() }));

    // the map alone: linearise, then invert
    let names: Vec<String> = ["p_1", "v_1", "p_2", "v_2"].map(String::from).to_vec();
    let about = About::Equilibrium;
    let map = || {
        let linear = SampledLinear::about(&system, 0.1, &about, &[]).unwrap();
        Reconstruction::of(&linear, WINDOW, &names).unwrap()
    };
    let (least, median) = times(200, || drop(map()));
    println!(
        "{}",
        json!({ "map": "linearised", "least_ms": 1e3 * least, "median_ms": 1e3 * median })
    );
    let linear = SampledLinear::about(&system, 0.1, &about, &[]).unwrap();
    let (least, median) = times(200, || {
        std::hint::black_box(Reconstruction::of(&linear, WINDOW, &names).unwrap());
    });
    println!(
        "{}",
        json!({ "map": "reconstruction alone", "least_ms": 1e3 * least, "median_ms": 1e3 * median })
    );

    let on_validation = Baseline::new(&system, &validation).unwrap();
    let baseline = Baseline::new(&system, &train).unwrap();
    let (wall, _) = times(1, || {
        std::hint::black_box(baseline.simulate().unwrap());
    });
    println!("{}", json!({ "simulation_ms": 1e3 * wall }));

    let linear: [(&str, &dyn EncoderInitialiser); 3] = [
        ("linearised", &Linearised::default()),
        ("least_squares, simulated", &LeastSquares::default()),
        ("least_squares, measured", &LeastSquares { outputs: Outputs::Measured }),
    ];
    for (name, method) in linear {
        let mut encoder = LinearEncoder::new(WINDOW);
        let mut started = method.initialise(&mut encoder, &baseline, 0).unwrap();
        let cpu = processor_seconds();
        let (least, _) =
            times(5, || started = method.initialise(&mut encoder, &baseline, 0).unwrap());
        let cpu = (processor_seconds() - cpu) / 5.0;
        line(name, 0, least, cpu, &started, &encoder, &on_validation);
    }
    let from = |start| Prefit { start, ..Prefit::default() };
    let networks: [(&str, &dyn EncoderInitialiser); 4] = [
        ("random", &Random {}),
        ("prefit", &from(PrefitStart::Random)),
        ("prefit from least squares", &from(PrefitStart::LeastSquares)),
        ("prefit, measured", &Prefit { outputs: Outputs::Measured, ..Prefit::default() }),
    ];
    for (name, method) in networks {
        for seed in 0..3 {
            let mut encoder = ResNetEncoder::new(WINDOW, &[16, 16]);
            let (start, cpu) = (Instant::now(), processor_seconds());
            let started = method.initialise(&mut encoder, &baseline, seed).unwrap();
            let (wall, cpu) = (start.elapsed().as_secs_f64(), processor_seconds() - cpu);
            line(name, seed, wall, cpu, &started, &encoder, &on_validation);
        }
    }
}
