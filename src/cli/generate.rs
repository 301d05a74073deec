//! `lacuna generate`.

use std::fs;
use std::path::Path;

use super::args::Generate as Args;
use super::console::Console;
use super::failure::Failure;
use lacuna::digits::number;
use lacuna::file::{Document, load};
use lacuna::study::Generate;

pub fn run(args: &Args, seed: u64, look: &Console) -> Result<u8, Failure> {
    let how: Generate = Document::load(&args.config)?.read()?;
    let beside = args.config.parent().unwrap_or(Path::new("")).join(&how.model);
    let system = load(&beside)?;
    let made = how.make(&system, seed)?;
    let cannot = |path: &Path, error: &std::io::Error| {
        Failure::work(format!("{}: cannot be written ({error})", path.display()))
    };
    fs::create_dir_all(&args.out).map_err(|error| cannot(&args.out, &error))?;
    made.est.write_csv(args.out.join("est.csv"))?;
    made.test.write_csv(args.out.join("test.csv"))?;
    let document = serde_json::to_value(&made.truth)
        .map_err(|error| Failure::work(format!("the truth cannot be written: {error}")))?;
    let path = args.out.join("truth.json");
    fs::write(&path, format!("{document:#}\n")).map_err(|error| cannot(&path, &error))?;
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
