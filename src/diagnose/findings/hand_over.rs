//! The hand-over from a search to its finding, and how a finding is made of it.

use std::collections::BTreeMap;

use crate::data_faults::Fault;
use crate::findings::cause::{Alternative, Cause, MissingForce};
use crate::findings::closed_loop::ClosedLoop;
use crate::findings::distortion::Distortion;
use crate::findings::error_band::Regime;
use crate::findings::finding::SingleRecord;
use crate::findings::finding::{
    FalseDiscovery, Finding, Gain, Left, NotFound, OtherTrack, Ranked, RecordFacts, Scores,
    Verdict, Withdrawn,
};
use crate::findings::note::Note;
use crate::findings::series::Series;
use crate::fit::hypothesis::Track;
use crate::system::System;
use crate::validate::ahead::Ahead;
use crate::validate::noise_floor::NoiseFloor;

/// What one search over records without faults ended with. Fields are those of [`Finding`].
pub(crate) struct Searched {
    pub verdict: Verdict,
    pub verdict_probability: Option<f64>,
    pub causes: Vec<Cause>,
    pub suspected: Vec<Alternative>,
    pub withdrawn: Vec<Withdrawn>,
    pub track: Track,
    pub other_track: Option<OtherTrack>,
    pub held: Vec<String>,
    pub noise_floor: BTreeMap<String, NoiseFloor>,
    pub before: Scores,
    pub after: Scores,
    pub false_discovery: Option<FalseDiscovery>,
    pub gain: Gain,
    pub ahead: Option<Ahead>,
    pub left: BTreeMap<String, Left>,
    pub dependence: f64,
    pub missing: Vec<MissingForce>,
    pub ranking: Vec<Ranked>,
    pub not_found: Vec<NotFound>,
    pub regime: BTreeMap<String, Regime>,
    pub closed_loop: Option<ClosedLoop>,
    pub notes: Vec<Note>,
    pub series: Series,
    pub extended: System,
    /// Whether causes were judged by innovations: what free runs leave then says nothing of them.
    pub by_innovations: bool,
}

/// What was found before it is put together.
pub(crate) struct Looked {
    pub searched: Searched,
    pub faults: Vec<Fault>,
    pub notes: Vec<Note>,
    pub single_records: Vec<SingleRecord>,
}

/// What is known of the records beside the search.
pub(crate) struct Around {
    /// Faults of the data that were mended before the search, or noticed after it.
    pub faults: Vec<Fault>,
    /// What holds of the records whatever was found.
    pub notes: Vec<Note>,
    pub single_records: Vec<SingleRecord>,
    pub distortion: BTreeMap<String, Distortion>,
    pub record: RecordFacts,
    pub interrupted: bool,
    pub seconds: f64,
}

impl Searched {
    /// The same with one more explanation that cannot be told from the first cause.
    #[must_use]
    pub fn or_else(mut self, other: Alternative) -> Self {
        if let Some(first) = self.causes.first_mut() {
            first.indistinguishable.push(other);
        }
        self
    }

    /// The finding. Faults of the data that explain what the model gets wrong come before causes in
    /// the machine, samples that were left out after them.
    pub fn finding(self, around: Around) -> Finding {
        let (first, last): (Vec<&Fault>, Vec<&Fault>) =
            around.faults.iter().partition(|fault| fault.explains());
        let before = first.len();
        let curves = self.series.curves.into_iter();
        let curves = curves.map(|curve| crate::Curve { cause: curve.cause + before, ..curve });
        let causes = first.into_iter().map(Fault::cause).chain(self.causes);
        let verdict = match self.verdict {
            Verdict::NothingFound | Verdict::Unexplained if !around.faults.is_empty() => {
                Verdict::DataFault
            }
            verdict => verdict,
        };
        Finding {
            verdict,
            verdict_probability: self.verdict_probability,
            causes: causes.chain(last.into_iter().map(Fault::cause)).collect(),
            suspected: self.suspected,
            withdrawn: self.withdrawn,
            track: self.track,
            other_track: self.other_track,
            held: self.held,
            record: around.record,
            noise_floor: self.noise_floor,
            before: self.before,
            after: self.after,
            false_discovery: self.false_discovery,
            gain: self.gain,
            ahead: self.ahead,
            left: self.left,
            dependence: self.dependence,
            missing: self.missing,
            ranking: self.ranking,
            not_found: self.not_found,
            distortion: around.distortion,
            regime: self.regime,
            single_records: around.single_records,
            closed_loop: self.closed_loop,
            notes: around.notes.into_iter().chain(self.notes).collect(),
            interrupted: around.interrupted,
            seconds: around.seconds,
            extended: self.extended,
            series: Series { curves: curves.collect(), ..self.series },
        }
    }
}
