//! One expression of a variable and some parameters, compiled.

use super::error::Located;
use super::expression::Node;
use super::function;
use super::graph::{Graph, Term};
use super::lexer::is_name;
use super::parse::parse;
use super::problem::{Problem, Role};
use super::program::Program;
use super::run::{Stored, run};
use crate::model::{Block, Sizes};

/// An expression of one variable and some parameters, run on lanes.
#[derive(Debug, Clone)]
pub struct Formula {
    program: Program,
    parameters: usize,
}

impl Formula {
    /// Reads an expression of `variable` and `parameters`.
    ///
    /// # Errors
    ///
    /// The first thing that does not fit, with the characters concerned.
    pub fn new(text: &str, variable: &str, parameters: &[&str]) -> Result<Self, Located> {
        let tree = parse(text).map_err(|mut located| {
            if let Problem::UnknownFunction { name } = &located.problem {
                let is = |other: &str| other == name;
                let parameter = parameters.iter().any(|p| is(p)).then_some(Role::Parameter);
                let role = if is(variable) { Some(Role::Coordinate) } else { parameter };
                if let Some(role) = role {
                    located.problem = Problem::NotAFunction { name: name.clone(), role };
                }
            }
            located
        })?;
        let known =
            || [variable].iter().chain(parameters).map(|name| (*name).to_string()).collect();
        let unknown = |name: &str, at| {
            let problem = Problem::UnknownName { name: name.into(), known: known() };
            Located::new(at, name.chars().count(), problem)
        };
        if let Some((_, at)) = tree.nodes().find(|(node, _)| matches!(node, Node::Time)) {
            return Err(unknown("time", at));
        }
        let mut graph = Graph::default();
        let root = graph.expression(&tree, |graph, name, at| {
            if name == variable {
                return Ok(graph.add(Term::State(0)));
            }
            match parameters.iter().position(|parameter| *parameter == name) {
                Some(number) => Ok(graph.add(Term::Theta(number))),
                None => Err(unknown(name, at)),
            }
        })?;
        let program = Program::of(&graph, &[], &[root]);
        Ok(Self { program, parameters: parameters.len() })
    }

    /// What is wrong with a name that is to be declared, if anything.
    pub fn refused(name: &str) -> Option<Problem> {
        if function::is_reserved(name) {
            return Some(Problem::Reserved { name: name.into() });
        }
        (!is_name(name)).then(|| Problem::Name { found: name.into() })
    }

    /// The names that a text uses, as far as it can be read.
    pub fn uses(text: &str, name: &str) -> bool {
        parse(text).is_ok_and(|tree| {
            tree.nodes().any(|(node, _)| matches!(node, Node::Name(other) if other == name))
        })
    }

    /// The values for several packs: parameters pack by pack, and pack by pack what may be
    /// looked at, of which the first is the variable.
    pub fn values<R: Stored>(&self, packs: usize, parameters: &[R], seen: &[R], out: &mut [R]) {
        let x = seen.len() / packs.max(1);
        let sizes = Sizes { theta: self.parameters, x, u: 0, w: 0, y: 1, z: 0, derived: 0 };
        let block = Block {
            sizes,
            packs,
            theta: parameters,
            derived: &[],
            x: seen,
            u: &[],
            w: &[],
            read: &[],
            time: R::constant(0.0),
        };
        run(&self.program, 1, &block, out);
    }
}
