//! A known controller run along a record: what it remembered and what it gave at every sample.

use std::ops::Range;

use super::ClosedLoop;
use crate::model::Ask;
use crate::model::probe::{Point, value};

/// What a controller did along a record.
#[derive(Debug, Clone, PartialEq)]
pub struct Replay {
    /// States of the controller before each sample, one series per state.
    pub states: Vec<Vec<f64>>,
    /// Inputs of the plant at each sample, one series per input, in their units.
    pub inputs: Vec<Vec<f64>>,
}

impl ClosedLoop {
    /// Runs the controller along what was measured: it is known, so that nothing of it has to be
    /// estimated. `inputs` are those of the closed loop, `outputs` those of the plant, one series
    /// each; every segment begins with the controller at its first state. Where an output was not
    /// measured its last value stands.
    pub fn replay(
        &self,
        inputs: &[&[f64]],
        outputs: &[&[f64]],
        segments: &[Range<usize>],
        sampling_time: f64,
    ) -> Option<Replay> {
        let wired = self.wired().as_ref().ok()?;
        let law = self.controller.law.as_ref();
        let samples = inputs.iter().chain(outputs).map(|series| series.len()).max()?;
        let sizes = wired.law;
        let mut replay = Replay {
            states: vec![vec![0.0; samples]; sizes.x],
            inputs: vec![vec![0.0; samples]; wired.plant.u],
        };
        for &(to, from) in &wired.outside {
            replay.inputs[to].copy_from_slice(inputs[from]);
        }
        let references = self.controller.references.len();
        let initial = law.signals().initial();
        for segment in segments {
            let mut at = Point {
                theta: wired.theta.clone(),
                x: initial.clone(),
                u: vec![0.0; sizes.u],
                w: vec![0.0; sizes.w],
                time: 0.0,
            };
            for k in segment.clone() {
                at.time = k as f64 * sampling_time;
                for (to, series) in at.u.iter_mut().zip(&inputs[..references]) {
                    *to = series[k];
                }
                for (to, &output) in at.u[references..].iter_mut().zip(&wired.measured) {
                    if outputs[output][k].is_finite() {
                        *to = outputs[output][k];
                    }
                }
                for (series, value) in replay.states.iter_mut().zip(&at.x) {
                    series[k] = *value;
                }
                let given = value(law, sizes, Ask::Output, &at);
                for (i, &(to, added)) in wired.drives.iter().enumerate() {
                    replay.inputs[to][k] = given[i] + added.map_or(0.0, |from| inputs[from][k]);
                }
                at.x = value(law, sizes, Ask::Derivative, &at);
            }
        }
        Some(replay)
    }
}
