//! Models written as equations in a model file.
//!
//! ```text
//! table -- parse --> expressions -- join --> graph -- cut --> programs -- run on lanes
//! ```
//!
//! Text becomes trees (`parse`), trees become one graph in which equal terms are there
//! once (`graph`), and what each question needs of it becomes a list of instructions
//! (`program`) that a small machine runs for 64 lanes at a time (`run`).

mod adjoint;
mod build;
mod error;
mod expression;
mod formula;
mod function;
mod graph;
mod hint;
mod lexer;
mod march;
mod names;
mod parse;
mod problem;
mod program;
mod run;
mod signals;
mod table;
#[cfg(test)]
mod tests;
mod token;

use serde::{Deserialize, Serialize};

use super::{Ask, Block, Call, Fault, Law, MarchCall, Signals};
use build::{Compiled, compile};

// machinery that sibling crates and the program share; it may change at any time
#[doc(hidden)]
pub use self::{
    error::{EquationsError, Located},
    expression::{Expression, Node, Operator},
    formula::Formula,
    function::{Function, Pair},
    parse::{DEPTH, parse},
    problem::{Expected, Problem, Role},
    run::Stored,
    table::{Channel, Coordinate, Entry, Input, Output, Parameter, State, Table, Variable},
    token::Token,
};

/// A model written as equations: x' = f(x, u, w) as text, with named parameters.
///
/// `log` and `sqrt` outside their domain give no number, and the run diverges there. What
/// enters the channels is added to the states' laws, each with its gain; while nothing
/// does, the laws are those of the text.
///
/// Values are those of the text to the last bit, but for three liberties: whole powers up
/// to 64 are repeated multiplications, a power of 0.5 is a square root, and dividing
/// something that varies by parameters is multiplying by their inverse, which is computed
/// once per run.
///
/// # Example
///
/// ```
/// use lacuna::model::Law;
/// use lacuna::model::equations::{Equations, Table};
///
/// let table: Table = toml::from_str(
///     r#"
///     inputs = [{ name = "force", unit = "N" }]
///     states = [
///       { name = "p", unit = "m", derivative = "v" },
///       { name = "v", unit = "m/s", derivative = "(force - k*p)/m" },
///     ]
///     outputs = [{ name = "position", unit = "m", value = "p" }]
///     parameters = [{ name = "k", value = 100.0 }, { name = "m", value = 0.5, min = 0.0 }]
///     "#,
/// )?;
/// let oscillator = Equations::new(table)?;
/// let velocity = &oscillator.signals().states[1].signal;
/// assert!(velocity.quantity.as_ref().is_some_and(|quantity| quantity.is_velocity()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(from = "Table", into = "Table")]
#[doc(hidden)]
pub struct Equations {
    table: Table,
    compiled: Result<Compiled, Vec<EquationsError>>,
}

impl Equations {
    /// The model that a table describes.
    ///
    /// # Errors
    ///
    /// The first thing that is wrong with it; see [`check`](Self::check) for all.
    pub fn new(table: Table) -> Result<Self, EquationsError> {
        match Self::check(&table).into_iter().next() {
            Some(first) => Err(first),
            None => Ok(Self::from(table)),
        }
    }

    /// Everything that is wrong with a table, in the order of its keys within each kind of
    /// fault: names, values, expressions.
    pub fn check(table: &Table) -> Vec<EquationsError> {
        compile(table).err().unwrap_or_default()
    }

    /// The table that the model was made from.
    pub fn table(&self) -> &Table {
        &self.table
    }

    /// What is wrong with the table; nothing in a model made by [`new`](Self::new).
    pub fn errors(&self) -> &[EquationsError] {
        self.compiled.as_ref().err().map_or(&[], Vec::as_slice)
    }

    fn run<R: run::Stored>(&self, ask: Ask, block: &Block<'_, R>, out: &mut [R]) {
        match &self.compiled {
            Ok(compiled) => {
                let program = match ask {
                    Ask::Derivative => &compiled.derivative,
                    Ask::Output => &compiled.output,
                    Ask::Coordinates => &compiled.coordinates,
                    Ask::Derived => &compiled.derived,
                };
                run::run(program, block.sizes.answer(ask), block, out);
            }
            // nobody may ask a faulty model; who does gets no number
            Err(_) => out.fill(R::constant(f64::NAN)),
        }
    }
}

impl From<Table> for Equations {
    /// Keeps what is wrong with the table for [`Law::faults`].
    fn from(table: Table) -> Self {
        let compiled = compile(&table);
        Self { table, compiled }
    }
}

impl From<Equations> for Table {
    fn from(equations: Equations) -> Self {
        equations.table
    }
}

impl Law for Equations {
    fn signals(&self) -> Signals {
        match &self.compiled {
            Ok(compiled) => compiled.signals.clone(),
            Err(_) => Signals::continuous(),
        }
    }

    fn faults(&self) -> Vec<Fault> {
        self.errors().iter().map(Fault::from).collect()
    }

    fn answer(&self, ask: Ask, call: Call<'_>) {
        match call {
            Call::F64(block, out) => self.run(ask, block, out),
            Call::F32(block, out) => self.run(ask, block, out),
            Call::Dual64(block, out) => self.run(ask, block, out),
            Call::Dual32(block, out) => self.run(ask, block, out),
            Call::Trace(block, out) => self.run(ask, block, out),
        }
    }

    fn march(&self, call: MarchCall<'_>) -> bool {
        let whole = self.compiled.as_ref().ok().and_then(|compiled| compiled.whole.as_ref());
        whole.is_some_and(|whole| match call {
            MarchCall::F64(march) => march::march(whole, march),
            MarchCall::F32(march) => march::march(whole, march),
        })
    }

    fn packs(&self) -> usize {
        run::PACKS
    }

    fn key(&self, parameter: &str) -> String {
        let entries = &self.table.parameters;
        match entries.iter().position(|entry| entry.name == parameter) {
            Some(number) => format!("parameters.{number}.value"),
            None => parameter.into(),
        }
    }
}

crate::register!(StateSpaceModel for Equations, "equations", "a model written as equations in the model file",
    r#"inputs = [{ name = "force", unit = "N" }]
states = [
  { name = "p", unit = "m", derivative = "v" },
  { name = "v", unit = "m/s", derivative = "(force - c*v - k*p)/m" },
]
outputs = [{ name = "position", unit = "m", value = "p" }]
parameters = [
  { name = "m", value = 1.0, unit = "kg", min = 0.0 },
  { name = "c", value = 0.5, unit = "N s/m", min = 0.0 },
  { name = "k", value = 100.0, unit = "N/m" },
]
channels = [{ name = "force_on_mass", unit = "N", into = [{ state = "v", gain = "1/m" }] }]
coordinates = [
  { name = "displacement", unit = "m", value = "p", quantity = "position" },
  { name = "speed", unit = "m/s", value = "v" },
]"#);
