//! The commands of the program but `diagnose` and `fit`, each as a job.

use std::collections::BTreeMap;

use lacuna::diagnose::{Diagnosis, Planner, distortion};
use lacuna::digits::number;
use lacuna::estimate::{estimate_by, estimate_with, linear_with};
use lacuna::evaluate::Simulation;
use lacuna::file::{Document, Format};
use lacuna::likelihood::Predictor;
use lacuna::look::Look;
use lacuna::optimise::Named;
use lacuna::report::{MissingReport, documents, sentences};
use pyo3::prelude::*;
use serde_json::json;

use crate::failure::Failure;
use crate::job::{Answer, Job};
use crate::model::Model;
use crate::settings::{Settings, system_of};
use crate::table::Table;

/// Several tables, borrowed for a call.
pub type Tables<'py> = Vec<Bound<'py, Table>>;

/// The tables themselves.
pub fn all<'a>(tables: &'a Tables<'_>) -> Vec<&'a Table> {
    tables.iter().map(Bound::get).collect()
}

/// Simulates a model along a record.
#[pyfunction]
pub fn simulate(model: &Model, table: &Bound<'_, Table>, settings: &str) -> PyResult<Job> {
    let settings = Settings::of(settings)?;
    let (mut records, remarks) = settings.to_simulate(&model.system, table.get())?;
    let (system, init) = (system_of(model), settings.init());
    let work = move |_: &crate::job::Shared| {
        let Some(record) = records.pop() else { return Ok(Answer::default()) };
        let run = Simulation::of(&system, &record, init)?;
        let document = documents::simulated(&run).to_string();
        let mut arrays = BTreeMap::new();
        arrays.insert("time".into(), (0..record.len()).map(|k| record.time(k)).collect());
        for signal in record.outputs {
            arrays.insert(format!("measured:{}", signal.name), signal.values);
        }
        arrays.extend(run.outputs.into_iter().map(|(name, y)| (format!("simulated:{name}"), y)));
        Ok(Answer { document, arrays, remarks, ..Answer::default() })
    };
    Ok(Job::start(settings.threads, model.law.clone(), work)?)
}

/// Fits the free parameters of a model.
#[pyfunction]
pub fn estimate(model: &Model, tables: Tables<'_>, settings: &str) -> PyResult<Job> {
    let settings = Settings::of(settings)?;
    let (records, mut remarks) = settings.records(&model.system, &all(&tables))?;
    let system = system_of(model);
    let threads = settings.threads;
    let work = move |watch: &crate::job::Shared| {
        // what cannot be simulated with its present values yet is fitted to the records as they are
        let (records, faults) =
            Diagnosis::of(&system).data_faults(&records).unwrap_or((records, vec![]));
        remarks.extend(faults.iter().map(sentences::cause));
        let found = match &settings.optimiser {
            None => estimate_with(&system, &records, &settings.fix, settings.seed, watch)?,
            Some(named) => {
                let text = named.to_string();
                let read = Document::parse(&text, "optimiser", Format::Json)?;
                let Named(optimiser) = read.read()?;
                let (fix, seed) = (&settings.fix, settings.seed);
                estimate_by(&system, &records, fix, optimiser.as_ref(), seed, watch)?
            }
        };
        let document = documents::estimated(&found, None, &faults)?.to_string();
        Ok(Answer { document, model: Some(found.system), remarks, ..Answer::default() })
    };
    Ok(Job::start(threads, model.law.clone(), work)?)
}

/// Estimates a linear model of records alone.
#[pyfunction]
pub fn linear(tables: Tables<'_>, settings: &str) -> PyResult<Job> {
    let settings = Settings::of(settings)?;
    let (records, remarks) = settings.bare(&all(&tables), false)?;
    let order = settings.order;
    let work = move |watch: &crate::job::Shared| {
        let found = linear_with(&records, order, watch)?;
        let document = documents::linear(&found, None).to_string();
        Ok(Answer { document, model: Some(found.system), remarks, ..Answer::default() })
    };
    Ok(Job::start(settings.threads, None, work)?)
}

