//! A model as a Python class that needs numpy.

use std::fmt::Write as _;

use crate::listing::Listing;
use crate::real::{Binary, Given, Unary};
use crate::syntax::{Syntax, Text, number};
use crate::{Files, Model};

/// The words of Python.
struct Python;

impl Syntax for Python {
    fn constant(&self, value: f64) -> String {
        number(value, "np.inf", "np.nan")
    }
    fn given(&self, given: Given) -> String {
        match given {
            Given::Parameter(i) => format!("p[{i}]"),
            Given::State(i) => format!("x[{i}]"),
            Given::Input(i) => format!("u[{i}]"),
            Given::Next(i) => format!("u_next[{i}]"),
            Given::Time => "t".into(),
            Given::Substep => "j".into(),
            Given::Started => "self._started".into(),
        }
    }
    fn prepared(&self, number: usize) -> String {
        format!("c[{number}]")
    }
    fn function(&self, function: Unary) -> &'static str {
        match function {
            Unary::Negative => "-",
            Unary::Sin => "np.sin",
            Unary::Cos => "np.cos",
            Unary::Tan => "np.tan",
            Unary::Asin => "np.arcsin",
            Unary::Acos => "np.arccos",
            Unary::Atan => "np.arctan",
            Unary::Sinh => "np.sinh",
            Unary::Cosh => "np.cosh",
            Unary::Tanh => "np.tanh",
            Unary::Exp => "np.exp",
            Unary::Ln => "np.log",
            Unary::Sqrt => "np.sqrt",
            Unary::Abs => "np.abs",
            Unary::Signum => "np.sign",
        }
    }
    fn pair(&self, function: Binary) -> &'static str {
        match function {
            Binary::Atan2 => "np.arctan2",
            Binary::Min => "np.minimum",
            Binary::Max => "np.maximum",
            _ => "np.power",
        }
    }
    fn choice(&self, a: &str, yes: &str, no: &str) -> Text {
        (format!("{yes} if {a} > 0.0 else {no}"), false)
    }
    fn past(&self, helper: &str, line: u32, arguments: &[&str]) -> String {
        format!("self._{helper}({line}, {})", arguments.join(", "))
    }
    fn name(&self, name: &str, value: &str) -> String {
        format!("{name} = {value}")
    }
}

/// A name as a literal.
fn literal(text: &str) -> String {
    let kept: String = text.chars().filter(|c| !c.is_control()).collect();
    format!("\"{}\"", kept.replace('\\', "\\\\").replace('"', "\\\""))
}

fn tuple(items: impl Iterator<Item = String>) -> String {
    let text: String = items.map(|item| item + ", ").collect();
    format!("({})", text.trim_end())
}

/// The class, its test vector and the program that compares.
pub fn files(model: &Model<'_>) -> Files {
    let name = model.name;
    let test = include_str!("runtime/test_model.py").replace("model", name);
    vec![
        (format!("{name}.py"), class(model).into_bytes()),
        ("test_vector.csv".into(), model.vector.csv(model).into_bytes()),
        (format!("test_{name}.py"), test.into_bytes()),
    ]
}

fn class(model: &Model<'_>) -> String {
    let step = model.step;
    let listing = Listing::of(step);
    let body = |lines: Vec<String>| -> String {
        lines.iter().map(|line| format!("        {line}\n")).collect()
    };
    let names =
        |signals: &[lacuna_core::model::Signal]| tuple(signals.iter().map(|s| literal(&s.name)));
    let mut parameters = String::new();
    for parameter in &step.parameters {
        let value = number(parameter.value, "np.inf", "np.nan");
        let unit = parameter.unit.chars().filter(|c| !c.is_control()).collect::<String>();
        let unit = if unit.is_empty() { unit } else { format!("  # {unit}") };
        let _ = writeln!(parameters, "        {}: {value},{unit}", literal(&parameter.name));
    }
    let h = step.sampling_time / step.substeps as f64;
    let states = step.remembered.iter().map(|kept| number(kept.initial, "np.inf", "np.nan"));
    let depths = step.tape.lines().iter().map(|line| line.depth.to_string());
    let count = step.remembered.len();
    include_str!("runtime/model.py")
        .replace("@NAME@", model.name)
        .replace("@TS@", &format!("{:?}", step.sampling_time))
        .replace("@H@", &format!("{h:?}"))
        .replace("@SUBSTEPS@", &step.substeps.to_string())
        .replace("@INPUTS@", &names(&step.inputs))
        .replace("@OUTPUTS@", &names(&step.output_signals))
        .replace("@STATES@", &tuple(states))
        .replace("@DEPTHS@", &tuple(depths))
        .replace("@PREPARED@", &listing.prepared().to_string())
        .replace("@NY@", &step.outputs.len().to_string())
        .replace("@NX@", &count.to_string())
        .replace("@NN@", &(count + step.tape.lines().len()).to_string())
        .replace("        @PARAMETERS@\n", &parameters)
        .replace("        @PREPARE@\n", &body(listing.preparation(&Python, &|i| format!("c[{i}]"))))
        .replace("        @OUTPUT@\n", &body(listing.outputs(&Python, &|i| format!("y[{i}]"))))
        .replace("        @ADVANCE@\n", &body(listing.next(&Python, &|i| format!("next[{i}]"))))
}
