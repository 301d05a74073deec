//! What the names in a table of equations stand for.

use std::collections::HashMap;

use super::error::{EquationsError, Located};
use super::function;
use super::graph::{Graph, Id, Term};
use super::lexer::is_name;
use super::problem::{Problem, Role};
use super::table::Table;

/// A declared name.
#[derive(Debug, Clone)]
struct Declared {
    role: Role,
    key: String,
    /// Number among those of its role.
    number: usize,
    /// Its term, where expressions can use it.
    term: Option<Id>,
}

/// All declared names.
#[derive(Debug, Default)]
pub struct Names {
    declared: HashMap<String, Declared>,
    /// Usable in expressions, in the order of declaration.
    usable: Vec<String>,
    /// Coordinates whose name stands for a state, input or output too: number and name.
    pub shared: Vec<(usize, String)>,
}

impl Names {
    /// Collects all names of a table; inputs, states and parameters get their terms.
    pub fn of(table: &Table, graph: &mut Graph, errors: &mut Vec<EquationsError>) -> Self {
        let mut names = Self::default();
        let lists: [(Role, &str, Vec<&str>); 7] = [
            (Role::Input, "inputs", table.inputs.iter().map(|e| e.name.as_str()).collect()),
            (Role::State, "states", table.states.iter().map(|e| e.name.as_str()).collect()),
            (Role::Output, "outputs", table.outputs.iter().map(|e| e.name.as_str()).collect()),
            (
                Role::Variable,
                "variables",
                table.variables.iter().map(|e| e.name.as_str()).collect(),
            ),
            (
                Role::Parameter,
                "parameters",
                table.parameters.iter().map(|e| e.name.as_str()).collect(),
            ),
            (Role::Channel, "channels", table.channels.iter().map(|e| e.name.as_str()).collect()),
            (
                Role::Coordinate,
                "coordinates",
                table.coordinates.iter().map(|e| e.name.as_str()).collect(),
            ),
        ];
        for (role, list, entries) in lists {
            for (number, name) in entries.into_iter().enumerate() {
                let key = format!("{list}[{number}].name");
                let term = match role {
                    Role::Input => Some(graph.add(Term::Input(number))),
                    Role::State => Some(graph.add(Term::State(number))),
                    Role::Parameter => Some(graph.add(Term::Theta(number))),
                    _ => None,
                };
                let declared = Declared { role, key, number, term };
                if let Err(problem) = names.declare(name, &declared) {
                    errors.push(EquationsError::new(declared.key, problem));
                }
            }
        }
        names
    }

    fn declare(&mut self, name: &str, declared: &Declared) -> Result<(), Problem> {
        if function::is_reserved(name) {
            return Err(Problem::Reserved { name: name.into() });
        }
        if !is_name(name) {
            return Err(Problem::Name { found: name.into() });
        }
        if let Some(first) = self.declared.get(name) {
            let may_share = matches!(first.role, Role::State | Role::Input | Role::Output);
            let twice = self.shared.iter().any(|(_, shared)| shared == name);
            if declared.role == Role::Coordinate && may_share && !twice {
                self.shared.push((declared.number, name.into()));
                return Ok(());
            }
            let (first, first_key) = (first.role, first.key.clone());
            return Err(Problem::Twice { name: name.into(), first, first_key });
        }
        if declared.term.is_some() || declared.role == Role::Variable {
            self.usable.push(name.into());
        }
        self.declared.insert(name.into(), declared.clone());
        Ok(())
    }

    /// Gives a variable its term.
    pub fn define(&mut self, variable: &str, term: Id) {
        if let Some(declared) = self.declared.get_mut(variable)
            && declared.role == Role::Variable
        {
            declared.term = Some(term);
        }
    }

    /// What a name stands for first, and its number among those.
    pub fn role(&self, name: &str) -> Option<(Role, usize)> {
        self.declared.get(name).map(|declared| (declared.role, declared.number))
    }

    /// The term of a name that stands at a character of an expression.
    pub fn find(&self, name: &str, at: usize) -> Result<Id, Located> {
        let problem = match self.declared.get(name) {
            Some(Declared { term: Some(term), .. }) => return Ok(*term),
            Some(Declared { role: Role::Variable, .. }) => Problem::TooEarly { name: name.into() },
            Some(Declared { role, .. }) => Problem::NotUsable { name: name.into(), role: *role },
            None => Problem::UnknownName { name: name.into(), known: self.usable.clone() },
        };
        Err(Located::new(at, name.chars().count(), problem))
    }
}
