//! Finds what a simulation gets wrong, names it and measures the gain.

use lacuna_core::{
    data, digits, effect, evaluate, fault, model, optimise, real, register, statistics, system,
    watch,
};
use lacuna_estimate as estimate;
use lacuna_likelihood as likelihood;
use lacuna_plugins as plugins;

mod acts;
mod adequacy;
mod alone;
mod candidate;
mod cause;
mod causes;
mod certify;
mod checked;
mod clocked;
mod coordinate;
mod criteria;
mod curves;
mod dependence;
mod diagnosis;
mod distortion;
mod doubt;
mod error;
mod evidence;
mod excitation;
mod faults;
mod features;
mod feedback;
mod finding;
mod finished;
mod fitted;
mod floor;
mod found;
mod gain;
mod grain;
mod innovations;
mod keys;
mod library;
mod limits;
mod measure;
mod mended;
mod method;
mod moved;
mod naming;
mod network_start;
mod nominal;
mod note;
mod nuisance;
mod overlap;
mod places;
mod plan;
mod posterior;
mod precision;
mod prepared;
mod probes;
mod problem;
mod profile;
mod readback;
mod records;
mod refit;
mod regime;
mod remarks;
mod remembered;
mod resembles;
mod resolution;
mod restart;
mod ridge;
mod run;
mod score;
mod screen;
mod searched;
mod shown;
mod sketch;
mod smooth;
mod spikes;
mod story;
mod stretches;
mod sums;
mod supposed;
mod surface;
mod tell;
mod teller;
mod tensor;
mod together;
mod track;
mod withdrawn;

pub use crate::watch::Watch;
pub use acts::ActsWhere;
pub use cause::{
    Alternative, Cause, ColumnFault, ExplainedBy, FoundShape, LawPart, MissingForce, Onset, Site,
    Value, Withdrawn, Wording,
};
pub use checked::Checked;
pub use diagnosis::Diagnosis;
pub use distortion::{AtLines, Distortion, distortion};
pub use error::DiagnoseError;
pub use feedback::ClosedLoop;
pub use finding::{
    Alone, Curve, FalseDiscovery, Finding, Gain, Left, NotFound, OtherTrack, Ranked, RecordFacts,
    Scores, Series, Verdict,
};
pub use floor::NoiseFloor;
pub use note::{Disturbance, Disturbs, Note};
pub use plan::{Experiment, LookAlikes, Outlook, Planner, Supposed, Visibility};
pub use regime::Regime;
pub use shown::InRecord;
pub use story::{Moved, Track};
