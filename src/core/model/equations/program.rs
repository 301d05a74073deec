//! A graph cut into instructions for a machine with registers.

use super::function::{Function, Pair};
use super::graph::{Graph, Id, Term};

/// What an instruction computes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Code {
    /// a.
    Copy,
    /// -a.
    Negative,
    /// a + b.
    Add,
    /// a - b.
    Subtract,
    /// a b.
    Multiply,
    /// a / b.
    Divide,
    /// a b + c, rounded twice.
    MultiplyAdd,
    /// a b - c, rounded twice.
    MultiplySubtract,
    /// c - a b, rounded twice.
    SubtractProduct,
    /// A function of a.
    Call(Function),
    /// A function of a and b.
    CallPair(Pair),
}

/// A list that values are read from or put into; only the last two are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum List {
    /// Numbers, the same for all packs; the last one is time.
    Constants,
    /// Parameters.
    Theta,
    /// Numbers derived from the parameters.
    Derived,
    /// States.
    States,
    /// Inputs.
    Inputs,
    /// Own channels.
    Channels,
    /// Weights of the way back.
    Weights,
    /// Registers.
    Registers,
    /// The answer.
    Answer,
}

/// How many lists there are.
pub const LISTS: usize = 9;

/// An entry of a list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    /// The list.
    pub list: List,
    /// Number of the entry.
    pub entry: usize,
}

/// One step of a program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instruction {
    /// What to compute.
    pub code: Code,
    /// First operand.
    pub a: Place,
    /// Second operand; the first one again where there is none.
    pub b: Place,
    /// Third operand; the first one again where there is none.
    pub c: Place,
    /// Where the result goes: a register, perhaps one of an operand, or the answer.
    pub to: Place,
}

/// Instructions that give some values of a graph and compute nothing else.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Program {
    constants: Vec<f64>,
    steps: Vec<Instruction>,
    lengths: [usize; LISTS],
}

impl Program {
    /// The program that answers with the terms `roots` of a graph, in this order, given
    /// the terms `derived`.
    pub fn of(graph: &Graph, derived: &[Id], roots: &[Id]) -> Self {
        let terms = graph.terms();
        let mut places = vec![None; terms.len()];
        for (entry, &id) in derived.iter().enumerate() {
            places[id] = Some(Place { list: List::Derived, entry });
        }
        let mut uses = vec![0_usize; terms.len()];
        for &root in roots {
            uses[root] += 1;
        }
        for (id, term) in terms.iter().enumerate().rev() {
            if uses[id] > 0 && places[id].is_none() {
                term.parts().into_iter().flatten().for_each(|part| uses[part] += 1);
            }
        }
        let mut maker = Maker { program: Self::default(), places, uses, free: vec![] };
        for (id, term) in terms.iter().enumerate() {
            if let (true, Term::Constant(bits)) = (maker.needs(id), term) {
                maker.places[id] = Some(maker.program.constant(f64::from_bits(*bits)));
            }
        }
        let joined = maker.joined(terms, roots);
        let mut is_joined = vec![false; terms.len()];
        joined.iter().flatten().for_each(|&product| is_joined[product] = true);
        for (id, &term) in terms.iter().enumerate() {
            if maker.needs(id) && !is_joined[id] {
                maker.make(id, term, joined[id].map(|product| terms[product]), roots);
            }
        }
        for (entry, &root) in roots.iter().enumerate() {
            // what an instruction put into the answer has no other place
            if let Some(from) = maker.places[root] {
                maker.emit(Code::Copy, [from; 3], Place { list: List::Answer, entry });
            }
        }
        maker.program
    }

    /// Numbers; time comes after them.
    pub fn constants(&self) -> &[f64] {
        &self.constants
    }

    /// Steps, in order.
    pub fn steps(&self) -> &[Instruction] {
        &self.steps
    }

    /// Whether the steps look at the time, which comes after the numbers.
    pub fn is_timed(&self) -> bool {
        self.lengths[List::Constants as usize] > self.constants.len()
    }

    /// How many entries of each list the steps need at most.
    pub fn lengths(&self) -> &[usize; LISTS] {
        &self.lengths
    }

    /// How many registers are used.
    pub fn registers(&self) -> usize {
        self.lengths[List::Registers as usize]
    }

