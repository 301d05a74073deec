//! A system with effects compiled for whole samples: which states and parameters there are.

use crate::effect::{Mechanism, Role};
use crate::model::{Parameter, Signal, Signals, State, TimeKind};
use crate::system::{Drift, Hold, Origin, Plan, Slot, System, SystemError, Way};

/// Steps of the integrator that a delay may be long: each is a state, and slopes are taken
/// along all states.
const LONGEST: usize = 256;

/// Where a slot keeps what it remembers beyond rates: entries of m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Kept {
    pub first: usize,
    pub count: usize,
}

/// The compiled system.
#[derive(Debug)]
pub(super) struct Made {
    pub plan: Plan,
    pub signals: Signals,
    /// Present values of all numbers of effects, and which of them are parameters.
    pub effect_values: Vec<f64>,
    pub tuned: Vec<usize>,
    /// Parameters of the model that an effect replaces, with its number.
    pub replaced: Vec<(usize, usize)>,
    /// Parameters that drift, with the number that says how fast.
    pub drifts: Vec<Drift>,
    /// What each slot remembers.
    pub kept: Vec<Kept>,
    pub memories: usize,
    /// Whether inputs move along a line between samples.
    pub ramped: bool,
    /// Whether outputs are needed in every step, and whether what is remembered depends on them.
    pub fine: bool,
    pub remembers_outputs: bool,
    /// Whether the model reads its outputs back.
    pub fed_back: bool,
    /// Numbers that are held, and why.
    pub held: Vec<(String, &'static str)>,
    /// Key of each tuned number.
    keys: Vec<String>,
}

impl Made {
    pub fn of(system: &System, sampling_time: f64) -> Result<Self, String> {
        let said = |error: SystemError| error.to_string();
        let plan = system.plan(sampling_time).map_err(said)?;
        let inner = plan.signals.clone();
        let mut made = Self {
            effect_values: plan.effect_values(),
            signals: Signals { time: TimeKind::Discrete, channels: vec![], ..inner.clone() },
            tuned: vec![],
            replaced: vec![],
            drifts: vec![],
            kept: vec![],
            memories: 0,
            ramped: plan.hold == Hold::First,
            fine: false,
            remembers_outputs: false,
            fed_back: system.model.fed_back(),
            held: vec![],
            keys: vec![],
            plan,
        };
        made.signals.coordinates.clear();
        let labels = labels(&made.plan);
        let own = |name: String| State { signal: Signal::new(&name, ""), initial: 0.0 };
        for (slot, label) in made.plan.slots.iter().zip(&labels) {
            let states = (1..=slot.card.states).map(|i| own(format!("{label}.state{i}")));
            made.signals.states.extend(states);
        }
        let placed: Vec<usize> = (0..system.effects.len())
            .filter(|&i| system.effects[i].effect.card().mechanism != Mechanism::Data)
            .collect();
        for number in 0..made.plan.slots.len() {
            made.parameters(number, &labels[number], placed[number], system);
            made.memory(number, &labels[number])?;
        }
        if made.ramped {
            let ramp = |input: &Signal| Signal::new(&format!("{}.ramp", input.name), &input.unit);
            made.signals.channels = inner.inputs.iter().map(ramp).collect();
        }
        Ok(made)
    }

    /// The numbers of a slot that are parameters.
    fn parameters(&mut self, number: usize, label: &str, placed: usize, system: &System) {
        let slot = &self.plan.slots[number];
        let of = &system.effects[placed];
        let unit = |name: Option<&str>| -> String {
            name.and_then(|name| self.plan.unit(name)).cloned().unwrap_or_default()
        };
        let (channel, coordinate) = (unit(Some(&of.into)), unit(of.of.as_deref()));
        match slot.way {
            Way::Value(p) => self.replaced.push((p, slot.first_parameter)),
            Way::Drift(p) => self.drifts.push(Drift::new(p, slot)),
            _ => {}
        }
        let mut parameters = vec![];
        for (i, effect_parameter) in slot.card.parameters.iter().enumerate() {
            let name = format!("{label}.{}", effect_parameter.name);
            let why = match (slot.card.mechanism, effect_parameter.role) {
                (Mechanism::Delay, _) => "the length of a delay decides how many states there are",
                (_, Role::Choice) => "a variant has no slope",
                (_, Role::Origin) => "an origin is where it was put",
                (_, Role::Held) => "it stays as it was put",
                _ if !effect_parameter.value.is_finite() => "an absent bound has no slope",
                _ => "",
            };
            if !why.is_empty() {
                self.held.push((name, why));
                continue;
            }
            self.tuned.push(slot.first_parameter + i);
            let effect = slot.effect.typetag_name();
            self.keys.push(format!("effects.{placed}.effect.{effect}.{}", effect_parameter.name));
            let unit = effect_parameter.unit.text(&channel, &coordinate);
            parameters.push(
                Parameter::new(name, effect_parameter.value, &unit)
                    .at_least(effect_parameter.min)
                    .at_most(effect_parameter.max),
            );
        }
        self.signals.parameters.extend(parameters);
    }

    /// What a slot remembers, as states.
    fn memory(&mut self, number: usize, label: &str) -> Result<(), String> {
        let slot = &self.plan.slots[number];
        let steps =
            |slot: &Slot| (self.effect_values[slot.first_parameter] / self.plan.step()).floor();
        let to_output = |targets: &[(usize, f64)]| {
            targets
                .iter()
                .all(|&(e, _)| matches!(self.plan.targets.entries[e].1, Origin::Output(_)))
        };
        let count = match (&slot.way, slot.card.mechanism) {
            (Way::InputPath(_), Mechanism::Lag) => 1,
            (Way::OutputPath(_), Mechanism::Lag) => 2,
            (Way::InputPath(_) | Way::OutputPath(_), Mechanism::Delay) => {
                let steps = steps(slot);
                if steps >= LONGEST as f64 {
                    return Err(format!(
                        "`{label}` is {steps} steps of the integrator long, and at most {LONGEST} \
                         can stand beside a learned part: each is a state"
                    ));
                }
                steps as usize + 1
            }
            (Way::InputPath(_) | Way::OutputPath(_) | Way::Stage { .. }, Mechanism::Play) => 1,
            _ => 0,
        };
        match &slot.way {
            Way::OutputPath(_) if count > 0 => {
                self.remembers_outputs = true;
                self.fine |= slot.card.mechanism != Mechanism::Play;
            }
            Way::Stage { targets, .. } if count > 0 && to_output(targets) => {
                self.remembers_outputs = true;
            }
            _ => {}
        }
        self.kept.push(Kept { first: self.memories, count });
        self.memories += count;
        let own = |i: usize| format!("{label}.memory{i}");
        let states = (1..=count).map(|i| State { signal: Signal::new(&own(i), ""), initial: 0.0 });
        self.signals.states.extend(states);
        Ok(())
    }

    /// Where a tuned number stands.
    pub fn key(&self, parameter: &str) -> Option<String> {
        let own = self.plan.sizes.theta;
        let place = self.signals.parameters.iter().position(|p| p.name == parameter)?;
        self.keys.get(place.checked_sub(own)?).cloned()
    }
}

/// A name for each slot: its effect's, numbered where it is there several times.
fn labels(plan: &Plan) -> Vec<String> {
    let name = |i: usize| plan.slots[i].effect.typetag_name();
    let each = (0..plan.slots.len()).map(|i| {
        match (0..i).filter(|&before| name(before) == name(i)).count() {
            0 => name(i).to_string(),
            before => format!("{}_{}", name(i), before + 1),
        }
    });
    each.collect()
}
