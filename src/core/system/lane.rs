//! What one lane of a simulation is given and what it gives back.

use std::ops::Range;

use crate::model::LaneNumber;

/// The inputs of a record, and the stretches over which they are known.
#[derive(Debug, Clone)]
pub struct Drive {
    /// One series per input.
    pub inputs: Vec<Vec<f64>>,
    /// Runs of samples that are simulated without a break.
    pub segments: Vec<Range<usize>>,
    /// Time of sample 0 in s, by the clock of each segment: sample `k` is at that time and `k`
    /// steps.
    pub clocks: Vec<f64>,
}

impl Drive {
    /// Number of samples.
    pub fn len(&self) -> usize {
        self.inputs.first().map_or_else(|| self.segments.last().map_or(0, |s| s.end), Vec::len)
    }

    /// Whether it has no samples.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Another wiring of one slot, for this lane alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Route {
    /// Entry of the source table.
    pub source: usize,
    /// Entry and factor of its rate.
    pub rate: (usize, f64),
    /// Entry of the target table.
    pub target: usize,
}

/// Everything that may differ from lane to lane.
#[derive(Debug, Clone, Default)]
pub struct Lane {
    /// Parameters of the model.
    pub theta: Vec<f64>,
    /// Initial state of each segment; a missing segment starts like the one before.
    pub starts: Vec<Vec<f64>>,
    /// Parameters of the effects of all slots.
    pub effect_values: Vec<f64>,
    /// Factor on each slot's w; empty means 1.
    pub gains: Vec<f64>,
    /// Wiring of each slot where it differs from the plan's; empty means nowhere.
    pub routes: Vec<Option<Route>>,
}

/// A simulated lane.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    /// Outputs, one series each; not a number where nothing was simulated.
    pub y: Vec<Vec<f64>>,
    /// Sample at which the states stopped being finite.
    pub diverged_at: Option<usize>,
    /// Entries of the source table at every sample, where asked for.
    pub seen: Vec<Vec<f64>>,
    /// State after the last sample of the last segment.
    pub last: Vec<f64>,
}

impl Track {
    /// Whether the whole simulation stayed finite.
    pub fn is_finite(&self) -> bool {
        self.diverged_at.is_none()
    }
}

/// Spreads one value per lane over packs; lanes beyond the last repeat it.
pub fn pack<R: LaneNumber>(
    lanes: &[Lane],
    packs: usize,
    width: usize,
    get: impl Fn(&Lane, usize) -> f64,
) -> Vec<R> {
    let mut out = vec![R::constant(0.0); packs * width];
    let last = lanes.len().saturating_sub(1);
    for l in 0..packs * R::LANES {
        let Some(lane) = lanes.get(l.min(last)) else { continue };
        for i in 0..width {
            out[l / R::LANES * width + i].set_lane(l % R::LANES, get(lane, i));
        }
    }
    out
}
