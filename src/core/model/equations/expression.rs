//! An expression as a tree.

use std::fmt;

use super::function::{Function, Pair};

/// An operator between two values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Operator {
    /// a + b.
    Add,
    /// a - b.
    Subtract,
    /// a * b.
    Multiply,
    /// a / b.
    Divide,
    /// a ^ b.
    Power,
}

/// One node; numbers are positions of its children, which come before it.
#[derive(Debug, Clone, PartialEq)]
pub enum Node {
    /// A number, never negative.
    Number(f64),
    /// 3.14159...
    Pi,
    /// Time in s.
    Time,
    /// A declared name.
    Name(String),
    /// -a.
    Negative(usize),
    /// a with b.
    Binary(Operator, usize, usize),
    /// A function of one argument.
    Call(Function, usize),
    /// A function of two arguments.
    CallPair(Pair, usize, usize),
}

/// A parsed expression: nodes in the order in which they are evaluated, the root last.
///
/// A list and not boxes within boxes, so that neither a long nor a deep expression can
/// overflow the stack.
#[derive(Debug, Clone)]
pub struct Expression {
    nodes: Vec<Node>,
    /// Character of the text at which each node stands, from 0.
    at: Vec<usize>,
}

/// Two expressions are equal when their trees are, wherever the text had its blanks.
impl PartialEq for Expression {
    fn eq(&self, other: &Self) -> bool {
        self.nodes == other.nodes
    }
}

impl Expression {
    /// A tree without nodes, to be filled by [`push`](Self::push).
    pub(super) fn empty() -> Self {
        Self { nodes: vec![], at: vec![] }
    }

    /// Adds a node found at a character and gives its position.
    pub(super) fn push(&mut self, node: Node, at: usize) -> usize {
        self.nodes.push(node);
        self.at.push(at);
        self.nodes.len() - 1
    }

    /// All nodes, children before parents, with the characters at which they stand.
    pub fn nodes(&self) -> impl Iterator<Item = (&Node, usize)> {
        self.nodes.iter().zip(self.at.iter().copied())
    }

    /// Whether the whole expression is this one name.
    pub fn is_name(&self, name: &str) -> bool {
        matches!(self.nodes.as_slice(), [Node::Name(own)] if own == name)
    }
}

/// How tightly a node binds: sums, products, minus signs, powers, everything else.
const SUM: u8 = 1;
const PRODUCT: u8 = 2;
const MINUS: u8 = 3;
const POWER: u8 = 4;
const ATOM: u8 = 5;

impl Operator {
    /// How tightly it binds, and how tightly its two sides must.
    fn binding(self) -> (u8, u8, u8) {
        match self {
            Self::Add | Self::Subtract => (SUM, SUM, PRODUCT),
            Self::Multiply | Self::Divide => (PRODUCT, PRODUCT, MINUS),
            Self::Power => (POWER, ATOM, MINUS),
        }
    }

    fn sign(self) -> &'static str {
        match self {
            Self::Add => " + ",
            Self::Subtract => " - ",
            Self::Multiply => "*",
            Self::Divide => "/",
            Self::Power => "^",
        }
    }
}

/// Text that parses to the same tree, with no more parentheses than needed.
impl fmt::Display for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut pieces: Vec<(String, u8)> = vec![];
        let within = |(text, binds): (String, u8), at_least: u8| {
            if binds < at_least { format!("({text})") } else { text }
        };
        for node in &self.nodes {
            // children were pushed last, the right one on top
            let mut child = || pieces.pop().unwrap_or_default();
            let piece = match node {
                Node::Number(value) => (format!("{value:?}"), ATOM),
                Node::Pi => ("pi".into(), ATOM),
                Node::Time => ("time".into(), ATOM),
                Node::Name(name) => (name.clone(), ATOM),
                Node::Negative(_) => (format!("-{}", within(child(), MINUS)), MINUS),
                Node::Binary(operator, ..) => {
                    let (binds, left, right) = operator.binding();
                    let (b, a) = (within(child(), right), within(child(), left));
                    (format!("{a}{}{b}", operator.sign()), binds)
                }
                Node::Call(function, _) => (format!("{function}({})", child().0), ATOM),
                Node::CallPair(pair, ..) => {
                    let (b, a) = (child().0, child().0);
                    (format!("{pair}({a}, {b})"), ATOM)
                }
            };
            pieces.push(piece);
        }
        pieces.into_iter().try_for_each(|(text, _)| f.write_str(&text))
    }
}
