//! Work that goes on in a thread of its own while the interpreter stays free: it can be asked how
//! far it is, waited for, and stopped with what is known.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use lacuna::system::System;
use lacuna::watch::Watch;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::failure::Failure;
use crate::law::Law;
use crate::model::Model;

/// What work gives back.
#[derive(Debug, Default)]
pub struct Answer {
    /// The program's JSON document.
    pub document: String,
    /// Series by name.
    pub arrays: BTreeMap<String, Vec<f64>>,
    /// Files by name, as the program writes them, and sentences.
    pub texts: BTreeMap<String, String>,
    /// The model that came out.
    pub model: Option<System>,
    /// What was noticed on the way.
    pub remarks: Vec<String>,
}

#[derive(Debug, Default)]
struct Course {
    done: f64,
    doing: String,
    answer: Option<Result<Answer, Failure>>,
    ended: bool,
}

/// What the thread and those who wait for it share.
#[derive(Debug, Default)]
pub struct Shared {
    course: Mutex<Course>,
    changed: Condvar,
    stopped: AtomicBool,
    /// The law written in Python that the work calls, if it calls one.
    law: Option<Arc<Law>>,
}

impl Shared {
    fn course(&self) -> MutexGuard<'_, Course> {
        // what a thread that panicked has told is still true
        self.course.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Watch for Shared {
    fn report(&self, done: f64, doing: &str) {
        let mut course = self.course();
        // several threads tell, and not in order: what was done stays done
        course.done = course.done.max(done.clamp(0.0, 1.0));
        if course.doing != doing {
            course.doing = doing.into();
        }
    }

    fn stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed) || self.law.as_ref().is_some_and(|law| law.failed())
    }
}

/// Work in a thread.
#[pyclass(frozen)]
#[derive(Debug)]
pub struct Job {
    shared: Arc<Shared>,
}

/// Stack of the thread that works, in bytes: as much as a program's own.
const STACK: usize = 8 << 20;

impl Job {
    /// Starts work on some threads; none given: on all.
    pub fn start(
        threads: Option<usize>,
        law: Option<Arc<Law>>,
        work: impl FnOnce(&Shared) -> Result<Answer, Failure> + Send + 'static,
    ) -> Result<Self, Failure> {
        if let Some(law) = &law {
            law.forget();
        }
        let shared = Arc::new(Shared { law, ..Shared::default() });
        let pool = match threads {
            None => None,
            Some(count) => {
                let built = rayon::ThreadPoolBuilder::new().num_threads(count).build();
                Some(built.map_err(|error| Failure::call(format!("{count} threads: {error}")))?)
            }
        };
        let own = Arc::clone(&shared);
        let run = move || {
            let work = AssertUnwindSafe(|| match pool {
                Some(pool) => pool.install(|| work(&own)),
                None => work(&own),
            });
            let answer = catch_unwind(work).unwrap_or_else(|_| {
                Err(Failure::work("the work broke off: this is a fault of lacuna".into()))
            });
            let mut course = own.course();
            (course.answer, course.ended) = (Some(answer), true);
            own.changed.notify_all();
        };
        let thread = std::thread::Builder::new().name("lacuna".into()).stack_size(STACK);
        thread.spawn(run).map_err(|error| Failure::work(format!("no thread: {error}")))?;
        Ok(Self { shared })
    }
}

type Given<'py> =
    (String, Bound<'py, PyDict>, BTreeMap<String, String>, Option<Model>, Vec<String>);

#[pymethods]
impl Job {
    /// Waits at most so many seconds; whether the work has ended.
    fn wait(&self, py: Python<'_>, seconds: f64) -> bool {
        py.detach(|| {
            let course = self.shared.course();
            let time = Duration::from_secs_f64(seconds.clamp(0.0, 60.0));
            let waited = self.shared.changed.wait_timeout_while(course, time, |c| !c.ended);
            waited.map_or(true, |(course, _)| course.ended)
        })
    }

    /// How far it is, from 0 to 1, and what is being done.
    fn course(&self) -> (f64, String) {
        let course = self.shared.course();
        (course.done, course.doing.clone())
    }

    /// Asks for an end with what is known.
    fn stop(&self) {
        self.shared.stopped.store(true, Ordering::Relaxed);
    }

    /// What came out, once: document, arrays, texts, model, remarks.
    fn result<'py>(&self, py: Python<'py>) -> PyResult<Given<'py>> {
        let law = self.shared.law.clone();
        if let Some(error) = law.as_ref().and_then(|law| law.fault(py)) {
            return Err(error);
        }
        let answer = self.shared.course().answer.take();
        let answer = answer.ok_or_else(|| Failure::call("there is no result to take".into()))??;
        let arrays = PyDict::new(py);
        for (name, values) in answer.arrays {
            // the array takes the memory over, without a copy
            arrays.set_item(name, PyArray1::from_vec(py, values))?;
        }
        let model = answer.model.map(|system| Model::of(system, law));
        Ok((answer.document, arrays, answer.texts, model, answer.remarks))
    }
}
