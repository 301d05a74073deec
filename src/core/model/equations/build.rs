//! From the text of a table to programs, with everything checked on the way.

use std::collections::HashSet;

use super::adjoint::adjoint;
use super::error::EquationsError;
use super::expression::Operator;
use super::graph::{Graph, Id, Term};
use super::march::Whole;
use super::names::Names;
use super::parse::parse;
use super::problem::{Problem, Role};
use super::program::Program;
use super::signals::{bounds, signals};
use super::table::{State, Table};
use crate::model::Signals;

/// A table that has been read: what it declares and what it computes.
#[derive(Debug, Clone)]
pub struct Compiled {
    /// Names, units, quantities, bounds.
    pub signals: Signals,
    /// What follows from the parameters alone.
    pub derived: Program,
    /// Derivatives (or next values) with what enters the channels.
    pub derivative: Program,
    /// Outputs.
    pub output: Program,
    /// Own coordinates.
    pub coordinates: Program,
    /// A whole sample, where there is a way back.
    pub whole: Option<Whole>,
}

/// Reads a table.
///
/// # Errors
///
/// Everything that is wrong, in the order of the table's keys.
pub fn compile(table: &Table) -> Result<Compiled, Vec<EquationsError>> {
    let mut builder = Builder::new(table);
    builder.names();
    builder.values();
    builder.variables();
    let laws = builder.laws();
    let outputs = builder.outputs();
    let entered = builder.channels(&laws);
    let coordinates = builder.coordinates(&outputs);
    if !builder.errors.is_empty() {
        return Err(builder.errors);
    }
    let back = adjoint(&mut builder.graph, &laws, laws.len());
    let graph = &builder.graph;
    let there = back.as_deref().unwrap_or_default();
    let derived = graph.derived(&[entered.as_slice(), &outputs, &coordinates, there].concat());
    let whole = back.map(|back| Whole {
        laws: Program::of(graph, &derived, &laws),
        back: Program::of(graph, &derived, &back),
    });
    Ok(Compiled {
        signals: signals(table, graph, &laws, &outputs, &coordinates).deriving(derived.len()),
        derived: Program::of(graph, &[], &derived),
        derivative: Program::of(graph, &derived, &entered),
        output: Program::of(graph, &derived, &outputs),
        coordinates: Program::of(graph, &derived, &coordinates),
        whole: whole.filter(|whole| !whole.laws.is_timed() && !whole.back.is_timed()),
    })
}

struct Builder<'a> {
    table: &'a Table,
    graph: Graph,
    names: Names,
    errors: Vec<EquationsError>,
    /// Variables whose own expression is wrong: what uses them is not reported again.
    broken: HashSet<&'a str>,
}

impl<'a> Builder<'a> {
    fn new(table: &'a Table) -> Self {
        let (graph, names) = (Graph::default(), Names::default());
        Self { table, graph, names, errors: vec![], broken: HashSet::new() }
    }

    fn fault(&mut self, key: impl Into<String>, problem: Problem) {
        self.errors.push(EquationsError::new(key, problem));
    }

    fn names(&mut self) {
        self.names = Names::of(self.table, &mut self.graph, &mut self.errors);
        if self.table.outputs.is_empty() {
            self.fault("outputs", Problem::NoEntries);
        }
    }

    /// Parameters and initial values.
    fn values(&mut self) {
        for (i, parameter) in self.table.parameters.iter().enumerate() {
            let (min, max) = bounds(parameter);
            let value = parameter.value;
            let given = [("value", Some(value)), ("min", parameter.min), ("max", parameter.max)];
            let bad =
                given.into_iter().find_map(|(key, v)| Some((key, v.filter(|v| !v.is_finite())?)));
            let (key, problem) = if let Some((key, value)) = bad {
                (key, Problem::NotFinite { value })
            } else if min > max {
                ("min", Problem::Bounds { min, max })
            } else if value < min || value > max {
                ("value", Problem::Outside { value, min, max })
            } else {
                continue;
            };
            self.fault(format!("parameters[{i}].{key}"), problem);
        }
        for (i, state) in self.table.states.iter().enumerate() {
            if !state.initial.is_finite() {
                self.fault(
                    format!("states[{i}].initial"),
                    Problem::NotFinite { value: state.initial },
                );
            }
        }
    }

    /// Reads one expression; a wrong one counts as 0 after its error is noted.
    fn expression(&mut self, key: &str, text: &'a str) -> Option<Id> {
        let names = &self.names;
        let mut spoilt = false;
        let made = parse(text).and_then(|tree| {
            self.graph.expression(&tree, |graph, name, at| match names.find(name, at) {
                Err(_) if self.broken.contains(name) => {
                    spoilt = true;
                    Ok(graph.constant(0.0))
                }
                found => found,
            })
        });
        match made {
            Ok(id) => (!spoilt).then_some(id),
            Err(mut located) => {
                if let Problem::UnknownFunction { name } = &located.problem
                    && let Some((role, _)) = names.role(name)
                {
                    located.problem = Problem::NotAFunction { name: name.clone(), role };
                }
                self.errors.push(EquationsError::inside(key, located));
                None
            }
        }
    }

