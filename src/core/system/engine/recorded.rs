//! One integration step written down as it is simulated.

use super::super::lane::Lane;
use super::super::plan::{Plan, Way};
use super::super::recorded::{Recorded, Remembered};
use super::super::sampling::Hold;
use super::Run;
use crate::model::Law;
use crate::real::{Given, Node, Real, Tape, Trace};

/// Runs one step of `plan` with numbers that write down what is done with them.
///
/// `parameters` are the model's that may change, by their number in its list; those of effects come after
/// them, those that are not finite being constants.
pub(crate) fn record(law: &dyn Law, plan: &Plan, parameters: &[usize]) -> Recorded {
    let lane = Lane {
        theta: plan.signals.theta(),
        starts: vec![plan.signals.initial()],
        effect_values: plan.effect_values(),
        ..Lane::default()
    };
    let (mut recorded, tape) = Tape::record(|| step(law, plan, &lane, parameters));
    recorded.tape = tape;
    recorded
}

fn step(law: &dyn Law, plan: &Plan, lane: &Lane, parameters: &[usize]) -> Recorded {
    let lanes = std::slice::from_ref(lane);
    let groups = [(plan, lanes)];
    let mut recorded = Recorded::default();
    let Some(mut run) = Run::<Trace>::new(law, &groups) else { return recorded };
    let mut count = 0;
    let mut parameter = |value: f64| {
        count += 1;
        Trace::given(Given::Parameter(count - 1), value)
    };
    for &i in parameters {
        run.theta[i] = parameter(lane.theta[i]);
    }
    let effect_parameter = |&value: &f64| match value.is_finite() {
        true => parameter(value),
        false => Trace::constant(value),
    };
    let effect_values: Vec<Trace> = lane.effect_values.iter().map(effect_parameter).collect();
    for slot in &plan.slots {
        if let Way::Value(p) = slot.way {
            run.theta[p] = effect_values[slot.first_parameter];
        }
    }
    run.theta_now.copy_from_slice(&run.theta);
    run.groups[0].take_effect_values(effect_values);
    run.start(&groups, 0);

    recorded.remembered = run.give_states();
    let h = plan.step();
    give_inputs(&mut run, plan);
    run.drift(0.0);
    for group in &mut run.groups {
        group.inputs(&mut run.u, h);
    }
    run.output(h);
    recorded.outputs = run.y.iter().map(|&y| root(y)).collect();
    run.advance(h);
    let after = run.remembered();
    recorded.next = after.into_iter().map(|value| root(*value)).collect();
    recorded
}

/// Puts inputs that are given in the place of those of a run, as they are held or move along straight lines.
pub(super) fn give_inputs(run: &mut Run<'_, Trace>, plan: &Plan) {
    for i in 0..plan.sizes.u {
        let now = Trace::given(Given::Input(i as u32), 0.0);
        let next = Trace::given(Given::Next(i as u32), 0.0);
        let begun = Trace::given(Given::Substep, 0.0);
        for (slot, at) in [0.0, 0.5, 1.0].into_iter().enumerate() {
            let share = (begun + at) / plan.substeps as f64;
            run.u[slot][i] = match plan.hold {
                Hold::Zero => now,
                Hold::First => now + (next - now) * share,
            };
        }
        if run.ramped {
            run.ramp[i] = next - now;
        }
    }
    run.w.copy_from_slice(&run.ramp);
}

/// The term of a number on the tape that is being recorded, also of a constant.
pub(super) fn root(value: Trace) -> Node {
    value.noted().unwrap_or_default()
}

impl Run<'_, Trace> {
    /// All numbers that are kept from step to step, delay lines apart: the model's states, then
    /// the effects' in the order of [`Group::remembered`](super::super::group::Group::remembered).
    pub(super) fn remembered(&mut self) -> Vec<&mut Trace> {
        let own = self.x.iter_mut();
        own.chain(self.groups.iter_mut().flat_map(|group| group.remembered())).collect()
    }

    /// Puts what is given in their place.
    pub(super) fn give_states(&mut self) -> Vec<Remembered> {
        let states = &self.base.signals.states;
        let own: Vec<_> = states.iter().map(|s| Some(s.signal.clone())).collect();
        let each = self.remembered().into_iter().enumerate().map(|(i, value)| {
            let initial = value.value();
            *value = Trace::given(Given::State(i as u32), initial);
            Remembered { signal: own.get(i).cloned().flatten(), initial }
        });
        each.collect()
    }
}
