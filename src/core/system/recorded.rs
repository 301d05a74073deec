//! A sampled system as a graph of operations: the step that the simulation makes, recorded.
//!
//! x_{k,j+1} = F(x_{k,j}, u_k, u_{k+1}, t, j), y_k = H(x_{k,0}, u_k, t): F is the integrator
//! with the model, its effects and their memories inside. What records it is the simulation
//! itself (operator overloading, see [`Tape`]), so that there is no second account of it.

use super::engine;
use super::{Hold, System, SystemError};
use crate::model::Signal;
use crate::real::{Node, Tape};

/// A number that may be changed between runs.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedParameter {
    /// `mass`, or `effects.1.coulomb_friction.force` for the first entry of `effects`.
    pub name: String,
    /// Unit as text, where it is known.
    pub unit: String,
    /// Value.
    pub value: f64,
}

/// A number that is kept from step to step.
#[derive(Debug, Clone, PartialEq)]
pub struct Remembered {
    /// Name and unit of a state of the model; `None` for what an effect remembers.
    pub signal: Option<Signal>,
    /// Value at the start of a run.
    pub initial: f64,
}

/// One integration step of a system, recorded.
///
/// What effects with a memory in a signal's path keep has its first value where
/// [`Given::Started`](crate::real::Given::Started) is asked.
#[derive(Debug, Clone, Default)]
pub struct Recorded {
    /// The terms, and the delay lines.
    pub tape: Tape,
    /// Inputs, in order.
    pub inputs: Vec<Signal>,
    /// Outputs, in order.
    pub output_signals: Vec<Signal>,
    /// Term of each output at the start of the step.
    pub outputs: Vec<Node>,
    /// What is kept, the model's states first.
    pub remembered: Vec<Remembered>,
    /// Term of each of those at the end of the step.
    pub next: Vec<Node>,
    /// What may be changed: the model's parameters, then those of the effects.
    pub parameters: Vec<RecordedParameter>,
    /// Names and values of what is part of the terms as a constant.
    pub fixed: Vec<RecordedParameter>,
    /// Sampling time in s.
    pub sampling_time: f64,
    /// Steps per sample.
    pub substeps: usize,
    /// Whether inputs move along straight lines between samples.
    pub ramps: bool,
}

/// Integration steps that a recorded delay line may hold: what is exported keeps so many numbers
/// from the start, however short its run.
const MOST_DELAYED: f64 = 1e6;

/// Refuses a delay whose line would be too long.
fn fits_in_a_line(
    index: usize,
    placed: &super::Placed,
    card: &crate::effect::EffectCard,
    step: f64,
) -> Result<(), SystemError> {
    let Some(delay) = card
        .parameters
        .iter()
        .find(|effect_parameter| !(effect_parameter.value / step <= MOST_DELAYED))
    else {
        return Ok(());
    };
    Err(SystemError::Value {
        index,
        effect: placed.effect.typetag_name().into(),
        key: delay.name.to_string(),
        found: delay.value.to_string(),
        expected: format!(
            "at most {} s, {MOST_DELAYED} steps of the integrator",
            MOST_DELAYED * step
        ),
    })
}

impl System {
    /// One step of the simulation, recorded.
    ///
    /// The parameters of a linear model in continuous time are constants in it, as its
    /// transition matrix is computed before the run; so are bounds that are infinite.
    ///
    /// # Errors
    ///
    /// If the system does not fit together.
    ///
    /// # Example
    ///
    /// ```
    /// use lacuna::plugins::systems::Duffing;
    /// use lacuna::system::{Sampling, System};
    ///
    /// let model = Duffing { mass: 1.0, damping: 0.5, stiffness: 100.0, hardening: 9.0, fixed: vec![] };
    /// let step = System::new(model, Sampling::default()).recorded(0.01)?;
    /// assert_eq!((step.outputs.len(), step.next.len()), (1, 2));
    /// assert_eq!(step.parameters[0].name, "mass");
    /// # Ok::<(), lacuna::system::SystemError>(())
    /// ```
    pub fn recorded(&self, sampling_time: f64) -> Result<Recorded, SystemError> {
        let plan = self.plan(sampling_time)?;
        let signals = &plan.signals;
        let replaced = |name: &str| {
            let is = |slot: &super::plan::Slot| match slot.way {
                super::plan::Way::Value(p) => signals.parameters[p].name == name,
                _ => false,
            };
            plan.slots.iter().any(is)
        };
        let (mut open, mut parameters, mut fixed) = (vec![], vec![], vec![]);
        for (i, parameter) in signals.parameters.iter().enumerate() {
            if replaced(&parameter.name) {
                continue;
            }
            let entry = RecordedParameter {
                name: parameter.name.clone(),
                unit: parameter.unit.clone(),
                value: parameter.value,
            };
            if plan.linear {
                fixed.push(entry);
            } else {
                open.push(i);
                parameters.push(entry);
            }
        }
        let mut at = 0;
        for (number, placed) in self.effects.iter().enumerate() {
            let card = placed.effect.card();
            // faults of the data are no part of a simulation
            if card.mechanism == crate::effect::Mechanism::Data {
                continue;
            }
            if card.mechanism == crate::effect::Mechanism::Delay {
                fits_in_a_line(number, placed, &card, plan.step())?;
            }
            for effect_parameter in &card.parameters {
                let name = format!(
                    "effects.{}.{}.{}",
                    number + 1,
                    placed.effect.typetag_name(),
                    effect_parameter.name
                );
                let entry =
                    RecordedParameter { name, unit: String::new(), value: effect_parameter.value };
                if effect_parameter.value.is_finite() {
                    parameters.push(entry)
                } else {
                    fixed.push(entry)
                }
            }
            at += card.parameters.len();
        }
        debug_assert_eq!(at, plan.effect_parameters);
        let recorded = engine::record(self.model.as_ref(), &plan, &open);
        Ok(Recorded {
            inputs: signals.inputs.clone(),
            output_signals: signals.outputs.clone(),
            parameters,
            fixed,
            sampling_time: plan.sampling_time,
            substeps: plan.substeps,
            ramps: plan.hold == Hold::First || self.model.ramped(),
            ..recorded
        })
    }
}
