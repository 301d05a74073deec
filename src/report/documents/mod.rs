//! What each command answers, as one JSON document: `--json` of the program, `to_dict` of Python.
//!
//! The files in `docs/schema` say what a document holds. Names of files beside it (`model`, `page`,
//! `report`) are added by whoever writes these files.

mod check;
mod diagnosis;
mod estimate;
mod fit;
mod look;
mod simulate;

pub use check::goodness_of_fit;
pub use diagnosis::{Document, FileNames, cause_document};
pub use estimate::{estimated, linear};
pub use fit::{Fitted, fitted, scores};
pub use look::{looked, missing};
pub use simulate::simulated;
