//! `lacuna generate`.

use std::fs;
use std::path::Path;

use serde_json::{Map, Value, json};

use super::args::Generate as Args;
use super::console::Console;
use super::failure::Failure;
use super::outputs::{self, cannot_write};
use lacuna::digits::number;
use lacuna::file::{Document, load, write_text};
use lacuna::study::Generate;

/// What is written.
const FILES: [&str; 3] = ["est.csv", "test.csv", "truth.json"];

pub fn run(args: &Args, seed: u64, look: &Console) -> Result<u8, Failure> {
    let config = Document::load(&args.config)?;
    let how: Generate = config.read()?;
    let model = args.config.parent().unwrap_or(Path::new("")).join(&how.model);
    outputs::check(&[&args.config, &model], &outputs::within(&args.out, &FILES), look)?;
    let system = load(&model)?;
    // what is hidden counts behind the effects that the model has
    let hidden = if system.effects.is_empty() { ["effects[", "hidden["] } else { [""; 2] };
    let located = |error| Failure::from(error).in_file(&args.config, &config, hidden);
    let made = how.make(&system, seed).map_err(located)?;
    fs::create_dir_all(&args.out).map_err(|error| cannot_write(&args.out, &error))?;
    let mut sums = Map::new();
    for (name, record) in [("est.csv", &made.est), ("test.csv", &made.test)] {
        let path = args.out.join(name);
        record.write_csv(&path)?;
        sums.insert(name.into(), json!(outputs::checksum(&path)));
    }
    let mut document = serde_json::to_value(&made.truth)
        .map_err(|error| Failure::work(format!("the truth cannot be written: {error}")))?;
    let path = args.out.join("truth.json");
    // so that another call knows these records as its own, and replaces no measured one
    document["crc32"] = Value::Object(sums);
    write_text(&path, &format!("{document:#}\n")).map_err(|error| cannot_write(&path, &error))?;
    for (record, outputs) in &made.truth.records {
        for (name, truth) in outputs {
            look.result(&format!(
                "{record}, {name}: standard deviation {}, noise {}, hidden effects change it by {} rms",
                number(truth.std, None),
                number(truth.noise_rms, None),
                number(truth.hidden_rmse, None),
            ));
        }
    }
    look.say(&format!("Wrote est.csv, test.csv and truth.json into {}", args.out.display()));
    look.document(&document);
    Ok(0)
}
