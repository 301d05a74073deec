//! Finds what a simulation gets wrong, names it and measures the gain.

mod accept;
mod believe;
mod candidate;
mod causes;
mod certify;
mod checked;
mod curves;
mod dependence;
mod diagnosis;
mod distortion;
mod error;
mod faults;
mod finding;
mod finished;
mod floor;
mod grain;
mod learned;
mod library;
mod limits;
mod measure;
mod nominal;
mod nuisance;
mod pairs;
mod places;
mod plan;
mod precision;
mod prepared;
mod probes;
mod problem;
mod prune;
mod readback;
mod records;
mod remarks;
mod resembles;
mod ridge;
mod scan;
mod score;
mod screen;
mod search;
mod sets;
mod shapeless;
mod sketch;
mod smooth;
mod spikes;
mod stage;
mod stretches;
mod surface;
mod teller;
mod tensor;
mod together;
mod track;
mod train;
mod words;

pub use crate::watch::Watch;
pub use checked::Checked;
pub use diagnosis::Diagnosis;
pub use distortion::{AtLines, Distortion};
pub use error::DiagnoseError;
pub use finding::{
    Alternative, Cause, Curve, FalseDiscovery, Finding, Gain, Left, Moved, NoiseFloor, NotFound,
    OtherTrack, Ranked, Scores, Series, Track, Value, Verdict,
};
pub use plan::{Experiment, LookAlikes, Outlook, Planner, Supposed, Visibility};
pub(crate) use words::number;
