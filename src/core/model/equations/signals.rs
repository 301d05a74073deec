//! What a table of equations says about its model.

use super::graph::{Graph, Id, Term};
use super::table::{Parameter, Table};
use crate::model::{self, Quantity, Signal, Signals};

/// Smallest and largest value of a parameter, infinite where none is given.
pub fn bounds(parameter: &Parameter) -> (f64, f64) {
    (parameter.min.unwrap_or(f64::NEG_INFINITY), parameter.max.unwrap_or(f64::INFINITY))
}

/// The signals of a table whose laws, outputs and coordinates are these terms of a graph.
pub fn signals(
    table: &Table,
    graph: &Graph,
    laws: &[Id],
    outputs: &[Id],
    coordinates: &[Id],
) -> Signals {
    let continuous = table.states.iter().all(|state| state.derivative.is_some());
    let mut signals = if continuous { Signals::continuous() } else { Signals::discrete() };
    let state = |id: Id| match graph.terms().get(id) {
        Some(&Term::State(number)) => Some(number),
        _ => None,
    };
    // a state that is the derivative of another one is its velocity
    let is_velocity = |own: usize| {
        let mut others = laws.iter().enumerate().filter(|(number, _)| *number != own);
        continuous && others.any(|(_, &law)| state(law) == Some(own))
    };
    let signal = |name: &str, unit: &str, quantity: &Option<String>, state: Option<usize>| {
        let velocity = state.is_some_and(is_velocity).then(Quantity::velocity);
        let quantity = quantity.clone().map(Quantity).or(velocity);
        Signal { name: name.into(), unit: unit.into(), quantity }
    };
    let inputs = table.inputs.iter();
    signals.inputs = inputs.map(|e| signal(&e.name, &e.unit, &e.quantity, None)).collect();
    let states = table.states.iter().enumerate();
    signals.states = states
        .map(|(i, e)| model::State {
            signal: signal(&e.name, &e.unit, &e.quantity, Some(i)),
            initial: e.initial,
        })
        .collect();
    let entries = table.outputs.iter().zip(outputs);
    signals.outputs =
        entries.map(|(e, &id)| signal(&e.name, &e.unit, &e.quantity, state(id))).collect();
    let entries = table.coordinates.iter().zip(coordinates);
    signals.coordinates =
        entries.map(|(e, &id)| signal(&e.name, &e.unit, &e.quantity, state(id))).collect();
    signals.channels = table.channels.iter().map(|e| Signal::new(&e.name, &e.unit)).collect();
    let parameters = table.parameters.iter();
    signals.parameters = parameters
        .map(|e| {
            let (min, max) = bounds(e);
            let parameter = model::Parameter::new(&e.name, e.value, &e.unit);
            parameter.at_least(min).at_most(max).fixed(e.fixed)
        })
        .collect();
    signals
}
