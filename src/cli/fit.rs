//! `lacuna fit`.

mod progress;

use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

use serde_json::json;

use super::args::Fit as Args;
use super::console::Console;
use super::failure::Failure;
use super::input;
use super::outputs::{self, cannot_write};
use lacuna::data::Record;
use lacuna::digits::number;
use lacuna::evaluate::{Init, Metrics, Simulation};
use lacuna::file::{Document, save_with, write_text};
use lacuna::report::documents::{self, Fitted, fitted};
use lacuna::report::{Compared, TrainingReport};
use lacuna::system::System;
use lacuna::train::{Ablation, Checkpoint, Disguise, Ended, Epoch, Fit, Recipe, warnings};

use lacuna::report::ReadBack;
use progress::{Following, Progress};

/// Share of the data that is kept for validation where no record is given for it.
const VALIDATION: f64 = 0.2;
/// What a training writes beside its checkpoint.
const FILES: [&str; 4] = ["model.toml", "weights.json", "history.csv", PAGE];
const PAGE: &str = "report.html";

pub fn run(args: &Args, seed: u64, threads: Option<usize>, look: &Console) -> Result<u8, Failure> {
    let test: Vec<PathBuf> = args.test.iter().cloned().collect();
    let apart: [(&str, &[PathBuf]); 2] = [("--validate", &args.validate), ("--test", &test)];
    outputs::distinct(&args.on.data, &apart)?;
    let document = Document::load(&args.config)?;
    let mut recipe: Recipe = document.read()?;
    let located = |error| Failure::from(error).in_file(&args.config, &document, [""; 2]);
    recipe.training.check().map_err(located)?;
    let checkpoint = recipe
        .training
        .checkpoint
        .get_or_insert_with(|| Checkpoint { path: args.out.join("checkpoint.json"), every: 100 });
    let mut inputs = outputs::paths(&[&args.on.data, &args.validate, &test]);
    inputs.extend([args.on.model.as_path(), &args.config]);
    let mut written = outputs::within(&args.out, &FILES);
    written.push(checkpoint.path.clone());
    outputs::check(&inputs, &written, look)?;
    let known = checkpoint.path.exists();
    let (system, want) = input::model(&args.on.model)?;
    let columns = &args.on.columns;
    let read = |path: &PathBuf| input::record(path, &want, columns, look);
    let mut records = input::records(&args.on.data, &want, columns, look)?;
    let mut validation = input::records(&args.validate, &want, columns, look)?;
    let test = args.test.as_ref().map(read).transpose()?;
    if validation.is_empty() {
        look.say("No --validate: the last 20 % of each record are kept for validation.");
        let mut kept = vec![];
        for record in &records {
            let mut parts = record.split(&[1.0 - VALIDATION, VALIDATION])?;
            validation.extend(parts.pop());
            kept.extend(parts.pop());
        }
        records = kept;
    }
    fs::create_dir_all(&args.out).map_err(|error| cannot_write(&args.out, &error))?;
    if seed != 0 {
        recipe.training.seed = seed;
    }
    let available = || std::thread::available_parallelism().map_or(1, usize::from);
    recipe.training.threads = threads.unwrap_or_else(available);
    look.hear_interrupts()?;
    let begun = recipe.start(&system, &records, recipe.training.seed);
    let (start, started) = begun.map_err(located)?;
    // what cannot be saved is better known before the work than after it
    start.system()?;
    look.say(&started.to_string());
    if known {
        look.say("Going on from the checkpoint.");
    }
    let lengths = recipe.training.validation.lengths.clone();
    let page = Following::of(args.out.join(PAGE), &want.outputs, &lengths);
    let mut progress = Progress::of(look, recipe.training.all_epochs(), page);
    let fit = recipe.training.fit(&start, &records, &validation, &mut progress);
    let mut fit = fit.map_err(|error| {
        look.clear();
        located(error)
    })?;
    let mut parts = vec![];
    if fit.ended != Ended::Asked {
        parts = recipe.training.prune(&mut fit, &records, &validation, &mut progress)?;
    }
    look.clear();
    let (fit, want) = (&fit, &want.outputs[..]);
    // what was learned is asked for its name where it was learned
    let read = records.first().map_or(Ok(vec![]), |record| ReadBack::of(&fit.model, record))?;
    let disguise = records.first().map_or(Ok(None), |record| fit.model.disguise(record))?;
    let (parts, read, disguise) = (&parts[..], &read[..], disguise.as_ref());
    let done = Done { args, system: &system, recipe: &recipe, fit, want, parts, read, disguise };
    done.write(&started.to_string(), test.as_ref().or(validation.first()), test.is_some(), look)
}

/// A finished training and where it goes.
struct Done<'a> {
    args: &'a Args,
    system: &'a System,
    recipe: &'a Recipe,
    fit: &'a Fit,
    want: &'a [(String, String)],
    parts: &'a [Ablation],
    read: &'a [ReadBack],
    disguise: Option<&'a Disguise>,
}

