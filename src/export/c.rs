//! A model as C99 without dependencies.

use std::fmt::Write as _;

use crate::listing::Listing;
use crate::names::{identifiers, remark};
use crate::real::{Binary, Given, Unary};
use crate::syntax::{Syntax, Text, number};
use crate::{Files, Model};

/// The words of C.
struct C;

impl Syntax for C {
    fn constant(&self, value: f64) -> String {
        number(value, "INFINITY", "NAN")
    }
    fn given(&self, given: Given) -> String {
        match given {
            Given::Parameter(i) => format!("m->p[{i}]"),
            Given::State(i) => format!("m->x[{i}]"),
            Given::Input(i) => format!("u[{i}]"),
            Given::Next(i) => format!("u_next[{i}]"),
            Given::Time => "t".into(),
            Given::Substep => "j".into(),
            Given::Started => "(double)m->started".into(),
        }
    }
    fn prepared(&self, number: usize) -> String {
        format!("m->c[{number}]")
    }
    fn function(&self, function: Unary) -> &'static str {
        match function {
            Unary::Negative => "-",
            Unary::Sin => "sin",
            Unary::Cos => "cos",
            Unary::Tan => "tan",
            Unary::Asin => "asin",
            Unary::Acos => "acos",
            Unary::Atan => "atan",
            Unary::Sinh => "sinh",
            Unary::Cosh => "cosh",
            Unary::Tanh => "tanh",
            Unary::Exp => "exp",
            Unary::Ln => "log",
            Unary::Sqrt => "sqrt",
            Unary::Abs => "fabs",
            Unary::Signum => "sign",
        }
    }
    fn pair(&self, function: Binary) -> &'static str {
        match function {
            Binary::Atan2 => "atan2",
            Binary::Min => "smaller",
            Binary::Max => "larger",
            _ => "pow",
        }
    }
    fn choice(&self, a: &str, yes: &str, no: &str) -> Text {
        (format!("{a} > 0.0 ? {yes} : {no}"), false)
    }
    fn past(&self, helper: &str, line: u32, arguments: &[&str]) -> String {
        format!("{helper}(m, {line}, {})", arguments.join(", "))
    }
    fn name(&self, name: &str, value: &str) -> String {
        format!("const double {name} = {value}")
    }
}

/// The model, its test vector and the program that compares.
pub fn files(model: &Model<'_>) -> Files {
    let name = model.name;
    vec![
        (format!("{name}.h"), header(model).into_bytes()),
        (format!("{name}.c"), source(model).into_bytes()),
        ("test_vector.h".into(), test_vector(model).into_bytes()),
        ("main_test.c".into(), main(model).into_bytes()),
    ]
}