    /// The same where a value is needed to go on.
    fn value(&mut self, key: &str, text: &'a str) -> Id {
        match self.expression(key, text) {
            Some(id) => id,
            None => self.graph.constant(0.0),
        }
    }

    fn variables(&mut self) {
        for (i, variable) in self.table.variables.iter().enumerate() {
            match self.expression(&format!("variables[{i}].value"), &variable.value) {
                Some(id) => self.names.define(&variable.name, id),
                None => {
                    self.broken.insert(&variable.name);
                }
            }
        }
    }

    /// Derivatives or next values, without what enters the channels.
    fn laws(&mut self) -> Vec<Id> {
        let first = self.table.states.iter().find_map(|state| match state {
            State { derivative: Some(_), next: None, .. } => Some("derivative"),
            State { derivative: None, next: Some(_), .. } => Some("next"),
            _ => None,
        });
        let mut laws = vec![];
        for (i, state) in self.table.states.iter().enumerate() {
            let name = || state.name.clone();
            let (found, text) = match (&state.derivative, &state.next) {
                (Some(text), None) => ("derivative", text),
                (None, Some(text)) => ("next", text),
                (None, None) => {
                    self.fault(format!("states[{i}]"), Problem::NoLaw { state: name() });
                    continue;
                }
                (Some(_), Some(_)) => {
                    self.fault(format!("states[{i}].next"), Problem::TwoLaws { state: name() });
                    continue;
                }
            };
            let key = format!("states[{i}].{found}");
            if let Some(first) = first.filter(|first| *first != found) {
                self.fault(&key, Problem::Mixed { found, first });
            }
            let law = self.value(&key, text);
            laws.push(law);
        }
        laws
    }

    fn outputs(&mut self) -> Vec<Id> {
        let outputs = self.table.outputs.iter().enumerate();
        outputs
            .map(|(i, output)| self.value(&format!("outputs[{i}].value"), &output.value))
            .collect()
    }

    /// The laws with gain times w added for every channel.
    fn channels(&mut self, laws: &[Id]) -> Vec<Id> {
        let mut entered = laws.to_vec();
        for (i, channel) in self.table.channels.iter().enumerate() {
            if channel.into.is_empty() {
                self.fault(format!("channels[{i}].into"), Problem::NoEntries);
            }
            for (j, entry) in channel.into.iter().enumerate() {
                let key = format!("channels[{i}].into[{j}].gain");
                let gain = self.value(&key, &entry.gain);
                if let Some(number) = self.graph.input_within(gain) {
                    let input = self.table.inputs[number].name.clone();
                    self.fault(key, Problem::GainOfInput { input });
                }
                let Some((Role::State, state)) = self.names.role(&entry.state) else {
                    let known = self.table.states.iter().map(|state| state.name.clone()).collect();
                    let problem = Problem::UnknownState { state: entry.state.clone(), known };
                    self.fault(format!("channels[{i}].into[{j}].state"), problem);
                    continue;
                };
                let w = self.graph.add(Term::Channel(i));
                let part = self.graph.binary(Operator::Multiply, gain, w);
                if let Some(law) = entered.get_mut(state) {
                    // the law stays on the left, so that w = 0 changes nothing
                    *law = self.graph.add(Term::Add(*law, part));
                }
            }
        }
        entered
    }

    /// Own coordinates: as declared, else the states.
    fn coordinates(&mut self, outputs: &[Id]) -> Vec<Id> {
        if self.table.coordinates.is_empty() {
            return (0..self.table.states.len()).map(|i| self.graph.add(Term::State(i))).collect();
        }
        let mut ids = vec![];
        for (i, coordinate) in self.table.coordinates.iter().enumerate() {
            let key = format!("coordinates[{i}].value");
            let id = self.expression(&key, &coordinate.value);
            let shares = self.names.shared.iter().any(|(number, _)| *number == i);
            if let (Some(id), true, Some((role, number))) =
                (id, shares, self.names.role(&coordinate.name))
            {
                let other = match role {
                    Role::Input => Some(self.graph.add(Term::Input(number))),
                    Role::State => Some(self.graph.add(Term::State(number))),
                    _ => outputs.get(number).copied(),
                };
                if other != Some(id) {
                    let name = coordinate.name.clone();
                    self.fault(&key, Problem::OtherValue { name, first: role });
                }
            }
            ids.push(id.unwrap_or_default());
        }
        ids
    }
}
