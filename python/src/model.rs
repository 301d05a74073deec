//! Models as Python holds them.

use std::path::PathBuf;
use std::sync::Arc;

use lacuna::data::Table as Columns;
use lacuna::evaluate::want;
use lacuna::export::{Target, export};
use lacuna::file::{Format, load, parse, save_with, to_toml};
use lacuna::model::Signal;
use lacuna::system::{Sampling, System};
use pyo3::prelude::*;
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::law::Law;
use crate::table::Table;
use crate::written::Written;

/// A model, how it is sampled, and the effects that extend it.
#[pyclass(frozen)]
#[derive(Debug, Clone)]
pub struct Model {
    pub system: Arc<System>,
    /// Where its law is written in Python.
    pub law: Option<Arc<Law>>,
}

impl Model {
    /// Of a system, and its law where that is written in Python.
    pub fn of(system: System, law: Option<Arc<Law>>) -> Self {
        Self { system: Arc::new(system), law }
    }

    fn in_a_file(&self) -> Result<(), Failure> {
        match self.law {
            None => Ok(()),
            Some(_) => Err(Failure::call(
                "a model written in Python cannot be written into a file: its law is a function of this program\n  \
                 try: write the equations as [model.equations], which is also faster"
                    .into(),
            )),
        }
    }
}

#[pymethods]
impl Model {
    /// Reads a model file.
    #[staticmethod]
    fn from_file(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let system = py.detach(|| load(&path)).map_err(Failure::from)?;
        Ok(Self::of(system, None))
    }

    /// Reads the text of a model file, TOML or JSON, that goes by the name `source`.
    #[staticmethod]
    fn from_text(text: &str, source: &str, json: bool) -> PyResult<Self> {
        let format = if json { Format::Json } else { Format::Toml };
        let system = parse(text, source, format).map_err(Failure::from)?;
        Ok(Self::of(system, None))
    }

    /// A model written in Python: what it declares and how it is sampled, as JSON, and the function
    /// that answers for it.
    #[staticmethod]
    fn written(declared: &str, sampling: &str, answer: Py<PyAny>) -> PyResult<Self> {
        let read = |text: &str| serde_json::from_str(text).map_err(Failure::from);
        let sampling: Sampling = serde_json::from_str(sampling).map_err(Failure::from)?;
        let law = Law::new(read(declared)?, answer);
        let system = System::new(Written::of(&law), sampling);
        want(&system).map_err(Failure::from)?;
        Ok(Self::of(system, Some(law)))
    }

    /// What the model declares, as JSON.
    fn signals(&self) -> String {
        let signals = self.system.signals();
        let all = |signals: &[Signal]| -> Vec<Value> { signals.iter().map(signal).collect() };
        let bound = |value: f64| value.is_finite().then_some(value);
        let parameters = signals.parameters.iter().map(|p| {
            json!({
                "name": p.name, "value": p.value, "unit": p.unit,
                "min": bound(p.min), "max": bound(p.max), "fixed": p.fixed,
            })
        });
        let states = signals.states.iter().map(|state| {
            let mut entry = signal(&state.signal);
            entry["initial"] = json!(state.initial);
            entry
        });
        json!({
            "continuous": signals.time.is_continuous(),
            "sampling_time": self.system.sampling.sampling_time,
            "inputs": all(&signals.inputs),
            "states": states.collect::<Vec<_>>(),
            "outputs": all(&signals.outputs),
            "parameters": parameters.collect::<Vec<_>>(),
            "channels": all(&signals.own_channels()),
            "coordinates": all(&signals.own_coordinates()),
            "effects": self.system.effects.len(),
        })
        .to_string()
    }

    /// Whether the law is written in Python.
    #[getter]
    fn is_written(&self) -> bool {
        self.law.is_some()
    }

    /// The text of its model file.
    fn to_toml(&self) -> PyResult<String> {
        self.in_a_file()?;
        Ok(to_toml(&self.system).map_err(Failure::from)?)
    }

    /// Writes its model file, with lines of comment above.
    fn save(&self, path: PathBuf, header: Vec<String>) -> PyResult<()> {
        self.in_a_file()?;
        Ok(save_with(&self.system, &path, &header).map_err(Failure::from)?)
    }

    /// Writes it as source text of another program into a folder; gives the files and what a user
    /// should know.
    fn export(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        to: &str,
        name: &str,
    ) -> PyResult<(Vec<PathBuf>, Vec<String>)> {
        self.in_a_file()?;
        let target = match to {
            "c" => Target::C,
            "fmu" => Target::Fmu,
            "matlab" => Target::Matlab,
            "python" => Target::Python,
            other => {
                let message = format!("to=`{other}`: there are c, fmu, matlab, python");
                return Err(Failure::call(message).into());
            }
        };
        let written = py.detach(|| export(&self.system, target, name, &folder));
        let written = written.map_err(Failure::from)?;
        Ok((written.files, written.remarks))
    }
}

/// Two masses between springs, and two records of a machine with something that the model lacks:
/// what `lacuna demo` brings along.
#[pyfunction]
pub fn demo() -> PyResult<(Model, Table, Table)> {
    const MODEL: &str = include_str!("../../src/cli/demo/model.toml");
    const EST: &[u8] = include_bytes!("../../src/cli/demo/est.csv.gz");
    const TEST: &[u8] = include_bytes!("../../src/cli/demo/test.csv.gz");
    let read = |bytes: &[u8], source: &str| -> Result<Table, Failure> {
        Ok(Table { columns: Arc::new(Columns::read(bytes, source)?) })
    };
    let model = Model::from_text(MODEL, "demo/model.toml", false)?;
    Ok((model, read(EST, "demo/est.csv")?, read(TEST, "demo/test.csv")?))
}

fn signal(signal: &Signal) -> Value {
    let quantity = signal.quantity.as_ref().map(|q| q.0.as_str());
    json!({ "name": signal.name, "unit": signal.unit, "quantity": quantity })
}
