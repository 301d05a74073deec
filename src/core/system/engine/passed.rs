//! Inputs behind what remembers them in their paths, worked out once along a record.
//!
//! ```text
//! u'(t) = P(u(s), s <= t)
//! ```
//!
//! Nothing but the recorded input enters P (a lag, a delay, play), so that u' is as known as u is.

use super::super::group::Group;
use super::super::lane::{Drive, Lane};
use super::super::plan::{Plan, Way};
use super::super::sampling::Hold;
use super::super::wiring::EffectNumber;
use super::Run;
use crate::effect::Mechanism;
use crate::model::LaneNumber;
use crate::real::{F64x8, Real};

/// Inputs behind their paths at the start, middle and end of every integration step.
#[derive(Debug)]
pub(super) struct Passed {
    /// Sample by sample, step by step: the start of every input, then, unless they are held, middle and end.
    values: Vec<f64>,
    /// Inputs, values of each in a step, steps of a sample.
    inputs: usize,
    slots: usize,
    substeps: usize,
}

impl Passed {
    /// Those of a lane; `None` where no path of an input remembers anything.
    pub fn of(plan: &Plan, drive: &Drive, lane: &Lane) -> Option<Self> {
        let remembers = plan.slots.iter().any(|slot| {
            let own = slot.card.mechanism;
            matches!(slot.way, Way::InputPath(_))
                && matches!(own, Mechanism::Lag | Mechanism::Delay | Mechanism::Play)
        });
        if !remembers {
            return None;
        }
        let mut group = Group::<F64x8>::new(plan, std::slice::from_ref(lane), 0);
        let inputs = plan.sizes.u;
        let slots = if plan.hold == Hold::Zero { 1 } else { 3 };
        let each = inputs * slots * plan.substeps;
        let mut values = vec![0.0; drive.len() * each];
        let mut u = [0, 1, 2].map(|_| vec![F64x8::constant(0.0); group.packs * inputs]);
        for segment in &drive.segments {
            group.restart();
            for k in segment.clone() {
                let to = &mut values[k * each..][..each];
                for (j, to) in to.chunks_exact_mut(inputs * slots).enumerate() {
                    for (i, three) in recorded(drive, plan, (k, segment.end), j).enumerate() {
                        u.iter_mut()
                            .zip(three)
                            .for_each(|(u, value)| u[i] = F64x8::constant(value));
                    }
                    group.inputs(&mut u, plan.step());
                    group.started();
                    for (to, u) in to.chunks_exact_mut(inputs).zip(&u) {
                        to.iter_mut().zip(u).for_each(|(to, u)| *to = u.lane(0));
                    }
                }
            }
        }
        Some(Self { values, inputs, slots, substeps: plan.substeps })
    }

    /// Input `i` at the start (`slot` 0), middle or end of step `j` of sample `k`.
    pub fn value(&self, (k, j): (usize, usize), slot: usize, i: usize) -> f64 {
        let step = (k * self.substeps + j) * self.slots + slot.min(self.slots - 1);
        self.values[step * self.inputs + i]
    }

    /// Puts the inputs of a step in the place of those of a run.
    pub fn put<R: EffectNumber>(&self, at: (usize, usize), u: &mut [Vec<R>; 3]) {
        for (slot, u) in u.iter_mut().enumerate() {
            for pack in u.chunks_exact_mut(self.inputs) {
                for (i, to) in pack.iter_mut().enumerate() {
                    *to = R::constant(self.value(at, slot, i));
                }
            }
        }
    }
}

impl<R: EffectNumber> Run<'_, R> {
    /// Inputs at the start, middle and end of step `j`.
    pub(super) fn drive(&mut self, drive: &Drive, k: usize, end: usize, j: usize) {
        let base = self.base;
        let next = if k + 1 < end { k + 1 } else { k };
        if self.ramped {
            for pack in 0..self.packs {
                let to = &mut self.ramp[pack * base.sizes.w..][..base.sizes.w];
                for (to, series) in to.iter_mut().zip(&drive.inputs) {
                    *to = R::constant(series[next] - series[k]);
                }
            }
            self.w.copy_from_slice(&self.ramp);
        }
        if base.hold == Hold::Zero && j > 0 && !self.groups.iter().any(|g| g.has_input_paths()) {
            return; // still there from the first step
        }
        for (i, three) in recorded(drive, base, (k, end), j).enumerate() {
            for (u, value) in self.u.iter_mut().zip(three) {
                for pack in 0..self.packs {
                    u[pack * base.sizes.u + i] = R::constant(value);
                }
            }
        }
    }
}

/// Every input as it is recorded, at the start, middle and end of step `j` of sample `k`.
fn recorded<'a>(
    drive: &'a Drive,
    plan: &'a Plan,
    (k, end): (usize, usize),
    j: usize,
) -> impl Iterator<Item = [f64; 3]> + 'a {
    let next = if k + 1 < end { k + 1 } else { k };
    drive.inputs.iter().map(move |series| {
        [0.0, 0.5, 1.0].map(|at| {
            let share = (j as f64 + at) / plan.substeps as f64;
            match plan.hold {
                Hold::Zero => series[k],
                Hold::First => series[k] + (series[next] - series[k]) * share,
            }
        })
    })
}