    fn constant(&mut self, value: f64) -> Place {
        self.constants.push(value);
        Place { list: List::Constants, entry: self.constants.len() - 1 }
    }
}

struct Maker {
    program: Program,
    /// Where each term's value is, once there is one.
    places: Vec<Option<Place>>,
    /// Uses left of each term.
    uses: Vec<usize>,
    /// Registers that hold nothing any more.
    free: Vec<usize>,
}

impl Maker {
    /// Whether a term has yet to be computed.
    fn needs(&self, id: Id) -> bool {
        self.uses[id] > 0 && self.places[id].is_none()
    }

    /// For each sum or difference the product that is computed in the same instruction:
    /// one that nothing else uses.
    fn joined(&self, terms: &[Term], roots: &[Id]) -> Vec<Option<Id>> {
        let mut joined = vec![None; terms.len()];
        for (id, term) in terms.iter().enumerate().filter(|(id, _)| self.needs(*id)) {
            if let Term::Add(a, b) | Term::Subtract(a, b) = *term {
                joined[id] = [b, a].into_iter().find(|&part| {
                    let product = matches!(terms[part], Term::Multiply(..));
                    product && self.needs(part) && self.uses[part] == 1 && !roots.contains(&part)
                });
            }
        }
        joined
    }

    fn emit(&mut self, code: Code, [a, b, c]: [Place; 3], to: Place) {
        for place in [a, b, c, to] {
            let length = &mut self.program.lengths[place.list as usize];
            *length = (*length).max(place.entry + 1);
        }
        self.program.steps.push(Instruction { code, a, b, c, to });
    }

    /// Computes a term, if need be together with a product that it is made of.
    fn make(&mut self, id: Id, term: Term, product: Option<Term>, roots: &[Id]) {
        let at = |list, entry| Some(Place { list, entry });
        let code = match term {
            Term::Constant(_) => return,
            Term::Time => {
                self.places[id] = at(List::Constants, self.program.constants.len());
                return;
            }
            Term::Theta(i) => return self.places[id] = at(List::Theta, i),
            Term::State(i) => return self.places[id] = at(List::States, i),
            Term::Input(i) => return self.places[id] = at(List::Inputs, i),
            Term::Channel(i) => return self.places[id] = at(List::Channels, i),
            Term::Weight(i) => return self.places[id] = at(List::Weights, i),
            Term::Negative(_) => Code::Negative,
            Term::Add(..) => Code::Add,
            Term::Subtract(..) => Code::Subtract,
            Term::Multiply(..) => Code::Multiply,
            Term::Divide(..) => Code::Divide,
            Term::Call(function, _) => Code::Call(function),
            Term::CallPair(pair, ..) => Code::CallPair(pair),
        };
        let parts = term.parts();
        let (code, parts) = match (product.map(Term::parts), parts) {
            (Some([a, b]), [first, second]) => {
                // the product has no place, the other part has
                let first_is_product = first.is_some_and(|first| self.places[first].is_none());
                let code = match (code, first_is_product) {
                    (Code::Add, _) => Code::MultiplyAdd,
                    (_, true) => Code::MultiplySubtract,
                    (_, false) => Code::SubtractProduct,
                };
                (code, [a, b, if first_is_product { second } else { first }])
            }
            (None, [a, b]) => (code, [a, b, None]),
        };
        // parts come before wholes, so that they have their places
        let place = |part: Option<Id>| part.and_then(|part| self.places[part]);
        let Some(a) = place(parts[0]) else { return };
        let places = [a, place(parts[1]).unwrap_or(a), place(parts[2]).unwrap_or(a)];
        for part in parts.into_iter().flatten() {
            self.uses[part] -= 1;
            if let (0, Some(Place { list: List::Registers, entry })) =
                (self.uses[part], self.places[part])
            {
                self.free.push(entry);
            }
        }
        let answer = roots.iter().position(|&root| root == id).filter(|_| self.uses[id] == 1);
        if let Some(entry) = answer {
            self.emit(code, places, Place { list: List::Answer, entry });
        } else {
            let entry = self.free.pop().unwrap_or_else(|| self.program.registers());
            let to = Place { list: List::Registers, entry };
            self.emit(code, places, to);
            self.places[id] = Some(to);
        }
    }
}
