//! A model as a MATLAB function.

use std::fmt::Write as _;

use crate::listing::Listing;
use crate::names::{identifiers, remark};
use crate::real::{Binary, Given, Unary};
use crate::syntax::{Syntax, Text, number};
use crate::{Files, Model};

/// The words of MATLAB, the helpers among them below the function.
struct Matlab;

impl Syntax for Matlab {
    fn constant(&self, value: f64) -> String {
        number(value, "Inf", "NaN")
    }
    fn given(&self, given: Given) -> String {
        match given {
            Given::Parameter(i) => format!("p({})", i + 1),
            Given::State(i) => format!("x({})", i + 1),
            Given::Input(i) => format!("u({})", i + 1),
            Given::Next(i) => format!("u_next({})", i + 1),
            Given::Time => "t".into(),
            Given::Substep => "j".into(),
            Given::Started => "started".into(),
        }
    }
    fn prepared(&self, number: usize) -> String {
        format!("c({})", number + 1)
    }
    fn function(&self, function: Unary) -> &'static str {
        match function {
            Unary::Negative => "-",
            Unary::Sin => "sin",
            Unary::Cos => "cos",
            Unary::Tan => "tan",
            Unary::Asin => "real_asin",
            Unary::Acos => "real_acos",
            Unary::Atan => "atan",
            Unary::Sinh => "sinh",
            Unary::Cosh => "cosh",
            Unary::Tanh => "tanh",
            Unary::Exp => "exp",
            Unary::Ln => "real_log",
            Unary::Sqrt => "real_sqrt",
            Unary::Abs => "abs",
            Unary::Signum => "sign",
        }
    }
    fn pair(&self, function: Binary) -> &'static str {
        match function {
            Binary::Atan2 => "atan2",
            Binary::Min => "smaller",
            Binary::Max => "larger",
            _ => "real_power",
        }
    }
    fn choice(&self, a: &str, yes: &str, no: &str) -> Text {
        (format!("choose({a}, {yes}, {no})"), true)
    }
    fn past(&self, helper: &str, line: u32, arguments: &[&str]) -> String {
        format!("{helper}(past, {}, {})", line + 1, arguments.join(", "))
    }
    fn name(&self, name: &str, value: &str) -> String {
        format!("{name} = {value}")
    }
}

/// The function, its test vector and the program that compares.
pub fn files(model: &Model<'_>) -> Files {
    let name = model.name;
    let test = include_str!("runtime/test_model.m")
        .replace("@NAME@", name)
        .replace("@NU@", &model.step.inputs.len().to_string());
    vec![
        (format!("{name}.m"), function(model).into_bytes()),
        ("test_vector.csv".into(), model.vector.csv(model).into_bytes()),
        (format!("test_{name}.m"), test.into_bytes()),
    ]
}

fn function(model: &Model<'_>) -> String {
    let step = model.step;
    let listing = Listing::of(step);
    let lines = step.tape.lines();
    let indent = |lines: Vec<String>| -> String {
        lines.iter().map(|line| format!("  {line};\n")).collect()
    };
    let ids = identifiers(step.parameters.iter().map(|p| p.name.as_str()));
    let (mut values, mut help) = (String::new(), String::new());
    for (i, (id, parameter)) in ids.iter().zip(&step.parameters).enumerate() {
        let unit = remark(&parameter.unit);
        let value = number(parameter.value, "Inf", "NaN");
        let _ = writeln!(values, "  p({}) = pick(parameters, '{id}', {value}); % {unit}", i + 1);
        let _ = writeln!(help, "%   {id} = {value} {unit}");
    }
    let states: Vec<String> =
        step.remembered.iter().map(|kept| number(kept.initial, "Inf", "NaN")).collect();
    let depths: Vec<String> = lines.iter().map(|line| line.depth.to_string()).collect();
    let h = step.sampling_time / step.substeps as f64;
    let names = |signals: &[lacuna_core::model::Signal]| {
        remark(&signals.iter().map(|s| s.name.as_str()).collect::<Vec<_>>().join(", "))
    };
    let next = listing.next(&Matlab, &|i| format!("next({})", i + 1));
    include_str!("runtime/model.m")
        .replace("@NAME@", model.name)
        .replace("@TS@", &format!("{:?}", step.sampling_time))
        .replace("@H@", &format!("{h:?}"))
        .replace("@SUBSTEPS@", &step.substeps.to_string())
        .replace("@INPUTS@", &names(&step.inputs))
        .replace("@OUTPUTS@", &names(&step.output_signals))
        .replace("@STATES@", &states.join("; "))
        .replace("@DEPTHS@", &depths.join(", "))
        .replace("@NP@", &step.parameters.len().to_string())
        .replace("@NC@", &listing.prepared().to_string())
        .replace("@NU@", &step.inputs.len().to_string())
        .replace("@NY@", &step.outputs.len().to_string())
        .replace("@NX@", &step.remembered.len().to_string())
        .replace("@NN@", &(step.remembered.len() + lines.len()).to_string())
        .replace("%   @HELP@\n", &help)
        .replace("  @PARAMETERS@\n", &values)
        .replace(
            "  @PREPARE@\n",
            &indent(listing.preparation(&Matlab, &|i| format!("c({})", i + 1))),
        )
        .replace("  @OUTPUT@\n", &indent(listing.outputs(&Matlab, &|i| format!("y({})", i + 1))))
        .replace("  @ADVANCE@\n", &indent(next))
}
