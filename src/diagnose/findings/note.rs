//! What else a diagnosis has to say, as data; `report` makes sentences of it.

use crate::findings::value::Value;
use crate::memory::Memory;

/// One thing worth knowing beside the causes.
#[derive(Debug, Clone, PartialEq)]
pub enum Note {
    /// The model does not forget its start: the record was cut into stretches.
    Stretches {
        /// Samples of a stretch.
        length: usize,
        /// The same in s.
        seconds: f64,
        /// Stretches used.
        count: usize,
    },
    /// What is named begins within the record.
    Begins {
        /// When, by the record's clock in s.
        time: f64,
        /// Samples, from about then on, that the finding is about.
        samples: usize,
    },
    /// The records are longer than memory holds, or than is worth the time: stretches of them were looked at.
    Thinned {
        /// Samples looked at.
        samples: usize,
        /// Samples there are.
        of: usize,
        /// Stretches.
        stretches: usize,
        /// Memory that was allowed, and what all samples would take, about; `None` where memory would do.
        memory: Option<(Memory, Memory)>,
    },
    /// There are too few samples for all parameters to move at once.
    TooManyParameters {
        /// Parameters that are not held.
        parameters: usize,
        /// Samples that are fitted.
        samples: usize,
    },
    /// Memory did not hold the effects of all laws side by side.
    LawsLeftOut {
        /// Laws that were judged alone only.
        laws: usize,
        /// Laws there are.
        of: usize,
        /// Memory that was allowed.
        memory: Memory,
        /// Memory that all laws would take, about.
        whole: Memory,
    },
    /// Simulating all laws was too much work: they were ranked to first order, and the leading ones
    /// simulated.
    LawsRanked {
        /// Laws that were only ranked.
        laws: usize,
        /// Laws there are.
        of: usize,
    },
    /// Smoothing the missing force of every channel was too much work: those were asked that the records
    /// call for most.
    ForcesLeftOut {
        /// Channels that were asked.
        channels: usize,
        /// Channels there are.
        of: usize,
    },
    /// What the simulation leaves of an output is no more than its own error, of the integrator and
    /// of rounding.
    Unresolved {
        /// The output.
        output: String,
        /// What is left, rms.
        left: f64,
        /// The simulation's own error, rms.
        error: f64,
        /// Unit of both.
        unit: String,
    },
    /// Inputs that do not move: nothing that depends on them can show.
    NoExcitation {
        /// The inputs.
        inputs: Vec<String>,
        /// Whether that is all inputs.
        all: bool,
    },
    /// The record has few samples for the numbers that are asked of it.
    FewSamples {
        /// Samples that were fitted and chosen on.
        samples: usize,
        /// Free parameters and states of the model.
        unknowns: usize,
    },
    /// An output does not complete one period.
    LessThanAPeriod {
        /// The output.
        output: String,
        /// How often it crosses its mean.
        crossings: usize,
    },
    /// What is left depends on the inputs although causes are named.
    NotAll {
        /// Score of the dependence.
        score: f64,
    },
    /// Several causes: each set of look-alikes holds for the others as named.
    JointLookAlikes,
    /// The search stopped at the largest number of causes allowed.
    MostCauses,
    /// Standard errors allow for all parameters to be wrong.
    AllParametersDoubted {
        /// Standard deviation of a parameter that may be wrong, as a share of its value.
        prior: f64,
    },
    /// Standard errors allow for parameters that no cause names to be wrong, by how probable it is.
    ParametersDoubted {
        /// Probability that they are.
        doubt: f64,
        /// Standard deviation of a parameter that may be wrong, as a share of its value.
        prior: f64,
    },
    /// The width of friction at rest is not resolved.
    WidthUnresolved {
        /// Its channel.
        into: String,
        /// Upper end of the 95 % interval.
        at_most: f64,
        /// Unit.
        unit: String,
    },
    /// The coordinate of friction keeps its sign.
    KeepsItsSign {
        /// The channel.
        into: String,
        /// The coordinate.
        of: Option<String>,
    },
    /// Dry friction and a constant of one channel are friction that differs by direction.
    ByDirection {
        /// The channel.
        into: String,
        /// The velocity.
        of: Option<String>,
        /// Friction where the velocity is positive, and where it is negative.
        sides: [Value; 2],
    },
    /// A parameter that is held explains what is named as well, or better.
    Held {
        /// Which, and what each of them alone would be.
        released: Vec<Released>,
        /// Logarithm of the odds of the best of them against what is named.
        odds: f64,
        /// Causes that are named.
        named: usize,
    },
    /// The noise of an output is not of one level.
    NoiseLevel {
        /// The output.
        output: String,
        /// Its standard deviation where it is low, and where it is high.
        low: f64,
        /// See `low`.
        high: f64,
        /// Unit of both.
        unit: String,
        /// What the level follows.
        follows: Follows,
        /// Samples without weight, far beyond the usual level.
        left_out: usize,
    },
    /// The noise of an output has heavy tails.
    HeavyTails {
        /// The output.
        output: String,
        /// Degrees of freedom of Student's t density.
        freedom: f64,
        /// Samples without weight, far beyond the usual level.
        left_out: usize,
    },
    /// Parameters of which the record tells less than all: what they can do together unseen, in words.
    Undetermined {
        /// `changing b by +1.00 x, c by -1.00 x together changes nothing that was measured`.
        parameters: String,
    },
    /// Parameters that are named make up for each other.
    ParametersMakeUp {
        /// Share of the removable error that all remove together.
        removed: f64,
        /// Sum of the shares of each, over that.
        each: f64,
    },
    /// Noise inside the plant, and sensors that wander: what is not explained by causes.
    Inside {
        /// All of it.
        disturbances: Vec<Disturbance>,
    },
    /// No cause was good enough; a curve of this coordinate comes nearest.
    Nearest {
        /// Channel.
        into: String,
        /// Coordinate.
        of: String,
        /// Share of what is left that it predicts where it was not fitted.
        share: f64,
    },
}

/// What the level of a noise follows.
#[derive(Debug, Clone, PartialEq)]
pub enum Follows {
    /// Time: it grows or falls in the course of the record.
    Time,
    /// The size of a signal.
    Signal(String),
    /// Itself: it comes in bursts.
    Itself,
}

/// A held parameter that was let go.
#[derive(Debug, Clone, PartialEq)]
pub struct Released {
    /// Its name.
    pub name: String,
    /// Its value, or how fast it changes.
    pub value: f64,
    /// Standard error of that.
    pub std_error: Option<f64>,
    /// Value in the model.
    pub stated: f64,
    /// Unit of `value`.
    pub unit: String,
    /// Whether it changes in the course of the record.
    pub drifts: bool,
}

/// Noise that is not the white noise of a sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct Disturbance {
    /// Channel, input or output.
    pub place: String,
    /// What it is.
    pub kind: Disturbs,
    /// Standard deviation: of a force anew in each sample, or of one that swings; of the change of a slow force, or of
    /// a reading, from sample to sample.
    pub size: f64,
    /// Unit.
    pub unit: String,
}

/// How a disturbance goes with time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Disturbs {
    /// A force, or what acts beside a recorded input, anew in every sample.
    White,
    /// A force that changes slowly.
    Slow,
    /// A force of a narrow band, which swings about once in a period, in s.
    Cycle { period: f64 },
    /// A reading that wanders.
    Wander,
}
