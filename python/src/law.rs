//! The law of a model as a Python function: f(x, u, theta, w, t) for many instants at once, with
//! arrays of one row per signal and one column per instant.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use lacuna::model::{Ask, Parameter, Quantity, Signal, Signals, State};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use serde::Deserialize;

/// A named number with a unit, and what is known of a state or a parameter.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    name: String,
    #[serde(default)]
    unit: String,
    #[serde(default)]
    quantity: Option<String>,
    #[serde(default)]
    initial: f64,
    #[serde(default)]
    value: f64,
    #[serde(default)]
    min: Option<f64>,
    #[serde(default)]
    max: Option<f64>,
    #[serde(default)]
    fixed: bool,
}

/// What a model written in Python declares.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Declared {
    discrete: bool,
    inputs: Vec<Entry>,
    states: Vec<Entry>,
    outputs: Vec<Entry>,
    parameters: Vec<Entry>,
    channels: Vec<Entry>,
    coordinates: Vec<Entry>,
}

/// The law: what it declares, and the function that answers.
#[derive(Debug)]
pub struct Law {
    /// By which models name it.
    pub number: u64,
    /// What it declares.
    pub signals: Signals,
    answer: Py<PyAny>,
    failed: AtomicBool,
    fault: Mutex<Option<PyErr>>,
}

/// All laws that were written, by number: models are copied through their serialised form.
static LAWS: Mutex<BTreeMap<u64, Arc<Law>>> = Mutex::new(BTreeMap::new());
static NEXT: AtomicU64 = AtomicU64::new(1);

impl Law {
    /// A law that models can name from now on.
    pub fn new(declared: Declared, answer: Py<PyAny>) -> Arc<Self> {
        let signal = |e: &Entry| Signal {
            name: e.name.clone(),
            unit: e.unit.clone(),
            quantity: e.quantity.clone().map(Quantity),
        };
        let all = |entries: &[Entry]| entries.iter().map(signal).collect();
        let parameter = |e: &Entry| {
            let free = Parameter::new(e.name.clone(), e.value, &e.unit);
            let from = free.at_least(e.min.unwrap_or(f64::NEG_INFINITY));
            from.at_most(e.max.unwrap_or(f64::INFINITY)).fixed(e.fixed)
        };
        let state = |e: &Entry| State { signal: signal(e), initial: e.initial };
        let mut signals =
            if declared.discrete { Signals::discrete() } else { Signals::continuous() };
        signals.inputs = all(&declared.inputs);
        signals.states = declared.states.iter().map(state).collect();
        signals.outputs = all(&declared.outputs);
        signals.parameters = declared.parameters.iter().map(parameter).collect();
        signals.channels = all(&declared.channels);
        signals.coordinates = all(&declared.coordinates);
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let (failed, fault) = (AtomicBool::new(false), Mutex::new(None));
        let law = Arc::new(Self { number, signals, answer, failed, fault });
        laws().insert(number, Arc::clone(&law));
        law
    }

    /// Whether the function raised an exception since the last [`forget`](Self::forget).
    pub fn failed(&self) -> bool {
        self.failed.load(Ordering::Relaxed)
    }

    /// Forgets an exception.
    pub fn forget(&self) {
        self.failed.store(false, Ordering::Relaxed);
        *self.fault.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }

    /// The exception that the function raised.
    pub fn fault(&self, py: Python<'_>) -> Option<PyErr> {
        let fault = self.fault.lock().unwrap_or_else(PoisonError::into_inner);
        fault.as_ref().map(|error| error.clone_ref(py))
    }

    /// Answers at `count` instants: values signal by signal, instants side by side; not numbers
    /// where the function fails.
    pub fn ask(
        &self,
        ask: Ask,
        rows: usize,
        from: [&[f64]; 4],
        time: f64,
        count: usize,
    ) -> Vec<f64> {
        let nothing = || vec![f64::NAN; rows * count];
        if self.failed() {
            return nothing();
        }
        let which = match ask {
            Ask::Derivative => "derivative",
            Ask::Output => "output",
            Ask::Coordinates => "coordinates",
            Ask::Derived => return nothing(),
        };
        let answer = Python::attach(|py| -> PyResult<Vec<f64>> {
            let [x, u, theta, w] = from.map(|values| {
                let signals = values.len().checked_div(count).unwrap_or(0);
                PyArray1::from_slice(py, values).reshape([signals, count])
            });
            let given = self.answer.call1(py, (which, x?, u?, theta?, w?, time))?;
            let array: PyReadonlyArray2<'_, f64> = given.extract(py)?;
            Ok(array.as_array().iter().copied().collect())
        });
        match answer {
            Ok(values) if values.len() == rows * count => values,
            Ok(_) => nothing(),
            Err(error) => {
                let mut fault = self.fault.lock().unwrap_or_else(PoisonError::into_inner);
                fault.get_or_insert(error);
                self.failed.store(true, Ordering::Relaxed);
                nothing()
            }
        }
    }
}

/// All laws that were written.
pub fn laws() -> std::sync::MutexGuard<'static, BTreeMap<u64, Arc<Law>>> {
    LAWS.lock().unwrap_or_else(PoisonError::into_inner)
}
