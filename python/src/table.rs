//! Records as Python holds them: named columns, matched with a model when they are used.

use std::path::PathBuf;
use std::sync::Arc;

use lacuna::data::Table as Columns;
use numpy::ndarray::ArrayView1;
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::failure::Failure;

/// The columns of one record.
#[pyclass(frozen)]
#[derive(Debug)]
pub struct Table {
    pub columns: Arc<Columns>,
}

#[pymethods]
impl Table {
    /// Reads a file with one record or several.
    #[staticmethod]
    fn open(py: Python<'_>, path: PathBuf) -> PyResult<Vec<Self>> {
        let tables = py.detach(|| Columns::open_all(&path)).map_err(Failure::from)?;
        Ok(tables.into_iter().map(|columns| Self { columns: Arc::new(columns) }).collect())
    }

    /// A record of arrays, each with its header, `name` or `name [unit]`.
    #[staticmethod]
    fn of_columns(
        source: &str,
        columns: Vec<(String, PyReadonlyArray1<'_, f64>)>,
        sampling_time: Option<f64>,
    ) -> PyResult<Self> {
        let mut taken = vec![];
        for (header, values) in &columns {
            taken.push((header.clone(), values.as_array().to_vec()));
        }
        let made = Columns::of_columns(source, taken).map_err(Failure::from)?;
        let made = match sampling_time {
            Some(step) => made.sampled_at(step),
            None => made,
        };
        Ok(Self { columns: Arc::new(made) })
    }

    /// Where it comes from.
    #[getter]
    fn source(&self) -> &str {
        self.columns.source()
    }

    /// Number of samples.
    #[getter]
    fn rows(&self) -> usize {
        self.columns.rows()
    }

    /// The step in s that is stated beside the columns.
    #[getter]
    fn step(&self) -> Option<f64> {
        self.columns.step()
    }

    /// Name and unit of every column.
    fn names(&self) -> Vec<(String, String)> {
        self.columns.columns().iter().map(|c| (c.name.clone(), c.unit.clone())).collect()
    }

    /// The values of a column, seen where they lie, not to be written to.
    fn column<'py>(slf: &Bound<'py, Self>, name: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let values = slf.get().columns.values(name).map_err(Failure::from)?;
        let view = ArrayView1::from(values);
        // SAFETY: the array keeps this object alive, which owns the values and never changes them,
        // and the flag that follows keeps others from changing them.
        let array = unsafe { PyArray1::borrow_from_array(&view, slf.clone().into_any()) };
        let flags = PyDict::new(slf.py());
        flags.set_item("write", false)?;
        array.call_method("setflags", (), Some(&flags))?;
        Ok(array)
    }
}
