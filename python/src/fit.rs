//! `fit` as a job: a learned part beside a model, and its encoder.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use lacuna::data::Record;
use lacuna::evaluate::{Init, Simulation, want};
use lacuna::file::{Document, Format, to_toml_with};
use lacuna::report::documents::{Fitted, fitted, scores};
use lacuna::report::{Compared, ReadBack, TrainingReport};
use lacuna::system::System;
use lacuna::train::{Ended, Epoch, Follow, Recipe, warnings};
use lacuna::watch::Watch;
use pyo3::prelude::*;

use crate::failure::Failure;
use crate::job::{Answer, Job, Shared};
use crate::model::Model;
use crate::settings::{Settings, system_of};
use crate::table::Table;
use crate::verbs::{Tables, all};

/// Share of each record that is kept for validation where no record is given for it.
const VALIDATION: f64 = 0.2;

/// Tells how far a training is.
struct Following<'a> {
    watch: &'a Shared,
    epochs: usize,
    at: usize,
    said: String,
}

impl Following<'_> {
    fn report(&self, of_epoch: f64) -> ControlFlow<()> {
        let done = (self.at as f64 + of_epoch) / self.epochs.max(1) as f64;
        self.watch.report(done.min(1.0), &self.said);
        if self.watch.stopped() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

impl Follow for Following<'_> {
    fn on_epoch(&mut self, epoch: &Epoch) -> ControlFlow<()> {
        self.at = epoch.epoch;
        let loss = epoch.loss.map_or_else(String::new, |loss| format!(", loss {loss:.3e}"));
        self.said = format!("epoch {} of {}{loss}", epoch.epoch, self.epochs);
        self.report(0.0)
    }

    fn on_step(&mut self, done: usize, of: usize) -> ControlFlow<()> {
        self.report(done as f64 / of.max(1) as f64)
    }
}

/// The records of a training.
struct Data {
    train: Vec<Record>,
    validation: Vec<Record>,
    test: Option<Record>,
}

/// Trains a learned part beside a model.
#[pyfunction]
pub fn fit(
    model: &Model,
    tables: Tables<'_>,
    validation: Tables<'_>,
    test: Option<&Bound<'_, Table>>,
    settings: &str,
) -> PyResult<Job> {
    let settings = Settings::of(settings)?;
    let read = |tables: &[&Table]| settings.records(&model.system, tables);
    let (mut train, mut remarks) = read(&all(&tables))?;
    let (mut validation, said) = read(&all(&validation))?;
    let (mut tested, more) = read(test.map(Bound::get).as_slice())?;
    remarks.extend(said.into_iter().chain(more));
    if validation.is_empty() {
        remarks.push("The last 20 % of each record are kept for validation.".into());
        let mut kept = vec![];
        for record in &train {
            let mut parts = record.split(&[1.0 - VALIDATION, VALIDATION]).map_err(Failure::from)?;
            validation.extend(parts.pop());
            kept.extend(parts.pop());
        }
        train = kept;
    }
    let text = settings.recipe.clone().unwrap_or_else(|| serde_json::json!({})).to_string();
    let document = Document::parse(&text, "recipe", Format::Json).map_err(Failure::from)?;
    let mut recipe: Recipe = document.read().map_err(Failure::from)?;
    if settings.seed != 0 {
        recipe.training.seed = settings.seed;
    }
    let available = || std::thread::available_parallelism().map_or(1, usize::from);
    recipe.training.threads = settings.threads.unwrap_or_else(available);
    let (system, threads) = (system_of(model), settings.threads);
    let data = Data { train, validation, test: tested.pop() };
    let work = move |watch: &Shared| {
        let mut answer = trained(&system, &recipe, &data, watch)?;
        answer.remarks.splice(0..0, remarks);
        Ok(answer)
    };
    Ok(Job::start(threads, model.law.clone(), work)?)
}

fn trained(
    system: &System,
    recipe: &Recipe,
    data: &Data,
    watch: &Shared,
) -> Result<Answer, Failure> {
    let training = &recipe.training;
    let (start, started) = recipe.start(system, &data.train, training.seed)?;
    // what cannot be saved is better known before the work than after it
    start.system()?;
    let epochs = training.all_epochs();
    let mut follow = Following { watch, epochs, at: 0, said: "starting".into() };
    let mut fit = training.fit(&start, &data.train, &data.validation, &mut follow)?;
    let mut parts = vec![];
    if fit.ended != Ended::Asked {
        parts = training.prune(&mut fit, &data.train, &data.validation, &mut follow)?;
    }
    let outputs = want(system)?.outputs;
    let model = fit.model.system()?;
    let mut report = TrainingReport::of(&fit, &outputs, &training.validation.lengths);
    let mut remarks = vec![started.to_string()];
    remarks.extend(parts.iter().map(ToString::to_string));
    let first = data.train.first();
    let read = first.map_or(Ok(vec![]), |record| ReadBack::of(&fit.model, record))?;
    let disguise = first.map_or(Ok(None), |record| fit.model.disguise(record))?;
    remarks.extend(read.iter().map(ReadBack::sentence));
    remarks.extend(disguise.iter().map(ToString::to_string));
    remarks.extend(warnings(&fit).into_iter().map(|text| format!("Warning: {text}")));
    for text in &remarks {
        report = report.noting(text);
    }
    let mut arrays = BTreeMap::new();
    let of = |value: &dyn Fn(&Epoch) -> f64| fit.history.iter().map(value).collect::<Vec<f64>>();
    arrays.insert("epoch".into(), of(&|e| e.epoch as f64));
    arrays.insert("loss".into(), of(&|e| e.loss.unwrap_or(f64::NAN)));
    arrays.insert("rate".into(), of(&|e| e.rate));
    let scored = data.test.as_ref().or(data.validation.first());
    let mut found = vec![];
    let (run, baseline);
    if let Some(record) = scored {
        let before = Simulation::of(system, record, Init::Forgotten)?.outputs;
        baseline = before.into_iter().map(|(_, values)| values).collect::<Vec<_>>();
        run = fit.model.simulate(record)?;
        found = scores(record, &outputs, &baseline, &run);
        arrays.insert("time".into(), (0..record.len()).map(|k| record.time(k)).collect());
        for (o, (name, _)) in outputs.iter().enumerate() {
            if let Some(signal) = record.outputs.get(o) {
                arrays.insert(format!("measured:{name}"), signal.values.clone());
            }
            arrays.insert(format!("before:{name}"), baseline[o].clone());
            arrays.insert(format!("after:{name}"), run.outputs[o].clone());
        }
        report = report.showing(Compared { record, baseline: &baseline, run: &run });
    }
    let is_test = data.test.is_some();
    let (parts, disguise) = (&parts, disguise.as_ref());
    let (read, outputs, scores) = (&read, &outputs, &found);
    let of = Fitted { fit: &fit, parts, read, disguise, outputs, scores, is_test };
    let document = fitted(&of);
    let header = [format!("Fitted by `lacuna.fit`: the best of {} epochs.", fit.history.len() - 1)];
    let texts = BTreeMap::from([
        ("report.html".into(), report.html()),
        ("model.toml".into(), to_toml_with(&model, &header)?),
        ("weights.json".into(), serde_json::to_string_pretty(&fit.model)?),
    ]);
    let document = document.to_string();
    Ok(Answer { document, arrays, texts, model: Some(model), remarks })
}
