//! What a filter asks of a step, written down: outputs, the table of sources, the states at its end.

use super::super::group::Group;
use super::super::lane::Lane;
use super::super::plan::Plan;
use super::super::wiring::Wiring;
use super::{Run, recorded};
use crate::model::Law;
use crate::real::{Given, Node, Real, Trace};

/// Terms of what a filter asks for.
pub(super) struct Asked {
    pub outputs: Vec<Node>,
    pub sources: Vec<Node>,
    pub next: Vec<Node>,
    /// Values of the parameters that are given.
    pub theta: Vec<f64>,
}

/// Writes down a step: the first `parameters` of the model are given, then what enters own channels and inputs.
pub(super) fn asked(
    law: &dyn Law,
    (plan, lane): (&Plan, &Lane),
    parameters: usize,
    is_passed: bool,
) -> Option<Asked> {
    let groups = [(plan, std::slice::from_ref(lane))];
    let mut run = Run::<Trace>::new(law, &groups)?;
    let n = plan.sizes;
    (run.inside, run.into_inputs) = (true, true);
    run.groups.iter_mut().for_each(|group| group.inside = true);
    for (i, value) in run.theta.iter_mut().enumerate().take(parameters) {
        *value = Trace::given(Given::Parameter(i as u32), value.value());
    }
    run.theta_now.copy_from_slice(&run.theta);
    let theta = run.theta[..parameters].iter().map(|value| value.value()).collect();
    let force = |i: usize| Trace::given(Given::Parameter((parameters + i) as u32), 0.0);
    let forces = n.w + n.u;
    let into = [0..n.w, n.w..forces, forces..forces + run.read.len()];
    run.noise = Some(into.map(|each| each.map(force).collect()));
    run.start(&groups, 0);
    for (i, state) in states(&mut run).into_iter().enumerate() {
        *state = Trace::given(Given::State(i as u32), state.value());
    }
    recorded::give_inputs(&mut run, plan);
    let h = plan.step();
    run.drift(0.0);
    match is_passed {
        true => give_passed(&mut run.u, n.u),
        false => run.groups.iter_mut().for_each(|group| group.inputs(&mut run.u, h)),
    }
    let before: Vec<Trace> = run.groups[0].outputs.remembered().flatten().map(|v| *v).collect();
    run.output(h);
    if !run.fine {
        // an output is read once a sample
        let kept = run.groups[0].outputs.remembered().flatten();
        for (value, before) in kept.zip(before) {
            let begun = Trace::given(Given::Substep, 0.0);
            *value = begun.where_positive(before, *value);
        }
    }
    let roots = |values: &[Trace]| values.iter().map(|&value| recorded::root(value)).collect();
    let outputs = roots(&run.y);
    let now = [&run.theta_now, &run.derived, &run.x, &run.u[0]];
    let group = &mut run.groups[0];
    let at = group.instant(run.law, now, 0.0);
    let sources = roots(&group.table(&at));
    run.advance(h);
    let next: Vec<Trace> = states(&mut run).into_iter().map(|value| *value).collect();
    Some(Asked { outputs, sources, next: roots(&next), theta })
}

/// States of the model and of its effects, and what lags of outputs and plays remember.
fn states<'b>(run: &'b mut Run<'_, Trace>) -> Vec<&'b mut Trace> {
    let Group { s, outputs, wirings, .. } = &mut run.groups[0];
    let plays = wirings.iter_mut().filter_map(Wiring::remembered);
    run.x.iter_mut().chain(s).chain(outputs.remembered().chain(plays).flatten()).collect()
}

/// Puts given inputs behind their paths in the place of those of a run.
fn give_passed(u: &mut [Vec<Trace>; 3], inputs: usize) {
    for (slot, u) in u.iter_mut().enumerate() {
        for (i, value) in u.iter_mut().enumerate() {
            *value = Trace::given(Given::Input((inputs * (slot + 1) + i) as u32), 0.0);
        }
    }
}
