//! `lacuna look --model M --data D`: the missing force of every channel, without a search.

use super::args::Look as Args;
use super::console::Console;
use super::failure::Failure;
use super::input;
use super::outputs::{self, cannot_write};
use lacuna::fault::Place;
use lacuna::file::write_text;
use lacuna::likelihood::Predictor;
use lacuna::report::{MissingReport, documents};

/// The page, in its folder.
const PAGE: &str = "look.html";

/// Shows what a model leaves unexplained on records.
pub fn run(args: &Args, look: &Console) -> Result<u8, Failure> {
    let Some(model) = &args.model else {
        let place = Place { key: Some("--model".into()), ..Place::default() };
        let hint = "add --model FILE: the missing force is what a model lacks".into();
        return Err(Failure::input("no model was given to look with".into(), place, hint));
    };
    let mut inputs = outputs::paths(&[&args.data]);
    inputs.push(model);
    outputs::check(&inputs, &outputs::within(&args.out, &[PAGE]), look)?;
    let (system, want) = input::model(model)?;
    let records = input::records(&args.data, &want, &args.columns, look)?;
    let missing = Predictor::new(&system, &records)?.missing()?;
    let step = records.first().map_or(1.0, |record| record.sampling_time);
    let report = MissingReport::of(&missing, step);
    for line in report.lines() {
        look.result(&line);
    }
    let page = args.out.join(PAGE);
    std::fs::create_dir_all(&args.out).map_err(|error| cannot_write(&args.out, &error))?;
    write_text(&page, &report.html("Missing force"))
        .map_err(|error| cannot_write(&page, &error))?;
    look.say(&format!("Wrote {}", page.display()));
    look.document(&documents::missing(&missing, Some(&page.display().to_string())));
    Ok(0)
}
