//! lacuna from Python: the native half of the package, which users see through `lacuna/*.py`.
//!
//! ```text
//! Python: Model, Record, a verb -- settings as JSON --> Job, a thread
//! Job -- wait, course, stop --> progress and Ctrl-C, in Python
//! Job -- result --> the program's JSON document, arrays, files as text, a model
//! ```

mod diagnose;
mod failure;
mod fit;
mod job;
mod law;
mod model;
mod settings;
mod table;
mod verbs;
mod written;

use pyo3::prelude::*;

/// The native half.
#[pymodule]
fn _lacuna(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("Error", py.get_type::<failure::Error>())?;
    module.add("CallError", py.get_type::<failure::CallError>())?;
    module.add("InputError", py.get_type::<failure::InputError>())?;
    module.add("WorkError", py.get_type::<failure::WorkError>())?;
    module.add_class::<job::Job>()?;
    module.add_class::<model::Model>()?;
    module.add_class::<table::Table>()?;
    module.add_function(wrap_pyfunction!(model::demo, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::simulate, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::estimate, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::linear, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::check, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::plan, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::look, module)?)?;
    module.add_function(wrap_pyfunction!(diagnose::diagnose, module)?)?;
    module.add_function(wrap_pyfunction!(fit::fit, module)?)
}
