//! From text to a tree.
//!
//! ```text
//! sum     = product { ("+" | "-") product }
//! product = signed { ("*" | "/") signed }
//! signed  = ("-" | "+") signed | power
//! power   = atom [ "^" signed ]
//! atom    = number | name | function "(" sum { "," sum } ")" | "(" sum ")"
//! ```

use super::error::Located;
use super::expression::{Expression, Node, Operator};
use super::function::{Function, Pair};
use super::lexer::tokens;
use super::problem::{Expected, Problem};
use super::token::Token;

/// How many parentheses, powers and signs may stand within each other.
pub const DEPTH: usize = 100;

/// Reads an expression. Names are taken as they come; whether they are declared is not
/// asked here.
///
/// # Errors
///
/// The first thing that does not fit, with the characters concerned.
///
/// # Example
///
/// ```
/// use lacuna::model::equations::parse;
///
/// let tree = parse("(torque - gravity) / (J)")?;
/// assert_eq!(tree.to_string(), "(torque - gravity)/J");
/// assert_eq!(parse("-x^2")?, parse("-(x^2)")?);
/// assert_eq!(parse("2 * sqrt(").unwrap_err().at, 9);
/// # Ok::<(), lacuna::model::equations::Located>(())
/// ```
pub fn parse(text: &str) -> Result<Expression, Located> {
    let tokens = tokens(text)?;
    if tokens.len() == 1 {
        return Err(Located::new(0, 1, Problem::Empty));
    }
    let mut parser = Parser { tokens, next: 0, depth: 0, tree: Expression::empty() };
    parser.sum()?;
    match parser.peek() {
        Token::End => Ok(parser.tree),
        Token::Close => Err(parser.here(Problem::Unopened)),
        _ => Err(parser.unexpected(Expected::Operator)),
    }
}

struct Parser {
    /// Ends with [`Token::End`], which is never stepped over.
    tokens: Vec<(Token, usize)>,
    next: usize,
    depth: usize,
    tree: Expression,
}

type Parsed = Result<usize, Located>;

impl Parser {
    fn peek(&self) -> &Token {
        self.tokens.get(self.next).map_or(&Token::End, |(token, _)| token)
    }

    /// Character at which the next word begins.
    fn at(&self) -> usize {
        self.tokens.get(self.next).map_or(0, |(_, at)| *at)
    }

    fn take(&mut self) -> (Token, usize) {
        let taken = (self.peek().clone(), self.at());
        if taken.0 != Token::End {
            self.next += 1;
        }
        taken
    }

    fn takes(&mut self, wanted: &Token) -> bool {
        let found = self.peek() == wanted;
        if found {
            self.next += 1;
        }
        found
    }

    fn here(&self, problem: Problem) -> Located {
        let length = match self.peek() {
            Token::Name(name) => name.chars().count(),
            _ => 1,
        };
        Located::new(self.at(), length, problem)
    }

    fn unexpected(&self, expected: Expected) -> Located {
        self.here(Problem::Unexpected { found: self.peek().clone(), expected })
    }

    fn binary(
        &mut self,
        side: fn(&mut Self) -> Parsed,
        operators: [(Token, Operator); 2],
    ) -> Parsed {
        let mut left = side(self)?;
        loop {
            let at = self.at();
            let found = operators.iter().find(|(token, _)| token == self.peek());
            let Some(&(_, operator)) = found else { return Ok(left) };
            self.take();
            let right = side(self)?;
            left = self.tree.push(Node::Binary(operator, left, right), at);
        }
    }

    fn sum(&mut self) -> Parsed {
        let operators = [(Token::Plus, Operator::Add), (Token::Minus, Operator::Subtract)];
        self.binary(Self::product, operators)
    }

    fn product(&mut self) -> Parsed {
        let operators = [(Token::Star, Operator::Multiply), (Token::Slash, Operator::Divide)];
        self.binary(Self::signed, operators)
    }

    /// Every way from an expression to one within it leads through here.
    fn signed(&mut self) -> Parsed {
        self.depth += 1;
        if self.depth > DEPTH {
            return Err(self.here(Problem::TooDeep { limit: DEPTH }));
        }
        let at = self.at();
        let signed = if self.takes(&Token::Minus) {
            let of = self.signed()?;
            Ok(self.tree.push(Node::Negative(of), at))
        } else if self.takes(&Token::Plus) {
            self.signed()
        } else {
            self.power()
        };
        self.depth -= 1;
        signed
    }

    fn power(&mut self) -> Parsed {
        let base = self.atom()?;
        let at = self.at();
        if !self.takes(&Token::Caret) {
            return Ok(base);
        }
        let exponent = self.signed()?;
        Ok(self.tree.push(Node::Binary(Operator::Power, base, exponent), at))
    }

    fn atom(&mut self) -> Parsed {
        match self.peek().clone() {
            Token::Number(value) => {
                let (_, at) = self.take();
                Ok(self.tree.push(Node::Number(value), at))
            }
            Token::Name(name) => self.name(name),
            Token::Open => {
                let (_, opened) = self.take();
                let inside = self.sum()?;
                self.close(opened)?;
                Ok(inside)
            }
            _ => Err(self.unexpected(Expected::Operand)),
        }
    }

    fn close(&mut self, opened: usize) -> Result<(), Located> {
        if self.takes(&Token::Close) {
            return Ok(());
        }
        let found = self.peek().clone();
        match found {
            Token::End => Err(self.here(Problem::Unclosed { opened: opened + 1, found })),
            _ => Err(self.unexpected(Expected::Close)),
        }
    }

    /// A declared name, `pi`, `time`, or a function with its arguments.
    fn name(&mut self, name: String) -> Parsed {
        let here = self.here(Problem::Empty);
        let fault = |problem| Located { problem, ..here.clone() };
        let (_, at) = self.take();
        let (one, two) = (Function::named(&name), Pair::named(&name));
        let Some(function) = one.map(Function::name).or(two.map(Pair::name)) else {
            return match (name.as_str(), self.peek()) {
                (_, Token::Open) => Err(fault(Problem::UnknownFunction { name })),
                ("pi", _) => Ok(self.tree.push(Node::Pi, at)),
                ("time", _) => Ok(self.tree.push(Node::Time, at)),
                _ => Ok(self.tree.push(Node::Name(name), at)),
            };
        };
        let opened = self.at();
        if !self.takes(&Token::Open) {
            return Err(fault(Problem::NoArguments { function }));
        }
        let wrong = |given| {
            let wanted = if one.is_some() { 1 } else { 2 };
            fault(Problem::Arguments { function, wanted, given })
        };
        if self.takes(&Token::Close) {
            return Err(wrong(0));
        }
        let mut value = self.sum()?;
        let mut given = 1;
        while self.takes(&Token::Comma) {
            let next = self.sum()?;
            given += 1;
            match two {
                // a third argument of `min` makes min(min(a, b), c)
                Some(pair) if given == 2 || pair.takes_many() => {
                    value = self.tree.push(Node::CallPair(pair, value, next), at);
                }
                // counted to the end, so that the message can say how many there are
                _ => {}
            }
        }
        self.close(opened)?;
        match (one, two) {
            (Some(function), _) if given == 1 => {
                Ok(self.tree.push(Node::Call(function, value), at))
            }
            (None, Some(pair)) if given == 2 || given > 2 && pair.takes_many() => Ok(value),
            _ => Err(wrong(given)),
        }
    }
}
