//! Models as source text for other programs: code generation from a recorded step.
//!
//! x_{k+1} = F(x_k, u_k), y_k = H(x_k, u_k) with the integrator inside F: the graph of one step
//! ([`Recorded`], made by operator overloading; Griewank and Walther, Evaluating Derivatives,
//! 2nd ed., 2008, ch. 6) is written out as statements of C99, Python or MATLAB, and the C as a
//! co-simulation FMU (FMI 2.0.4 and 3.0.1, Modelica Association).

mod c;
mod error;
mod fmu;
mod listing;
mod matlab;
mod names;
mod python;
mod syntax;
#[cfg(test)]
mod tests;
mod vector;

use lacuna_core::{fault, real, system};

use std::path::{Path, PathBuf};

use system::{Recorded, System};

pub use error::ExportError;
#[doc(hidden)]
pub use vector::Vector;

/// What a model is written as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// C99 without dependencies.
    C,
    /// Functional Mock-up Units, FMI 2.0 and 3.0, for co-simulation.
    Fmu,
    /// A MATLAB function.
    Matlab,
    /// A Python class that needs numpy.
    Python,
}

/// What was written.
#[derive(Debug, Clone, PartialEq, Eq)]
#[doc(hidden)]
pub struct Written {
    /// The files.
    pub files: Vec<PathBuf>,
    /// What a user should know, one sentence each.
    pub remarks: Vec<String>,
}

/// The comment of an exported unit's archive.
#[doc(hidden)]
pub const WRITTEN_BY: &str = "Written by `lacuna export`.";

/// Files by name, before they are written.
type Files = Vec<(String, Vec<u8>)>;

/// A recorded system with the names that it gets.
struct Model<'a> {
    name: &'a str,
    step: &'a Recorded,
    vector: &'a Vector,
}

/// An exported system in memory.
#[doc(hidden)]
#[derive(Debug, Clone)]
pub struct Sources {
    files: Files,
    remarks: Vec<String>,
}

impl Sources {
    /// Names of the files.
    pub fn names(&self) -> Vec<&str> {
        self.files.iter().map(|(name, _)| name.as_str()).collect()
    }

    /// Writes the files into a folder, which is made where there is none.
    ///
    /// # Errors
    ///
    /// If a file cannot be written.
    pub fn write(self, folder: &Path) -> Result<Written, ExportError> {
        let cannot = |path: &Path, error: std::io::Error| ExportError::Write {
            file: path.display().to_string(),
            reason: error.to_string(),
        };
        std::fs::create_dir_all(folder).map_err(|error| cannot(folder, error))?;
        let mut written = vec![];
        for (file, content) in self.files {
            let path = folder.join(file);
            std::fs::write(&path, content).map_err(|error| cannot(&path, error))?;
            written.push(path);
        }
        Ok(Written { files: written, remarks: self.remarks })
    }
}

/// Writes a system into a folder, which is made where there is none.
///
/// `name` is the name of functions and files: letters, digits and underscores, a letter first.
/// With the source goes a test vector, made by the simulation itself, and a program that
/// compares with it to 1e-9 of each output's largest value.
///
/// # Errors
///
/// If the system does not fit together or has no sampling time, the name cannot be used, the
/// test vector cannot be simulated, or a file cannot be written.
///
/// # Example
///
/// ```
/// use lacuna_core::system::{Sampling, System};
/// use lacuna_export::{Target, export};
/// use lacuna_plugins::systems::Duffing;
///
/// let model = Duffing { mass: 1.0, damping: 0.5, stiffness: 100.0, hardening: 9.0, fixed: vec![] };
/// let sampling = Sampling { sampling_time: Some(0.01), ..Sampling::default() };
/// let folder = std::env::temp_dir().join("lacuna-export-example");
/// let written = export(&System::new(model, sampling), Target::C, "spring", &folder)?;
/// assert!(written.files.contains(&folder.join("spring.c")));
/// # Ok::<(), lacuna_export::ExportError>(())
/// ```
pub fn export(
    system: &System,
    target: Target,
    name: &str,
    folder: &Path,
) -> Result<Written, ExportError> {
    sources(system, target, name)?.write(folder)
}

/// What [`export`] writes, before it is written.
///
/// # Errors
///
/// As [`export`], but for files.
#[doc(hidden)]
pub fn sources(system: &System, target: Target, name: &str) -> Result<Sources, ExportError> {
    if !names::is_usable(name) {
        return Err(ExportError::Name(name.into()));
    }
    let step = system.recorded(system.sampling_time(None)?)?;
    let vector = Vector::of(system, &step)?;
    let model = Model { name, step: &step, vector: &vector };
    let mut remarks = vec![];
    if !step.fixed.is_empty() {
        let names: Vec<&str> = step.fixed.iter().map(|p| p.name.as_str()).collect();
        remarks.push(format!(
            "Constants in the exported model, as they are computed with before the run: {}.",
            names.join(", ")
        ));
    }
    let files = match target {
        Target::C => c::files(&model),
        Target::Python => python::files(&model),
        Target::Matlab => matlab::files(&model),
        Target::Fmu => fmu::files(&model, &mut remarks)?,
    };
    Ok(Sources { files, remarks })
}
