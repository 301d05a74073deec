//! What graphs keep and what they simplify.

use crate::model::equations::function::Function;
use crate::model::equations::graph::{Graph, Id, Term};
use crate::model::equations::parse;

/// The graph of an expression of states `x` and `y`, and its root.
fn graph(text: &str) -> (Graph, Id) {
    let mut graph = Graph::default();
    let root = graph.expression(&parse(text).unwrap(), |graph, name, _| {
        Ok(graph.add(Term::State(usize::from(name == "y"))))
    });
    let root = root.unwrap();
    (graph, root)
}

#[test]
fn numbers_are_folded() {
    for (text, value) in
        [("2^-1", 0.5), ("-2^2", -4.0), ("2^3^2", 512.0), ("sqrt(16)/8", 0.5), ("--3", 3.0)]
    {
        let (graph, root) = graph(text);
        assert_eq!(graph.value(root), Some(value), "{text}");
    }
}

#[test]
fn what_is_the_same_is_there_once() {
    let (graph, _) = graph("(x + y)*sin(y + x) + (y + x)*sin(x + y)");
    // x, y, sum, sine, product, sum of two products
    assert_eq!(graph.terms().len(), 6);
}

#[test]
fn whole_powers_are_products_and_share_them() {
    let (shared, root) = graph("x^3 + x^2");
    assert!(!shared.terms().iter().any(|t| matches!(t, Term::CallPair(..))));
    assert_eq!(shared.terms().iter().filter(|t| matches!(t, Term::Multiply(..))).count(), 2);
    assert!(matches!(shared.terms()[root], Term::Add(..)));
    let (graph, root) = graph("x^0.5");
    assert!(matches!(graph.terms()[root], Term::Call(Function::Sqrt, _)));
}

#[test]
fn nothing_is_simplified_that_could_change_a_bit() {
    for text in ["x + 0", "x*0", "x - x", "x/x"] {
        let (graph, root) = graph(text);
        assert!(graph.value(root).is_none(), "{text}");
        assert_eq!(graph.terms()[root].parts().iter().flatten().count(), 2, "{text}");
    }
    for text in ["x*1", "1*x", "x/1", "--x", "x^1"] {
        let (graph, root) = graph(text);
        assert!(matches!(graph.terms()[root], Term::State(0)), "{text}");
    }
}

#[test]
fn what_varies_is_multiplied_by_the_inverse_of_parameters() {
    let divisions = |text: &str| {
        let mut graph = Graph::default();
        let root = graph.expression(&parse(text).unwrap(), |graph, name, _| {
            Ok(graph.add(if name == "p" { Term::Theta(0) } else { Term::State(0) }))
        });
        let derived = graph.derived(&[root.unwrap()]);
        let divisions = graph.terms().iter().filter(|term| matches!(term, Term::Divide(..)));
        (divisions.count(), derived.len())
    };
    assert_eq!(divisions("x/p + x/p^2"), (2, 2));
    assert_eq!(divisions("(x + 1)/p + 1/p"), (1, 1));
    assert_eq!(divisions("p/x"), (1, 0));
    // numbers divide, but for powers of two, where it makes no difference
    assert_eq!(divisions("x/3"), (1, 0));
    assert_eq!(divisions("x/4"), (0, 0));
}
