//! A graph as a list of statements: common subexpressions get a name, what follows from the
//! parameters alone is prepared once per run (Aho et al., Compilers, 2nd ed., 2006, sec. 8.5).

use std::collections::HashMap;

use crate::real::{Binary, Given, Node, Term, Unary};
use crate::syntax::{Syntax, Text};
use crate::system::Recorded;

/// Longest text that is written where it is used, and not under a name of its own.
const SHORT: usize = 60;

/// Where every term of a recorded step belongs.
pub struct Listing<'a> {
    step: &'a Recorded,
    /// What follows from constants and parameters alone.
    still: Vec<bool>,
    /// Of those, what the step needs: node and its number.
    prepared: HashMap<Node, usize>,
    order: Vec<Node>,
}

impl<'a> Listing<'a> {
    /// Divides a step into what is prepared and what is done at every step.
    pub fn of(step: &'a Recorded) -> Self {
        let terms = step.tape.terms();
        let mut still = vec![false; terms.len()];
        for (i, term) in terms.iter().enumerate() {
            still[i] = match term {
                Term::Constant(_) | Term::Given(Given::Parameter(_)) => true,
                Term::Given(_) | Term::PastHeld { .. } | Term::PastLine { .. } => false,
                _ => term.operands().all(|a| still[a as usize]),
            };
        }
        let mut listing = Self { step, still, prepared: HashMap::new(), order: vec![] };
        let roots = listing.roots();
        let needed = listing.cone(&roots, true);
        let is_work =
            |node: Node| !matches!(terms[node as usize], Term::Constant(_) | Term::Given(_));
        for (i, _) in needed.iter().enumerate().filter(|(_, needed)| **needed) {
            let users = terms[i].operands().collect::<Vec<_>>();
            let from_outside = roots.contains(&(i as Node)).then_some(i as Node);
            let from_inside = users.into_iter().filter(|_| !listing.still[i]);
            for node in from_inside.chain(from_outside) {
                if listing.still[node as usize]
                    && is_work(node)
                    && !listing.prepared.contains_key(&node)
                {
                    listing.prepared.insert(node, listing.order.len());
                    listing.order.push(node);
                }
            }
        }
        listing
    }

    fn roots(&self) -> Vec<Node> {
        let entering = self.step.tape.lines().iter().map(|line| line.enters);
        self.step.outputs.iter().chain(&self.step.next).copied().chain(entering).collect()
    }

    /// The terms that some roots are made of; what is prepared ends a way, unless `all`.
    fn cone(&self, roots: &[Node], all: bool) -> Vec<bool> {
        let terms = self.step.tape.terms();
        let mut needed = vec![false; terms.len()];
        for &root in roots {
            needed[root as usize] = true;
        }
        for i in (0..terms.len()).rev() {
            if needed[i] && (all || !self.prepared.contains_key(&(i as Node))) {
                terms[i].operands().for_each(|a| needed[a as usize] = true);
            }
        }
        needed
    }

    /// Numbers that are prepared.
    pub fn prepared(&self) -> usize {
        self.order.len()
    }

    /// Whether anything computed from these roots is given so.
    pub fn uses(&self, given: impl Fn(Given) -> bool) -> bool {
        let needed = self.cone(&self.roots(), true);
        let mut terms = self.step.tape.terms().iter().zip(needed);
        terms.any(|(term, needed)| needed && matches!(term, Term::Given(g) if given(*g)))
    }

    /// Whether a function of two arguments is called.
    pub fn calls(&self, function: Binary) -> bool {
        self.step.tape.terms().iter().any(|t| matches!(t, Term::Two(f, ..) if *f == function))
    }

    /// Whether a function of one argument is called.
    pub fn calls_one(&self, function: Unary) -> bool {
        self.step.tape.terms().iter().any(|t| matches!(t, Term::One(f, _) if *f == function))
    }

