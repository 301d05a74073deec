//! Finds what a simulation gets wrong, names it and measures the gain.

use lacuna_core::{
    data, digits, effect, evaluate, fault, look, model, optimise, real, register, statistics,
    system, watch,
};
use lacuna_estimate as estimate;
use lacuna_fourier as fourier;
use lacuna_likelihood as likelihood;
use lacuna_plugins as plugins;

mod candidates;
mod clocked;
mod criteria;
mod data_faults;
mod diagnosis;
mod error;
mod evidence;
mod final_fit;
mod findings;
mod finer_steps;
mod fit;
mod guard;
mod innovations;
mod memory;
mod mended;
mod names;
mod onset;
mod plan;
mod prepare;
mod run;
mod search;
mod segmentation;
mod single_records;
mod validate;

pub use crate::watch::Watch;
pub use diagnosis::Diagnosis;
pub use error::DiagnoseError;
pub use findings::active_range::ActsWhere;
pub use findings::cause::{
    Alternative, Cause, ColumnFault, ExplainedBy, FoundShape, LawPart, MissingForce, MostLike,
    Onset, Site, Unweighed, Value, Wording,
};
pub use findings::closed_loop::ClosedLoop;
pub use findings::distortion::{AtLines, Distortion, distortion};
pub use findings::error_band::Regime;
pub use findings::finding::{
    FalseDiscovery, Finding, Gain, Left, NotFound, OtherTrack, Ranked, RecordFacts, Scores,
    SingleRecord, Verdict, Withdrawn,
};
pub use findings::note::{Disturbance, Disturbs, Follows, Note, Released};
pub use findings::per_record::InRecord;
pub use findings::series::{Curve, OtherLaw, Series, TestSeries};
pub use fit::hypothesis::{Moved, Track};
pub use memory::Memory;
pub use plan::{Experiment, LookAlikes, Outlook, Planner, Supposed, Visibility};
pub use validate::ahead::Ahead;
pub use validate::goodness_of_fit::GoodnessOfFit;
pub use validate::noise_floor::NoiseFloor;