impl Done<'_> {
    /// Writes all files, scores the model on the record shown and says what came out.
    fn write(
        &self,
        started: &str,
        scored: Option<&Record>,
        is_test: bool,
        look: &Console,
    ) -> Result<u8, Failure> {
        let (out, fit) = (&self.args.out, self.fit);
        let model = fit.model.system()?;
        let header =
            [format!("Fitted by `lacuna fit`: the best of {} epochs.", fit.history.len() - 1)];
        save_with(&model, &out.join("model.toml"), &header)?;
        let weights = serde_json::to_string_pretty(&fit.model)
            .map_err(|error| Failure::work(format!("the weights cannot be written: {error}")))?;
        for (name, text) in [("weights.json", weights), ("history.csv", self.history())] {
            let path = out.join(name);
            write_text(&path, &text).map_err(|error| cannot_write(&path, &error))?;
        }
        let mut report =
            TrainingReport::of(fit, self.want, &self.recipe.training.validation.lengths)
                .noting(started);
        for text in self.said() {
            report = report.noting(&text);
        }
        for curve in self.read.iter().filter_map(ReadBack::curve) {
            report = report.reading(curve);
        }
        let (mut run, mut before) = (None, vec![]);
        if let Some(record) = scored {
            before = Simulation::of(self.system, record, Init::Forgotten)?.outputs;
            run = Some(fit.model.simulate(record)?.settled(self.recipe.training.settle));
        }
        let baseline: Vec<Vec<f64>> = before.into_iter().map(|(_, values)| values).collect();
        if let (Some(record), Some(run)) = (scored, &run) {
            report = report.showing(Compared { record, baseline: &baseline, run });
        }
        let page = out.join(PAGE);
        report.write(&page).map_err(|error| cannot_write(&page, &error))?;
        let scores = match (scored, &run) {
            (Some(record), Some(run)) => documents::scores(record, self.want, &baseline, run),
            _ => vec![],
        };
        self.summarise(&scores, is_test, look);
        Ok(0)
    }

    fn summarise(&self, scores: &[[Option<Metrics>; 2]], is_test: bool, look: &Console) {
        let (fit, out) = (self.fit, &self.args.out);
        let interrupted = fit.ended == Ended::Asked;
        if interrupted {
            look.result("Interrupted: this is the best model so far; the same call goes on.");
        }
        let which = if is_test { "test" } else { "validation" };
        for ((name, unit), [baseline, trained]) in self.want.iter().zip(scores) {
            if let (Some(baseline), Some(trained)) = (baseline, trained) {
                look.headline(&format!(
                    "{name}: {which} RMSE {} -> {} {unit} (epoch {})",
                    number(baseline.rmse, None),
                    number(trained.rmse, None),
                    fit.epoch
                ));
            }
        }
        if fit.restart > 0 {
            look.result(&format!("The best model comes from restart {}.", fit.restart));
        }
        if fit.rollbacks > 0 {
            look.result(&format!("{} steps led nowhere and were taken back.", fit.rollbacks));
        }
        for text in self.said() {
            look.result(&text);
        }
        look.say(&format!("Wrote {} into {}", FILES.join(", "), out.display()));
        let Self { parts, read, disguise, want: outputs, .. } = *self;
        let of = Fitted { fit, parts, read, disguise, outputs, scores, is_test };
        let mut document = fitted(&of);
        for (key, name) in ["model", "weights", "history", "report"].iter().zip(FILES) {
            document[*key] = json!(name);
        }
        look.document(&document);
    }

    /// What the parts of the model are worth, and what the course of the training warns of.
    fn said(&self) -> Vec<String> {
        let mut said: Vec<String> = self.parts.iter().map(ToString::to_string).collect();
        said.extend(self.read.iter().map(ReadBack::sentence));
        said.extend(self.disguise.map(ToString::to_string));
        said.extend(warnings(self.fit).into_iter().map(|text| format!("Warning: {text}")));
        said
    }

    fn history(&self) -> String {
        let lengths = &self.recipe.training.validation.lengths;
        let mut text = String::from("epoch,loss,rate,best,rolled_back");
        for (name, unit) in self.want {
            let unit = if unit.is_empty() { String::new() } else { format!(" [{unit}]") };
            for length in lengths {
                let _ = write!(text, ",{name}_rmse_{length}{unit}");
            }
            let _ = write!(text, ",{name}_rmse_simulation{unit}");
        }
        text.push('\n');
        let cell = |value: Option<f64>| value.map_or_else(String::new, |v| v.to_string());
        for epoch in &self.fit.history {
            let Epoch { epoch: number, loss, rate, best, rolled_back, score } = epoch;
            let best = u8::from(*best);
            let _ = write!(text, "{number},{},{rate},{best},{rolled_back}", cell(*loss));
            for o in 0..self.want.len() {
                for i in 0..lengths.len() {
                    let ahead = score.as_ref().and_then(|s| Some(*s.ahead.get(i)?.get(o)?));
                    let _ = write!(text, ",{}", cell(ahead));
                }
                let simulation = score.as_ref().and_then(|s| s.simulation.get(o).copied());
                let _ = write!(text, ",{}", cell(simulation));
            }
            text.push('\n');
        }
        text
    }
}