    /// Whether delay lines are read so: held, or along straight lines.
    pub fn delays(&self) -> (bool, bool) {
        let terms = self.step.tape.terms();
        (
            terms.iter().any(|t| matches!(t, Term::PastHeld { .. })),
            terms.iter().any(|t| matches!(t, Term::PastLine { .. })),
        )
    }

    /// Statements that compute what is prepared; `to` names the place of each.
    pub fn preparation(&self, syntax: &dyn Syntax, to: &dyn Fn(usize) -> String) -> Vec<String> {
        let none = HashMap::new();
        self.statements(syntax, &self.order, &none, to)
    }

    /// Statements that compute the outputs.
    pub fn outputs(&self, syntax: &dyn Syntax, to: &dyn Fn(usize) -> String) -> Vec<String> {
        self.statements(syntax, &self.step.outputs, &self.prepared, to)
    }

    /// Statements that compute the next states, and then what enters the delay lines.
    pub fn next(&self, syntax: &dyn Syntax, to: &dyn Fn(usize) -> String) -> Vec<String> {
        let entering = self.step.tape.lines().iter().map(|line| line.enters);
        let roots: Vec<Node> = self.step.next.iter().copied().chain(entering).collect();
        self.statements(syntax, &roots, &self.prepared, to)
    }

    fn statements(
        &self,
        syntax: &dyn Syntax,
        roots: &[Node],
        prepared: &HashMap<Node, usize>,
        to: &dyn Fn(usize) -> String,
    ) -> Vec<String> {
        let terms = self.step.tape.terms();
        let mut needed = vec![false; terms.len()];
        let mut users = vec![0_usize; terms.len()];
        for &root in roots {
            needed[root as usize] = true;
            users[root as usize] += 1;
        }
        for i in (0..terms.len()).rev() {
            if needed[i] && !prepared.contains_key(&(i as Node)) {
                for a in terms[i].operands() {
                    needed[a as usize] = true;
                    users[a as usize] += 1;
                }
            }
        }
        let mut lines = vec![];
        let mut texts: Vec<Text> = vec![(String::new(), true); terms.len()];
        for i in 0..terms.len() {
            if !needed[i] {
                continue;
            }
            if let Some(&number) = prepared.get(&(i as Node)) {
                texts[i] = (syntax.prepared(number), true);
                continue;
            }
            let operand = |a: Node| -> String {
                let (text, atom) = &texts[a as usize];
                if *atom { text.clone() } else { format!("({text})") }
            };
            let plain = |a: Node| texts[a as usize].0.clone();
            let mut leaf = false;
            let text = match terms[i] {
                Term::Constant(bits) => {
                    leaf = true;
                    (syntax.constant(f64::from_bits(bits)), true)
                }
                Term::Given(given) => {
                    leaf = true;
                    (syntax.given(given), true)
                }
                Term::One(f @ Unary::Negative, a) => syntax.one(f, &operand(a)),
                Term::One(f, a) => syntax.one(f, &plain(a)),
                Term::Two(f, a, b) => syntax.two(f, &operand(a), &operand(b)),
                Term::Choice(a, b, c) => syntax.choice(&operand(a), &operand(b), &operand(c)),
                Term::PastHeld { line, back, now } => {
                    (syntax.past("past_held", line, &[&plain(back), &plain(now)]), true)
                }
                Term::PastLine { line, at, now, end } => {
                    let arguments = [&plain(at)[..], &plain(now), &plain(end)];
                    (syntax.past("past_line", line, &arguments), true)
                }
            };
            let short = users[i] <= 1 && text.0.len() <= SHORT;
            texts[i] = if leaf || short {
                text
            } else {
                let name = format!("v{i}");
                lines.push(syntax.name(&name, &text.0));
                (name, true)
            };
        }
        for (number, &root) in roots.iter().enumerate() {
            lines.push(format!("{} = {}", to(number), texts[root as usize].0));
        }
        lines
    }
}
