//! Repeats the whole over seeds, starts and hidden effects.
//!
//! [`Generate`] makes records whose truth is known. A [`MonteCarlo`] trains one model from
//! several starts with several seeds; its [`Job`]s can be shared among machines, and what
//! comes out does not depend on how they were shared. [`NoiseStudy`] tells how far each
//! start's encoder is from the states at several noise levels. An [`Exam`] hides effects in
//! machines and marks what the diagnosis makes of their records.

use lacuna_core::{
    data, digits, effect, evaluate, fault, file, model, register, statistics, system, watch,
};
use lacuna_diagnose as diagnose;
use lacuna_learn::{encoder, train};
use lacuna_report as report;

mod error;
mod exam;
mod figures;
mod generate;
mod job;
mod monte_carlo;
mod noise_study;
mod rehearse;
mod result;
mod run;
mod share;

pub use error::StudyError;
pub use exam::Exam;
pub use generate::Generate;
pub use monte_carlo::MonteCarlo;
pub use noise_study::NoiseStudy;
pub use rehearse::Rehearsal;

// machinery that sibling crates and the program share; it may change at any time
#[doc(hidden)]
pub use self::{
    exam::{
        Answer, Answered, Answers, Calibration, Case, CaseFile, CaseTruth, Concealed, Conditions,
        ExamResult, Hidden, Hit, Kind, Machine, Marked, Marks, Named, Noise, Number, Outside,
        Tally, UnknownName, Written,
    },
    figures::StudyReport,
    generate::Generated,
    generate::Truth,
    job::{Done, Frame, Job},
    monte_carlo::{Inputs, Start},
    noise_study::Level,
    rehearse::Rehearsed,
    result::{Quartiles, StudyResult, Summary},
    share::Share,
};

/// What shard `i` of `n`, counted from 1, does of some work: every n-th piece.
fn shard<T>(work: Vec<T>, i: usize, n: usize) -> Result<Vec<T>, StudyError> {
    if i == 0 || i > n {
        return Err(StudyError::setting("shard", format!("{i}/{n}"), "1/n up to n/n"));
    }
    Ok(work.into_iter().skip(i - 1).step_by(n).collect())
}
