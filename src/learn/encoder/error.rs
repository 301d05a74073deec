//! What can keep an encoder from being made or started.

use crate::fault::{Explain, Kind, Place, nearest};
use crate::network::NetworkError;
use crate::optimise::OptimiseError;
use crate::system::SystemError;

/// An encoder that cannot be made, started or used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum EncoderError {
    /// A baseline whose states do not show in its outputs.
    #[error(
        "the baseline cannot be observed from {samples} samples of its outputs: of {states} \
         states {rank} can be told; not {}", listed(.hidden)
    )]
    Unobservable {
        /// Names of the states that the outputs do not fix.
        hidden: Vec<String>,
        /// Rank of the observability matrix.
        rank: usize,
        /// States.
        states: usize,
        /// Samples of every output in the window.
        samples: usize,
    },
    /// An initialiser for linear baselines and one that is not.
    #[error("`{initialiser}` needs a linear baseline without effects, and `{model}` is none")]
    NotLinear {
        /// Name of the initialiser.
        initialiser: &'static str,
        /// Name of the model.
        model: String,
    },
    /// No gain of the innovation form.
    #[error("`{initialiser}` needs the gain K of an innovation form, and `{model}` has none")]
    NoGain {
        /// Name of the initialiser.
        initialiser: &'static str,
        /// Name of the model.
        model: String,
    },
    /// The baseline holds its inputs along a line.
    #[error("`{initialiser}` needs inputs that are held between samples (`hold = \"zero\"`)")]
    Hold {
        /// Name of the initialiser.
        initialiser: &'static str,
    },
    /// Nothing to linearise about.
    #[error("the baseline has no equilibrium near 0 with the inputs {inputs:?}")]
    NoEquilibrium {
        /// The inputs.
        inputs: Vec<f64>,
    },
    /// The baseline's slopes are not finite at the point.
    #[error("the baseline has no finite slope at {x:?}")]
    NoSlope {
        /// States.
        x: Vec<f64>,
    },
    /// An encoder that has no weights yet.
    #[error("the encoder has no weights yet")]
    NotReady,
    /// An encoder without a linear part.
    #[error("`{initialiser}` sets the linear part of an encoder, and `{encoder}` has none")]
    NoLinearPart {
        /// Name of the initialiser.
        initialiser: &'static str,
        /// Name of the encoder.
        encoder: String,
    },
    /// A window without samples.
    #[error("the encoder's window is empty: n_a = {n_a}, n_b = {n_b}")]
    EmptyWindow {
        /// Past outputs.
        n_a: usize,
        /// Past inputs.
        n_b: usize,
    },
    /// Numbers that do not belong together.
    #[error("{what}: {expected} are needed, {found} were given")]
    Count {
        /// What was counted.
        what: &'static str,
        /// How many there should be.
        expected: usize,
        /// How many there are.
        found: usize,
    },
    /// A setting out of its range.
    #[error("`{name}` = {value}, but it must be {expected}")]
    Setting {
        /// Name.
        name: &'static str,
        /// Value.
        value: f64,
        /// The range, in words.
        expected: &'static str,
    },
    /// The record lacks a signal of the baseline.
    #[error("{record}: the record has no {role} called `{name}`")]
    NoSignal {
        /// Name of the record.
        record: String,
        /// `input` or `output`.
        role: &'static str,
        /// The name.
        name: String,
        /// Names there are.
        known: Vec<String>,
    },
    /// Too few samples.
    #[error(
        "{record}: {windows} whole windows of {reach} past samples fit in, {needed} are needed"
    )]
    TooShort {
        /// Name of the record.
        record: String,
        /// Windows that fit.
        windows: usize,
        /// Past samples of a window.
        reach: usize,
        /// Windows needed.
        needed: usize,
    },
    /// The baseline leaves the finite numbers on the record.
    #[error("{record}: the baseline's simulation diverges at sample {sample}")]
    Diverges {
        /// Name of the record.
        record: String,
        /// Sample, 0 being the first.
        sample: usize,
    },
    /// The baseline itself is at fault.
    #[error(transparent)]
    System(#[from] SystemError),
    /// The network is.
    #[error(transparent)]
    Network(#[from] NetworkError),
    /// The optimiser is.
    #[error(transparent)]
    Optimise(#[from] OptimiseError),
}

/// `` `a`, `b` and `c` ``
fn listed(names: &[String]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match quoted.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => quoted.concat(),
    }
}

impl Explain for EncoderError {
    fn kind(&self) -> Kind {
        match self {
            Self::System(error) => error.kind(),
            Self::Network(error) => error.kind(),
            Self::Optimise(error) => error.kind(),
            Self::NoSignal { .. } | Self::TooShort { .. } => Kind::Input,
            Self::Unobservable { .. }
            | Self::Diverges { .. }
            | Self::NoEquilibrium { .. }
            | Self::NoSlope { .. } => Kind::Work,
            _ => Kind::Call,
        }
    }

    fn place(&self) -> Place {
        match self {
            Self::System(error) => error.place(),
            Self::NoSignal { record, name, .. } => {
                Place { file: Some(record.clone()), key: Some(name.clone()), ..Place::default() }
            }
            Self::TooShort { record, .. } | Self::Diverges { record, .. } => {
                Place { file: Some(record.clone()), ..Place::default() }
            }
            Self::EmptyWindow { .. } => Place { key: Some("n_a".into()), ..Place::default() },
            _ => Place::default(),
        }
    }

    fn hint(&self) -> Option<String> {
        Some(match self {
            Self::System(error) => return error.hint(),
            Self::Network(error) => return error.hint(),
            Self::Optimise(error) => return error.hint(),
            Self::Unobservable { samples, states, .. } if samples < states => {
                format!("raise `n_a` and `n_b` to at least {states}, the number of states")
            }
            Self::Unobservable { .. } => {
                "measure another output, linearise at a point where these states matter, or \
                 start with `least_squares` or `prefit`"
                    .into()
            }
            Self::NotLinear { .. } => "use `linearised`, `least_squares` or `prefit`".into(),
            Self::NoGain { .. } => {
                "give the gain in the initialiser's `gain`, or use `reconstruct`".into()
            }
            Self::Hold { .. } => "use `least_squares` or `prefit`, which need no hold".into(),
            Self::NoEquilibrium { .. } | Self::NoSlope { .. } => {
                "state a point (`x` and `u`) to linearise about".into()
            }
            Self::NotReady => "run an initialiser first".into(),
            Self::NoLinearPart { .. } => "use `random` or an encoder with a linear part".into(),
            Self::EmptyWindow { .. } => {
                "let the encoder see at least as many samples as the baseline has states".into()
            }
            Self::Count { expected, .. } => format!("hand over {expected}"),
            Self::Setting { expected, .. } => format!("set it to {expected}"),
            Self::NoSignal { name, known, .. } => {
                let list = known.join(", ");
                match nearest(name, known.iter().map(String::as_str)) {
                    Some(near) => format!("did you mean `{near}`? There are: {list}"),
                    None => format!("rename a column or the model's signal; there are: {list}"),
                }
            }
            Self::TooShort { .. } => "use fewer past samples, or a longer record".into(),
            Self::Diverges { .. } => {
                "use more substeps in `integrator`, or check parameters and initial values".into()
            }
        })
    }
}
