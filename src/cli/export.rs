//! `lacuna export`.

use serde_json::json;

use super::args::{Export, ExportTo};
use super::console::Console;
use super::failure::Failure;
use super::input;
use super::outputs;
use lacuna::export::{Target, sources};

pub fn run(args: &Export, look: &Console) -> Result<u8, Failure> {
    let (system, _) = input::model(&args.model)?;
    let target = match args.to {
        ExportTo::C => Target::C,
        ExportTo::Fmu => Target::Fmu,
        ExportTo::Matlab => Target::Matlab,
        ExportTo::Python => Target::Python,
    };
    let sources = sources(&system, target, &args.name)?;
    outputs::check(&[&args.model], &outputs::within(&args.out, &sources.names()), look)?;
    let written = sources.write(&args.out)?;
    for remark in &written.remarks {
        look.say(remark);
    }
    let files: Vec<String> = written.files.iter().map(|file| file.display().to_string()).collect();
    for file in &files {
        look.result(&format!("Wrote {file}"));
    }
    look.document(&json!({ "schema": 1, "files": files, "remarks": written.remarks }));
    Ok(0)
}