/// The declarations.
pub fn header(model: &Model<'_>) -> String {
    let (name, step) = (model.name, model.step);
    let upper = name.to_uppercase();
    let listing = Listing::of(step);
    let lines = step.tape.lines();
    let mut text = format!(
        "/* {name}: one sample of {} s per step. Written by `lacuna export`. */\n\
         #ifndef {upper}_H\n#define {upper}_H\n\n",
        step.sampling_time
    );
    let sizes = [
        ("INPUTS", step.inputs.len()),
        ("OUTPUTS", step.outputs.len()),
        ("PARAMETERS", step.parameters.len()),
        ("STATES", step.remembered.len()),
    ];
    for (what, count) in sizes {
        let _ = writeln!(text, "#define {upper}_{what} {count}");
    }
    let _ = writeln!(text, "#define {upper}_SAMPLING_TIME {:?}", step.sampling_time);
    let list = |text: &mut String, what: &str, entries: Vec<(String, String)>| {
        let made = identifiers(entries.iter().map(|(name, _)| name.as_str()));
        for (i, (id, (name, unit))) in made.iter().zip(&entries).enumerate() {
            let unit = if unit.is_empty() { String::new() } else { format!(" [{unit}]") };
            let said = remark(&format!("{name}{unit}"));
            let _ = writeln!(text, "#define {upper}_{what}_{id} {i} /* {said} */");
        }
    };
    let signals = |signals: &[lacuna_core::model::Signal]| {
        signals.iter().map(|s| (s.name.clone(), s.unit.clone())).collect()
    };
    list(&mut text, "U", signals(&step.inputs));
    list(&mut text, "Y", signals(&step.output_signals));
    let parameters = step.parameters.iter().map(|p| (p.name.clone(), p.unit.clone()));
    list(&mut text, "P", parameters.collect());
    for fixed in &step.fixed {
        let said = remark(&format!("{} = {:?}", fixed.name, fixed.value));
        let _ = writeln!(text, "/* a constant in here: {said} */");
    }
    let room = |count: usize| count.max(1);
    let depth: usize = lines.iter().map(|line| line.depth).sum();
    let next = if step.ramps { "const double *u_next, " } else { "" };
    let _ = write!(
        text,
        "\ntypedef struct {{\n    double p[{}]; /* parameters */\n    \
         double x[{}]; /* states of the model, then what effects remember */\n    \
         double c[{}]; /* numbers that follow from the parameters */\n",
        room(step.parameters.len()),
        room(step.remembered.len()),
        room(listing.prepared())
    );
    if !lines.is_empty() {
        let _ = write!(
            text,
            "    double past[{depth}]; /* delay lines, one after the other */\n    \
             long head[{0}];\n    long filled[{0}];\n",
            lines.len()
        );
    }
    let _ = write!(
        text,
        "    long sample; /* samples since the start */\n    int started;\n}} {name}_t;\n\n\
         /* Parameters at their values, states at their start. */\n\
         void {name}_init({name}_t *m);\n\
         /* States at their start; parameters stay. */\n\
         void {name}_reset({name}_t *m);\n\
         /* Call this after parameters were changed. */\n\
         void {name}_prepare({name}_t *m);\n\
         /* Outputs at this sample. */\n\
         void {name}_output(const {name}_t *m, const double *u, double *y);\n\
         /* Outputs at this sample{}, then on to the next one. */\n\
         void {name}_step({name}_t *m, const double *u, {next}double *y);\n\n#endif\n",
        if step.ramps { ", inputs moving to u_next along straight lines" } else { "" }
    );
    text
}

