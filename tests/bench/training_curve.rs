//! How fast the error falls against processor time: one JSON line per epoch.
//!
//! ```text
//! cargo bench --bench training_curve -- FOLDER                     # all recipes, 5 seeds
//! cargo bench --bench training_curve -- FOLDER --recipe fit.toml --seeds 1
//! ```
//!
//! FOLDER holds `train.csv` and `val.csv` of Hoekstra et al., Sec. 4.1; without it, records
//! are made by the paper's recipe. Seconds are those of the steps alone: the start and the
//! validation are counted apart.

#[path = "training/peak.rs"]
#[allow(dead_code)]
mod peak;
#[path = "../paper_msd/record.rs"]
#[allow(dead_code)]
mod record;

use std::ops::ControlFlow;

use lacuna::data::Record;
use lacuna::train::{Epoch, Follow, Recipe};
use serde_json::json;

/// From the linear map, steps of 1e-3: the recipe that peers were timed with.
const PLAIN: &str = "\
[encoder.resnet]\nn_a = 9\nn_b = 9\ncurrent_sample = true
[initialiser.linearised]
about = \"equilibrium\"
[training]\nlength = 200\nbatch = 3000\nepochs = 20
[training.optimiser]\nrate = 1e-3
[training.validation]\nsimulation = false\nsections = 0";

/// The best that was found.
const BEST: &str = include_str!("training/best.toml");

/// Counts the processor time of steps alone.
struct Clock {
    name: String,
    seed: u64,
    mark: f64,
    steps: f64,
    quiet: bool,
    last: (usize, f64, f64),
}

impl Follow for Clock {
    fn on_epoch(&mut self, epoch: &Epoch) -> ControlFlow<()> {
        if let Some(score) = &epoch.score {
            let ahead: Vec<f64> = score.ahead.iter().map(|a| a[0]).collect();
            self.last = (epoch.epoch, self.steps, ahead[ahead.len() - 1]);
            if !self.quiet {
                println!(
                    "{}",
                    json!({
                        "recipe": self.name, "seed": self.seed, "epoch": epoch.epoch,
                        "cpu_s": self.steps, "loss": epoch.loss, "rmse": ahead,
                        "simulation": score.simulation.first(),
                    })
                );
            }
        }
        self.mark = peak::processor_seconds();
        ControlFlow::Continue(())
    }

    fn on_step(&mut self, _: usize, _: usize) -> ControlFlow<()> {
        let now = peak::processor_seconds();
        self.steps += now - self.mark;
        self.mark = now;
        ControlFlow::Continue(())
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let option = |name: &str| {
        let at = arguments.iter().position(|a| a == name)?;
        arguments.get(at + 1).cloned()
    };
    let folder = arguments.first().filter(|a| !a.starts_with("--"));
    let load = |file: &str, periods, seed| -> Record {
        let read = folder.and_then(|folder| record::read(folder, file, "y"));
        read.unwrap_or_else(|| record::make(periods, seed).record)
    };
    let (train, validation) = (load("train.csv", 2, 1), load("val.csv", 1, 2));
    let (train, validation) = ([train], [validation]);
    let seeds: u64 = option("--seeds").map_or(5, |s| s.parse().unwrap());
    let threads: usize = option("--threads").map_or(1, |s| s.parse().unwrap());
    let recipes = match option("--recipe") {
        Some(path) => vec![(path.clone(), std::fs::read_to_string(path).unwrap())],
        None => vec![("plain".into(), PLAIN.to_string()), ("best".into(), BEST.to_string())],
    };
    let system = record::system(0.05);
    for (name, text) in recipes {
        let mut ends = vec![];
        for seed in 0..seeds {
            let mut recipe: Recipe = toml::from_str(&text).unwrap();
            (recipe.training.seed, recipe.training.threads) = (seed, threads);
            let began = peak::processor_seconds();
            let (start, _) = recipe.start(&system, &train, seed).unwrap();
            let started = peak::processor_seconds() - began;
            let quiet = arguments.iter().any(|a| a == "--quiet");
            let mark = peak::processor_seconds();
            let name = name.clone();
            let mut clock = Clock { name, seed, mark, steps: 0.0, quiet, last: (0, 0.0, 0.0) };
            recipe.training.fit(&start, &train, &validation, &mut clock).unwrap();
            ends.push((clock.last.2, clock.last.1, started));
        }
        let median = |of: &dyn Fn(&(f64, f64, f64)) -> f64| {
            let mut values: Vec<f64> = ends.iter().map(of).collect();
            values.sort_by(f64::total_cmp);
            values[values.len() / 2]
        };
        println!(
            "{}",
            json!({
                "recipe": name, "seeds": seeds,
                "median_last_rmse": median(&|end| end.0),
                "median_cpu_s": median(&|end| end.1),
                "median_start_cpu_s": median(&|end| end.2),
            })
        );
    }
}
