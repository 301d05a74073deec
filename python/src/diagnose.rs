//! `diagnose` as a job.

use std::collections::BTreeMap;

use lacuna::data::Record;
use lacuna::diagnose::{Diagnosis, Finding, Planner};
use lacuna::estimate::linear_baseline;
use lacuna::file::to_toml_with;
use lacuna::report::{Document, FileNames, Report, sentences};
use lacuna::system::System;
use lacuna::watch::Watch;
use pyo3::prelude::*;

use crate::failure::Failure;
use crate::job::{Answer, Job, Shared};
use crate::model::Model;
use crate::settings::{Settings, system_of};
use crate::table::Table;
use crate::verbs::{Tables, all};

/// Files that the program writes, by the names in its document.
const MODEL: &str = "extended.toml";
const PAGE: &str = "report.html";

/// Finds what a model gets wrong on records; no model given: what a linear one of the records does.
#[pyfunction]
pub fn diagnose(
    model: Option<&Model>,
    tables: Tables<'_>,
    test: Option<&Bound<'_, Table>>,
    settings: &str,
) -> PyResult<Job> {
    let settings = Settings::of(settings)?;
    let test = test.map(Bound::get);
    let read = |tables: &[&Table]| match model {
        Some(model) => settings.records(&model.system, tables),
        None => settings.bare(tables, false),
    };
    let (records, mut remarks) = read(&all(&tables))?;
    let (mut tested, said) = read(test.as_slice())?;
    remarks.extend(said);
    let test = tested.pop();
    let system = model.map(system_of);
    let law = model.and_then(|model| model.law.clone());
    let (threads, written) = (settings.threads, law.is_some());
    let work = move |watch: &Shared| {
        let (system, share) = match system {
            Some(system) => (system, None),
            None => {
                let (found, share) = linear_baseline(&records, test.is_some(), watch)?;
                remarks.push(format!(
                    "No model was given: this is about a linear one of order {}, estimated from the first \
                     {:.0} % of the data.",
                    found.order,
                    100.0 * share
                ));
                remarks.extend(found.remarks);
                (found.system, Some(share))
            }
        };
        let mut answer = answer(&system, &records, test.as_ref(), &settings, written, watch)?;
        if share.is_some() {
            let text = lacuna::file::to_toml(&system)?;
            answer.texts.insert("linear.toml".into(), text);
        }
        answer.remarks = remarks;
        Ok(answer)
    };
    Ok(Job::start(threads, law, work)?)
}

/// The diagnosis, and all that is made of it.
fn answer(
    system: &System,
    records: &[Record],
    test: Option<&Record>,
    settings: &Settings,
    written: bool,
    watch: &dyn Watch,
) -> Result<Answer, Failure> {
    let mut diagnosis = Diagnosis::of(system)
        .only(&settings.only)
        .without(&settings.without)
        .fix(&settings.fix)
        .init(settings.init())
        .memory(settings.memory()?);
    if let Some(most) = settings.max_causes {
        diagnosis = diagnosis.max_causes(most);
    }
    let finding = diagnosis.run(records, test, watch)?;
    let outlook = Planner::for_look_alikes(&finding, system, records, watch);
    let from = settings.provenance()?;
    let mut report = Report::of(&finding).titled(&settings.title).from(&from).model(system);
    if let Some(outlook) = &outlook {
        report = report.outlook(outlook);
    }
    let page = report.page();
    let files = FileNames { extended_model: MODEL, report: PAGE };
    let document = Document::of(&finding, files, &from).text()?;
    let mut texts = BTreeMap::from([
        ("headline".into(), sentences::headline(&finding)),
        ("details".into(), sentences::details(&finding).join("\n")),
        (PAGE.into(), page.html()),
        ("report-data.json".into(), page.stored()),
        ("diagnosis.json".into(), document.clone()),
    ]);
    if !written {
        let mut header = vec!["Written by `lacuna.diagnose`.".to_string()];
        header.extend(sentences::headline(&finding).lines().map(String::from));
        header.extend(from.same());
        texts.insert(MODEL.into(), to_toml_with(&finding.extended, &header)?);
    }
    let arrays = series(&finding);
    Ok(Answer { document, arrays, texts, model: Some(finding.extended), remarks: vec![] })
}

/// What the pictures are drawn of.
fn series(finding: &Finding) -> BTreeMap<String, Vec<f64>> {
    let from = &finding.series;
    let mut arrays = BTreeMap::new();
    let groups = [("measured", &from.measured), ("before", &from.before), ("after", &from.after)];
    for (what, values) in groups {
        for ((name, _), values) in from.outputs.iter().zip(values) {
            arrays.insert(format!("{what}:{name}"), values.clone());
        }
    }
    let samples = from.measured.first().map_or(0, Vec::len);
    let time = (0..samples).map(|k| k as f64 * from.sampling_time).collect();
    arrays.insert("time".into(), time);
    for curve in &from.curves {
        let k = curve.cause;
        let mut put = |what: &str, values: Vec<f64>| arrays.insert(format!("{what}:{k}"), values);
        put("law z", curve.law.iter().map(|p| p.0).collect());
        put("law w", curve.law.iter().map(|p| p.1).collect());
        put("free z", curve.knots.iter().map(|p| p.0).collect());
        put("free w", curve.knots.iter().map(|p| p.1).collect());
        put("free std", curve.knots.iter().map(|p| p.2).collect());
        put("band low", curve.band.iter().map(|p| p.1).collect());
        put("band high", curve.band.iter().map(|p| p.2).collect());
    }
    let test = &from.test;
    let groups = [
        ("test measured", &test.measured),
        ("test before", &test.before),
        ("test after", &test.after),
    ];
    for (what, values) in groups {
        for ((name, _), values) in from.outputs.iter().zip(values) {
            arrays.insert(format!("{what}:{name}"), values.clone());
        }
    }
    arrays
}
