//! What a report draws of a finding: signals of the records, of the test, and laws as curves.

/// Series that the report draws.
#[derive(Debug, Clone, Default)]
pub struct Series {
    /// Sampling time in s.
    pub sampling_time: f64,
    /// Name and unit of every output.
    pub outputs: Vec<(String, String)>,
    /// Name and unit of every input, and its values.
    pub inputs: Vec<(String, String, Vec<f64>)>,
    /// Measured outputs on the estimation data.
    pub measured: Vec<Vec<f64>>,
    /// Simulated by the baseline.
    pub before: Vec<Vec<f64>>,
    /// Simulated by the extended model.
    pub after: Vec<Vec<f64>>,
    /// Stretches of the estimation data that were simulated without a break.
    pub segments: Vec<std::ops::Range<usize>>,
    /// First sample of the part that chose.
    pub split: usize,
    /// Flagged samples per output.
    pub flagged: Vec<Vec<usize>>,
    /// One picture per cause: the missing quantity against the coordinate.
    pub curves: Vec<Curve>,
    /// The data that neither fitted nor chose anything.
    pub test: TestSeries,
}

/// Signals on the data that score: samples that find the initial state are left out.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TestSeries {
    /// Samples of the first record before the first one here.
    pub skipped: usize,
    /// Where the samples of each record begin.
    pub begins: Vec<usize>,
    /// Every input, one record after the other.
    pub inputs: Vec<Vec<f64>>,
    /// Measured outputs; NaN where nothing was measured.
    pub measured: Vec<Vec<f64>>,
    /// Simulated by the baseline.
    pub before: Vec<Vec<f64>>,
    /// Simulated by the extended model.
    pub after: Vec<Vec<f64>>,
}

/// The missing quantity against the coordinate that it depends on.
#[derive(Debug, Clone, Default)]
pub struct Curve {
    /// Cause it belongs to; where there is none, the curve that comes nearest to what is left.
    pub cause: usize,
    /// Coordinate and unit.
    pub coordinate: (String, String),
    /// Channel and unit.
    pub channel: (String, String),
    /// Coordinate values of the fitted law, and its values.
    pub law: Vec<(f64, f64)>,
    /// Free curve estimated from the data: coordinate, value, standard error.
    pub knots: Vec<(f64, f64, f64)>,
    /// 95 % band of the law: coordinate, low, high. Empty where errors of its numbers are not known.
    pub band: Vec<(f64, f64, f64)>,
    /// Other laws that were fitted in its place, the most probable first.
    pub others: Vec<OtherLaw>,
    /// Of a law of two coordinates: where the other one is held, in words, and the law there.
    pub slices: Vec<(String, Vec<(f64, f64)>)>,
}

/// A law that the search fitted at the place of the one that was named.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct OtherLaw {
    /// Its effect, or the effects that it is a sum of.
    pub effects: Vec<String>,
    /// Probability that its first effect is at work there.
    pub probability: f64,
    /// Coordinate and value, with the numbers that the search ended with.
    pub law: Vec<(f64, f64)>,
}
