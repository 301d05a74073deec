//! `lacuna demo`: the main job on a record that the program brings along.

use super::args::Demo;
use super::console::Console;
use super::diagnose::{FILES, Results, look_for};
use super::failure::Failure;
use super::{outputs, provenance};
use lacuna::data::{Record, Table};
use lacuna::diagnose::Diagnosis;
use lacuna::evaluate::want;
use lacuna::file::{Format, parse};

/// The model: two masses, without what is hidden in the record.
const MODEL: &str = include_str!("demo/model.toml");
/// Records of a machine with a hidden effect, made by `examples/demo_record.rs`.
const EST: &[u8] = include_bytes!("demo/est.csv.gz");
const TEST: &[u8] = include_bytes!("demo/test.csv.gz");

pub fn run(args: &Demo, seed: u64, look: &Console) -> Result<u8, Failure> {
    outputs::check(&[], &outputs::within(&args.out, &FILES), look)?;
    let system = parse(MODEL, "demo/model.toml", Format::Toml)?;
    let want = want(&system)?;
    let read = |bytes: &[u8], name: &str| -> Result<Record, Failure> {
        Ok(Table::read(bytes, name)?.record_for(&want)?.0)
    };
    let (records, test) = ([read(EST, "demo/est.csv")?], read(TEST, "demo/test.csv")?);
    look.introduce("Two masses between springs, pushed at the first and measured at the second.");
    look.introduce("The model knows all of it but one thing. What is missing?");
    let diagnosis = Diagnosis::of(&system);
    let from = provenance::of_this_call(seed)
        .embedded("model", "demo/model.toml", MODEL.as_bytes())
        .embedded("data", "demo/est.csv.gz", EST)
        .embedded("test", "demo/test.csv.gz", TEST);
    let title = "a mass-spring-damper";
    let rehearse = (args.rehearse, (1, 1));
    let results = Results { title, out: &args.out, from, rehearse };
    look_for(&diagnosis, &records, Some(&test), results, look)
}
