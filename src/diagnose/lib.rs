//! Finds what a simulation gets wrong, names it and measures the gain.

use lacuna_core::{
    data, effect, evaluate, fault, model, optimise, real, register, statistics, system, watch,
};
use lacuna_plugins as plugins;

mod accept;
mod acts;
mod alone;
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
mod exchange;
mod faults;
mod feedback;
mod finding;
mod finished;
mod floor;
mod found;
mod gain;
mod grain;
mod joint;
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
mod profile;
mod prune;
mod readback;
mod records;
mod refit;
mod regime;
mod rejoin;
mod remarks;
mod remembered;
mod resembles;
mod restart;
mod ridge;
mod scan;
mod score;
mod screen;
mod search;
mod sets;
mod shapeless;
mod shown;
mod sketch;
mod smooth;
mod spikes;
mod split;
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
pub use acts::ActsWhere;
pub use alone::Alone;
pub use checked::Checked;
pub use diagnosis::Diagnosis;
pub use distortion::{AtLines, Distortion};
pub use error::DiagnoseError;
pub use feedback::ClosedLoop;
pub use finding::{
    Alternative, Cause, Curve, FalseDiscovery, Finding, Gain, Left, Moved, NoiseFloor, NotFound,
    OtherTrack, Ranked, Scores, Series, Track, Value, Verdict,
};
pub use plan::{Experiment, LookAlikes, Outlook, Planner, Supposed, Visibility};
pub use regime::Regime;
pub use shown::InRecord;
pub use words::number;
