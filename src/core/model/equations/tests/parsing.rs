//! Text to trees and back.

use proptest::prelude::*;

use crate::model::equations::expression::{Expression, Node, Operator};
use crate::model::equations::function::{Function, Pair};
use crate::model::equations::parse::{DEPTH, parse};
use crate::model::equations::problem::{Expected, Problem};
use crate::model::equations::token::Token;

fn same(a: &str, b: &str) {
    assert_eq!(parse(a).unwrap(), parse(b).unwrap(), "{a} and {b}");
}

#[test]
fn powers_bind_tighter_than_signs_and_to_the_right() {
    same("-x^2", "-(x^2)");
    same("2^3^2", "2^(3^2)");
    same("2^-1", "2^(-1)");
    same("2^-x^2", "2^(-(x^2))");
    same("-x^-y", "-(x^(-y))");
    same("x^2*y", "(x^2)*y");
}

#[test]
fn products_bind_tighter_than_sums_and_to_the_left() {
    same("a - b - c", "(a - b) - c");
    same("a/b/c", "(a/b)/c");
    same("a/b*c", "(a/b)*c");
    same("a + b*c", "a + (b*c)");
    same("a*-b", "a*(-b)");
    same("a - -b", "a - (-b)");
    same("-a*b", "(-a)*b");
    same("+a", "a");
}

#[test]
fn numbers_are_read_in_every_usual_form() {
    for (text, value) in
        [("1e-3", 1e-3), ("1.5E+2", 150.0), (".5", 0.5), ("2.", 2.0), ("0", 0.0), ("12e3", 12e3)]
    {
        assert_eq!(parse(text).unwrap().nodes().next(), Some((&Node::Number(value), 0)), "{text}");
    }
    // an exponent needs digits: this is 2 e without an operator between
    assert_eq!(parse("2e").unwrap_err().at, 1);
}

#[test]
fn min_and_max_take_any_number_of_arguments() {
    same("min(a, b, c)", "min(min(a, b), c)");
    same("max(a, b, c, d)", "max(max(max(a, b), c), d)");
}

#[test]
fn names_may_have_letters_of_any_script() {
    let tree = parse("ω_1 + θ").unwrap();
    assert_eq!(tree.to_string(), "ω_1 + θ");
    assert_eq!(parse("θ + ?").unwrap_err().at, 4);
}

#[test]
fn every_fault_is_found_at_its_character() {
    let number = |value| Token::Number(value);
    let name = |name: &str| Token::Name(name.into());
    let unexpected = |found, expected| Problem::Unexpected { found, expected };
    for (text, at, length, problem) in [
        ("", 0, 1, Problem::Empty),
        ("  ", 0, 1, Problem::Empty),
        ("a + $", 4, 1, Problem::Character { found: '$' }),
        ("a = b", 2, 1, Problem::Character { found: '=' }),
        ("1.2.3 + a", 0, 5, Problem::Number { found: "1.2.3".into() }),
        ("1e999", 0, 5, Problem::Number { found: "1e999".into() }),
        (".", 0, 1, Problem::Number { found: ".".into() }),
        ("a +", 3, 1, unexpected(Token::End, Expected::Operand)),
        ("a * ) + b", 4, 1, unexpected(Token::Close, Expected::Operand)),
        ("a ** b", 3, 1, unexpected(Token::Star, Expected::Operand)),
        ("2 abc", 2, 3, unexpected(name("abc"), Expected::Operator)),
        ("a 2", 2, 1, unexpected(number(2.0), Expected::Operator)),
        ("(a 2)", 3, 1, unexpected(number(2.0), Expected::Close)),
        ("1,5", 1, 1, unexpected(Token::Comma, Expected::Operator)),
        ("a)", 1, 1, Problem::Unopened),
        ("a * (b + c", 10, 1, Problem::Unclosed { opened: 5, found: Token::End }),
        ("sin(a", 5, 1, Problem::Unclosed { opened: 4, found: Token::End }),
        ("a + sin", 4, 3, Problem::NoArguments { function: "sin" }),
        ("sin x", 0, 3, Problem::NoArguments { function: "sin" }),
        ("sin()", 0, 3, Problem::Arguments { function: "sin", wanted: 1, given: 0 }),
        ("1 + tanh(a, b)", 4, 4, Problem::Arguments { function: "tanh", wanted: 1, given: 2 }),
        ("atan2(a)", 0, 5, Problem::Arguments { function: "atan2", wanted: 2, given: 1 }),
        ("pow(a, b, c)", 0, 3, Problem::Arguments { function: "pow", wanted: 2, given: 3 }),
        ("a + sine(b)", 4, 4, Problem::UnknownFunction { name: "sine".into() }),
    ] {
        let found = parse(text).unwrap_err();
        assert_eq!((found.at, found.length, &found.problem), (at, length, &problem), "{text}");
    }
}