/// The definitions.
pub fn source(model: &Model<'_>) -> String {
    let (name, step) = (model.name, model.step);
    let upper = name.to_uppercase();
    let listing = Listing::of(step);
    let lines = step.tape.lines();
    let mut text = format!(
        "/* Written by `lacuna export`. */\n#include \"{name}.h\"\n\n#include <math.h>\n\n"
    );
    if listing.calls(Binary::Min) {
        text += "static double smaller(double a, double b) { return b < a || b != b ? b : a; }\n";
    }
    if listing.calls(Binary::Max) {
        text += "static double larger(double a, double b) { return b > a || b != b ? b : a; }\n";
    }
    if listing.calls_one(Unary::Signum) {
        text += "static double sign(double a) { return a < 0.0 ? -1.0 : a > 0.0 ? 1.0 : a; }\n";
    }
    text += "\n";
    let (held, line) = listing.delays();
    if held || line {
        let of = |get: &dyn Fn(usize) -> usize| {
            (0..lines.len()).map(|i| get(i).to_string()).collect::<Vec<_>>().join(", ")
        };
        let depths = of(&|i| lines[i].depth);
        let firsts = of(&|i| lines[..i].iter().map(|line| line.depth).sum());
        text += &include_str!("runtime/past.c")
            .replace("MODEL_T", &format!("{name}_t"))
            .replace("DEPTHS", &depths)
            .replace("FIRSTS", &firsts);
        if held {
            text += &include_str!("runtime/past_held.c").replace("MODEL_T", &format!("{name}_t"));
        }
        if line {
            text += &include_str!("runtime/past_line.c").replace("MODEL_T", &format!("{name}_t"));
        }
    }
    let body = |text: &mut String, lines: Vec<String>| {
        for line in lines {
            let _ = writeln!(text, "    {line};");
        }
    };
    let h = step.sampling_time / step.substeps as f64;
    let timed = listing.uses(|given| given == Given::Time);
    let time = if timed {
        format!("    const double t = (double)m->sample * {:?} + j * {h:?};\n", step.sampling_time)
    } else {
        String::new()
    };
    let unused = "    (void)m; (void)u; (void)u_next; (void)j;\n";
    let t_unused = if timed { "    (void)t;\n" } else { "" };
    let _ = writeln!(text, "void {name}_prepare({name}_t *m)\n{{\n    (void)m;");
    body(&mut text, listing.preparation(&C, &|i| format!("m->c[{i}]")));
    let _ = write!(
        text,
        "}}\n\nstatic void outputs(const {name}_t *m, const double *u, const double *u_next, \
         double j, double *y)\n{{\n{time}{unused}{t_unused}    (void)y;\n"
    );
    body(&mut text, listing.outputs(&C, &|i| format!("y[{i}]")));
    let _ = write!(
        text,
        "}}\n\n/* One step of the integrator. */\nstatic void advance({name}_t *m, const double *u, \
         const double *u_next, double j)\n{{\n{time}{unused}{t_unused}    double next[{}];\n",
        (step.next.len() + lines.len()).max(1)
    );
    body(&mut text, listing.next(&C, &|i| format!("next[{i}]")));
    if step.next.is_empty() && lines.is_empty() {
        text += "    next[0] = 0.0;\n    (void)next;\n";
    }
    for i in 0..step.next.len() {
        let _ = writeln!(text, "    m->x[{i}] = next[{i}];");
    }
    for i in 0..lines.len() {
        let _ = writeln!(text, "    enter(m, {i}, next[{}]);", step.next.len() + i);
    }
    text += "    m->started = 1;\n}\n\n";
    let _ = writeln!(text, "void {name}_reset({name}_t *m)\n{{");
    for (i, kept) in step.remembered.iter().enumerate() {
        let said = kept.signal.as_ref().map_or("kept by an effect", |signal| &signal.name);
        let value = number(kept.initial, "INFINITY", "NAN");
        let _ = writeln!(text, "    m->x[{i}] = {value}; /* {} */", remark(said));
    }
    for i in 0..lines.len() {
        let _ = writeln!(text, "    m->head[{i}] = 0;\n    m->filled[{i}] = 0;");
    }
    text += "    m->sample = 0;\n    m->started = 0;\n}\n\n";
    let _ = writeln!(text, "void {name}_init({name}_t *m)\n{{");
    for (i, parameter) in step.parameters.iter().enumerate() {
        let value = number(parameter.value, "INFINITY", "NAN");
        let _ = writeln!(text, "    m->p[{i}] = {value}; /* {} */", remark(&parameter.name));
    }
    let (next, u_next) = if step.ramps { ("const double *u_next, ", "u_next") } else { ("", "u") };
    let _ = write!(
        text,
        "    {name}_prepare(m);\n    {name}_reset(m);\n}}\n\n\
         void {name}_output(const {name}_t *m, const double *u, double *y)\n{{\n    \
         outputs(m, u, u, 0.0, y);\n}}\n\n\
         void {name}_step({name}_t *m, const double *u, {next}double *y)\n{{\n    int j;\n    \
         outputs(m, u, {u_next}, 0.0, y);\n    \
         for (j = 0; j < {}; j++) {{\n        advance(m, u, {u_next}, (double)j);\n    }}\n    \
         m->sample += 1;\n}}\n",
        step.substeps
    );
    text.replace("UPPER_", &format!("{upper}_"))
}

/// The test vector as arrays.
pub fn test_vector(model: &Model<'_>) -> String {
    let (step, vector) = (model.step, model.vector);
    let array = |name: &str, series: &[Vec<f64>], count: usize| {
        let width = count.max(1);
        let mut text = format!("static const double {name}[{}][{width}] = {{\n", vector.len());
        for k in 0..vector.len() {
            let row: Vec<String> = series.iter().map(|s| number(s[k], "INFINITY", "NAN")).collect();
            let row = if row.is_empty() { "0.0".into() } else { row.join(", ") };
            let _ = writeln!(text, "    {{{row}}},");
        }
        text + "};\n"
    };
    format!(
        "/* Inputs, and what `lacuna simulate` makes of them. */\n#define TEST_SAMPLES {}\n\n{}\n{}",
        vector.len(),
        array("test_u", &vector.inputs, step.inputs.len()),
        array("test_y", &vector.outputs, step.outputs.len())
    )
}

fn main(model: &Model<'_>) -> String {
    let next = if model.step.ramps { "test_u[k + 1 < TEST_SAMPLES ? k + 1 : k], " } else { "" };
    include_str!("runtime/main_test.c")
        .replace("U_NEXT", next)
        .replace("MODEL_", &format!("{}_", model.name.to_uppercase()))
        .replace("model", model.name)
}
