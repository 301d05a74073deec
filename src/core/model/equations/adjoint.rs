//! The way back through a graph: derivatives as terms of the same graph.

use super::expression::Operator;
use super::function::Function;
use super::graph::{Graph, Id, Term};

/// The sum over i of weight i times the derivative of `laws[i]` along each of `states` states,
/// as terms (the reverse mode of Griewank and Walther, Evaluating Derivatives, ch. 3). `None`
/// where a function has kinks or places without a derivative, for which there is a rule that
/// terms cannot follow.
pub fn adjoint(graph: &mut Graph, laws: &[Id], states: usize) -> Option<Vec<Id>> {
    let mut needed = vec![false; graph.terms().len()];
    let mut along: Vec<Option<Id>> = vec![None; needed.len()];
    for (i, &law) in laws.iter().enumerate() {
        let weight = graph.add(Term::Weight(i));
        needed[law] = true;
        plus(graph, &mut along, law, weight);
    }
    for id in (0..needed.len()).rev() {
        if !needed[id] || graph.is_still(id) {
            continue;
        }
        let (term, Some(slope)) = (graph.terms()[id], along[id]) else { continue };
        term.parts().into_iter().flatten().for_each(|part| needed[part] = true);
        match term {
            Term::Negative(a) => minus(graph, &mut along, a, slope),
            Term::Add(a, b) => {
                plus(graph, &mut along, a, slope);
                plus(graph, &mut along, b, slope);
            }
            Term::Subtract(a, b) => {
                plus(graph, &mut along, a, slope);
                minus(graph, &mut along, b, slope);
            }
            Term::Multiply(a, b) => {
                for (to, other) in [(a, b), (b, a)] {
                    if !graph.is_still(to) {
                        let part = graph.binary(Operator::Multiply, slope, other);
                        plus(graph, &mut along, to, part);
                    }
                }
            }
            Term::Divide(a, b) => {
                let part = graph.binary(Operator::Divide, slope, b);
                plus(graph, &mut along, a, part);
                if !graph.is_still(b) {
                    let part = graph.binary(Operator::Multiply, part, id);
                    minus(graph, &mut along, b, part);
                }
            }
            Term::Call(function, a) => {
                let by = derivative(graph, function, a, id)?;
                let part = graph.binary(Operator::Multiply, slope, by);
                plus(graph, &mut along, a, part);
            }
            Term::CallPair(..) => return None,
            Term::Constant(_)
            | Term::Time
            | Term::Theta(_)
            | Term::State(_)
            | Term::Input(_)
            | Term::Channel(_)
            | Term::Weight(_) => {}
        }
    }
    let state = |i: usize, graph: &mut Graph| {
        let id = graph.add(Term::State(i));
        along.get(id).copied().flatten().unwrap_or_else(|| graph.constant(0.0))
    };
    Some((0..states).map(|i| state(i, graph)).collect())
}

/// The derivative of a function at `a`, where its value is `value`.
fn derivative(graph: &mut Graph, function: Function, a: Id, value: Id) -> Option<Id> {
    let one = graph.constant(1.0);
    let square = |graph: &mut Graph, of: Id| graph.binary(Operator::Multiply, of, of);
    Some(match function {
        Function::Sin => graph.call(Function::Cos, a),
        Function::Cos => {
            let sine = graph.call(Function::Sin, a);
            graph.negative(sine)
        }
        Function::Tan => {
            let square = square(graph, value);
            graph.binary(Operator::Add, one, square)
        }
        Function::Atan => {
            let square = square(graph, a);
            let below = graph.binary(Operator::Add, one, square);
            graph.binary(Operator::Divide, one, below)
        }
        Function::Sinh => graph.call(Function::Cosh, a),
        Function::Cosh => graph.call(Function::Sinh, a),
        Function::Tanh => {
            let square = square(graph, value);
            graph.binary(Operator::Subtract, one, square)
        }
        Function::Exp => value,
        Function::Abs => graph.call(Function::Sign, a),
        Function::Sign => graph.constant(0.0),
        Function::Asin | Function::Acos | Function::Log | Function::Sqrt => return None,
    })
}

/// Adds a term to what is known along another one; terms made of parameters move nothing.
fn plus(graph: &mut Graph, along: &mut [Option<Id>], to: Id, part: Id) {
    if graph.is_still(to) {
        return;
    }
    along[to] = Some(match along[to] {
        Some(sum) => graph.binary(Operator::Add, sum, part),
        None => part,
    });
}

/// The same with the other sign.
fn minus(graph: &mut Graph, along: &mut [Option<Id>], to: Id, part: Id) {
    if graph.is_still(to) {
        return;
    }
    along[to] = Some(match along[to] {
        Some(sum) => graph.binary(Operator::Subtract, sum, part),
        None => graph.negative(part),
    });
}
