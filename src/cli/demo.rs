//! `lacuna demo`: the main job on a record that the program brings along.

use super::args::Demo;
use super::console::Console;
use super::diagnose::look_for;
use super::failure::Failure;
use super::input;
use lacuna::data::{Record, Table};
use lacuna::diagnose::Diagnosis;
use lacuna::file::{Format, parse};

/// The model: two masses, without what is hidden in the record.
const MODEL: &str = include_str!("demo/model.toml");
/// Records of a machine with a hidden effect, made by `examples/demo_record.rs`.
const EST: &[u8] = include_bytes!("demo/est.csv.gz");
const TEST: &[u8] = include_bytes!("demo/test.csv.gz");

pub fn run(args: &Demo, look: &Console) -> Result<u8, Failure> {
    let system = parse(MODEL, "demo/model.toml", Format::Toml)?;
    let want = input::want(&system)?;
    let read = |bytes: &[u8], name: &str| -> Result<Record, Failure> {
        Ok(Table::read(bytes, name)?.record_for(&want)?.0)
    };
    let (records, test) = ([read(EST, "demo/est.csv")?], read(TEST, "demo/test.csv")?);
    look.say("Two masses between springs, pushed at the first and measured at the second.");
    look.say("The model knows all of it but one thing. What is missing?");
    let diagnosis = Diagnosis::of(&system);
    look_for(&diagnosis, &system, &records, Some(&test), "a mass-spring-damper", &args.out, look)
}
