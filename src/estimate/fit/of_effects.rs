//! The numbers of a system's effects that a fit may move, with the ranges that the records can tell.

use super::Key;
use crate::effect::{Mechanism, Role, View};
use crate::evaluate::{Init, Run};
use crate::optimise::Unknown;
use crate::system::{Origin, System, Way};

/// A number of an effect: what moves, from where and within which range, its name and unit.
pub(super) struct Number {
    pub key: Key,
    pub unknown: Unknown,
    pub name: String,
    pub unit: String,
}

/// All numbers of effects, but variants, absent bounds, and what has no say on a signal's own path. A width or
/// threshold stays where the course of its coordinate tells it from none: beyond that an effect becomes
/// another, plainer one.
pub(super) fn of_effects(system: &System, run: &Run<'_>) -> Vec<Number> {
    let plan = &run.plan;
    let placed = system.effects.iter().filter(|p| p.effect.card().mechanism != Mechanism::Data);
    let mut numbers = vec![];
    let mut course = None;
    for (index, (slot, placed)) in plan.slots.iter().zip(placed).enumerate() {
        let own_path = matches!(slot.way, Way::InputPath(_) | Way::OutputPath(_));
        let source = placed.of.as_deref().and_then(|of| plan.sources.find(of));
        let search = source.map(|source| {
            let seen = course.get_or_insert_with(|| {
                let starts = run.starts(run.init_samples(Init::Forgotten));
                run.system.run_seen(plan, &run.drive, &run.lane(starts)).seen
            });
            let mut view = View::new(&seen[source], plan.sampling_time);
            view.is_time = plan.sources.entries[source].1 == Origin::Time;
            view.own_path = own_path;
            slot.effect.search(&view)
        });
        let unit_of = |name: &str| {
            let parameter = || plan.signals.parameters.iter().find(|p| p.name == name);
            plan.unit(name).or_else(|| Some(&parameter()?.unit)).cloned().unwrap_or_default()
        };
        let units = (unit_of(&placed.into), placed.of.as_deref().map(unit_of).unwrap_or_default());
        for (i, own) in slot.card.parameters.iter().enumerate() {
            let is_fixed = own_path && slot.card.on_own_path(&own.name).is_some();
            if !own.role.is_fitted() || !own.value.is_finite() || is_fixed {
                continue;
            }
            let seen = search.as_ref().filter(|_| own.role == Role::Shape);
            let (min, max) = seen.map_or((own.min, own.max), |search| {
                // where it stands is a value that somebody had reasons for
                let range = (search.min[i].min(own.value), search.max[i].max(own.value));
                (own.min.max(range.0), own.max.min(range.1))
            });
            let size = if own.value == 0.0 { 1.0 } else { own.value.abs() };
            let rate = matches!(slot.way, Way::Drift(_)) && own.role == Role::Coefficient;
            let unit = match rate {
                true => format!("{}/s", if units.0.is_empty() { "1" } else { &units.0 }),
                false => own.unit.text(&units.0, &units.1),
            };
            numbers.push(Number {
                key: Key::EffectParameter(slot.first_parameter + i),
                unknown: Unknown::new(own.value, 0.1 * size).within(min, max),
                name: format!("effects[{index}].{}", own.name),
                unit,
            });
        }
    }
    numbers
}