#[test]
fn hints_say_what_to_write() {
    let hint = |text: &str| parse(text).unwrap_err().problem.hint().unwrap();
    assert!(hint("sinn(x)").starts_with("did you mean `sin`?"));
    assert_eq!(hint("ln(x)"), "write `log(x)`");
    assert_eq!(hint("x ** 2"), "a power is written `x^2`");
    assert_eq!(hint("2 x"), "write `*` between the factors of a product");
    assert_eq!(hint("1,5*x"), "decimals need a point, not a comma");
    assert_eq!(hint("[x]"), "use parentheses: ( )");
}

#[test]
fn neither_deep_nor_long_texts_overflow_the_stack() {
    for deep in
        ["(".repeat(1_000_000), "-".repeat(1_000_000), "2^".repeat(500_000), "sin(".repeat(300_000)]
    {
        let found = parse(&deep).unwrap_err();
        assert_eq!(found.problem, Problem::TooDeep { limit: DEPTH });
    }
    let within = format!("{}x{}", "(".repeat(DEPTH - 1), ")".repeat(DEPTH - 1));
    assert!(parse(&within).is_ok());
    let long = vec!["x"; 100_000].join("+");
    assert_eq!(parse(&long).unwrap().nodes().count(), 199_999);
}

/// Any tree, with nodes in the parser's order.
pub fn any_expression() -> impl Strategy<Value = Expression> {
    #[derive(Debug, Clone)]
    enum Tree {
        Leaf(Node),
        Negative(Box<Tree>),
        Binary(Operator, Box<Tree>, Box<Tree>),
        Call(Function, Box<Tree>),
        CallPair(Pair, Box<Tree>, Box<Tree>),
    }
    fn push(tree: &Tree, to: &mut Expression) -> usize {
        let node = match tree {
            Tree::Leaf(node) => node.clone(),
            Tree::Negative(a) => Node::Negative(push(a, to)),
            Tree::Binary(operator, a, b) => {
                let a = push(a, to);
                Node::Binary(*operator, a, push(b, to))
            }
            Tree::Call(function, a) => Node::Call(*function, push(a, to)),
            Tree::CallPair(pair, a, b) => {
                let a = push(a, to);
                Node::CallPair(*pair, a, push(b, to))
            }
        };
        to.push(node, 0)
    }
    let number = prop_oneof![
        (0..12_u8).prop_map(|n| Node::Number(f64::from(n) / 4.0)),
        (0.0..1e3_f64).prop_map(Node::Number),
        Just(Node::Number(1e-300)),
        Just(Node::Number(7e22)),
    ];
    let leaf = prop_oneof![
        number,
        Just(Node::Pi),
        Just(Node::Time),
        prop::sample::select(vec!["x", "y", "u", "p", "q"])
            .prop_map(|name| Node::Name(name.into())),
    ];
    let operators = vec![
        Operator::Add,
        Operator::Subtract,
        Operator::Multiply,
        Operator::Divide,
        Operator::Power,
    ];
    let tree = leaf.prop_map(Tree::Leaf).prop_recursive(6, 48, 2, move |inner| {
        let operator = prop::sample::select(operators.clone());
        let function = prop::sample::select(Function::ALL.to_vec());
        let pair = prop::sample::select(Pair::ALL.to_vec());
        let boxed = || inner.clone().prop_map(Box::new);
        prop_oneof![
            1 => boxed().prop_map(Tree::Negative),
            4 => (operator, boxed(), boxed()).prop_map(|(o, a, b)| Tree::Binary(o, a, b)),
            1 => (function, boxed()).prop_map(|(f, a)| Tree::Call(f, a)),
            1 => (pair, boxed(), boxed()).prop_map(|(p, a, b)| Tree::CallPair(p, a, b)),
        ]
    });
    tree.prop_map(|tree| {
        let mut expression = Expression::empty();
        push(&tree, &mut expression);
        expression
    })
}

proptest! {
    #[test]
    fn no_text_makes_the_parser_panic(text in "\\PC{0,60}") {
        let _ = parse(&text);
    }

    #[test]
    fn no_text_of_its_own_signs_makes_it_panic(text in "[-+*/^(),. 0-9a-cesinmx]{0,60}") {
        if let Err(found) = parse(&text) {
            prop_assert!(found.at <= text.chars().count());
            prop_assert!(!found.problem.to_string().is_empty());
        }
    }

    #[test]
    fn a_printed_tree_reads_as_the_same_tree(tree in any_expression()) {
        let text = tree.to_string();
        prop_assert_eq!(parse(&text).map_err(|e| e.problem.to_string()), Ok(tree), "{}", text);
    }
}