/// Asks whether records reject a model.
#[pyfunction]
pub fn check(model: &Model, tables: Tables<'_>, settings: &str) -> PyResult<Job> {
    let settings = Settings::of(settings)?;
    let (records, remarks) = settings.records(&model.system, &all(&tables))?;
    let (system, level, memory) = (system_of(model), settings.level, settings.memory()?);
    let work = move |watch: &crate::job::Shared| {
        let diagnosis = Diagnosis::of(&system).max_causes(1).memory(memory);
        let outcome = diagnosis.check(&records, watch)?;
        let document = documents::goodness_of_fit(&outcome, level)?.to_string();
        let p = outcome.p_value.map(|p| number(p, None));
        let verdict = match p {
            None => "Interrupted: there is no verdict.".into(),
            Some(p) => {
                let rejected = outcome.p_value.is_some_and(|p| p < level);
                let word = if rejected { "reject" } else { "do not reject" };
                format!("These data {word} the model (p = {p}, level {level}).")
            }
        };
        let texts = BTreeMap::from([("headline".into(), verdict)]);
        Ok(Answer { document, texts, remarks, ..Answer::default() })
    };
    Ok(Job::start(settings.threads, model.law.clone(), work)?)
}

/// Asks what records can see and tell apart.
#[pyfunction]
pub fn plan(model: &Model, tables: Tables<'_>, settings: &str) -> PyResult<Job> {
    let settings = Settings::of(settings)?;
    let (records, remarks) = settings.records(&model.system, &all(&tables))?;
    let (system, threads) = (system_of(model), settings.threads);
    let work = move |watch: &crate::job::Shared| {
        let planner = Planner::of(&system).only(&settings.only).fix(&settings.fix);
        let outlook = planner.run(&records, watch)?;
        let document = serde_json::to_string(&outlook)?;
        let texts = BTreeMap::from([("headline".into(), sentences::outlook(&outlook))]);
        Ok(Answer { document, texts, remarks, ..Answer::default() })
    };
    Ok(Job::start(threads, model.law.clone(), work)?)
}

/// Looks at records before any model, or at what a model leaves unexplained on them.
#[pyfunction]
pub fn look(model: Option<&Model>, tables: Tables<'_>, settings: &str) -> PyResult<Job> {
    let settings = Settings::of(settings)?;
    let threads = settings.threads;
    let Some(model) = model else {
        let (records, remarks) = settings.bare(&all(&tables), true)?;
        let work = move |_: &crate::job::Shared| {
            let (mut found, mut texts, mut said) = (vec![], BTreeMap::new(), vec![]);
            for (k, record) in records.iter().enumerate() {
                let look = Look::of(record);
                let distorted = distortion(std::slice::from_ref(record));
                found.push(documents::looked(&look, &distorted, None)?);
                said.push(look.to_string());
                let page = if k == 0 { "look.html".into() } else { format!("look-{}.html", k + 1) };
                texts.insert(page, look.page(&record.source));
            }
            texts.insert("headline".into(), said.join("\n"));
            let document = json!({ "schema": 1, "records": found }).to_string();
            Ok(Answer { document, texts, remarks, ..Answer::default() })
        };
        return Ok(Job::start(threads, None, work)?);
    };
    let (records, remarks) = settings.records(&model.system, &all(&tables))?;
    let system = system_of(model);
    let work = move |_: &crate::job::Shared| -> Result<Answer, Failure> {
        let missing = Predictor::new(&system, &records)?.missing()?;
        let step = records.first().map_or(1.0, |record| record.sampling_time);
        let report = MissingReport::of(&missing, step);
        let document = documents::missing(&missing, None).to_string();
        let texts = BTreeMap::from([
            ("headline".into(), report.lines().join("\n")),
            ("look.html".into(), report.html("Missing force")),
        ]);
        Ok(Answer { document, texts, remarks, ..Answer::default() })
    };
    Ok(Job::start(threads, model.law.clone(), work)?)
}
