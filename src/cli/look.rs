//! `lacuna look`: a record before any model, or the missing force of a model on it.

use serde_json::json;

use super::args::Look as Args;
use super::console::Console;
use super::failure::Failure;
use super::no_model::Asked;
use super::outputs::{self, cannot_write};
use super::{input, missing};
use lacuna::diagnose::{AtLines, Distortion, distortion};
use lacuna::digits::number;
use lacuna::file::write_text;
use lacuna::look::Look;
use lacuna::report::documents::looked;

/// The page of a look.
const PAGE: &str = "look.html";

pub fn run(args: &Args, look: &Console) -> Result<u8, Failure> {
    if args.model.is_some() {
        return missing::run(args, look);
    }
    let inputs = outputs::paths(&[&args.data]);
    let mut pages = vec![];
    let asked = Asked { columns: &args.columns, step: args.sampling_time, order: None };
    let mut records = vec![];
    for path in &args.data {
        for table in input::tables(path)? {
            let (record, remarks) = asked.record_to_look_at(table)?;
            input::say_remarks(path, &remarks, look);
            if record.inputs.is_empty() {
                let named: Vec<&str> = record.outputs.iter().map(|s| &s.name[..]).collect();
                look.say(&format!(
                    "{}: no column is known to drive the machine, so delays, coherence and excitation are \
                     not looked for; name it by --inputs, of: {}",
                    path.display(),
                    named.join(", ")
                ));
            }
            pages.push(if pages.is_empty() {
                PAGE.into()
            } else {
                format!("look-{}.html", pages.len() + 1)
            });
            records.push(record);
        }
    }
    let files: Vec<&str> = pages.iter().map(String::as_str).collect();
    outputs::check(&inputs, &outputs::within(&args.out, &files), look)?;
    std::fs::create_dir_all(&args.out).map_err(|error| cannot_write(&args.out, &error))?;
    if args.columns.repair {
        let names = (0..records.len()).map(|k| args.out.join(input::repaired(k)));
        outputs::apart(&inputs, &names.collect::<Vec<_>>())?;
        input::keep_repaired(&records, &args.columns, &args.out, look)?;
    }
    let mut documents = vec![];
    for (record, page) in records.iter().zip(&pages) {
        let found = Look::of(record);
        if records.len() > 1 {
            look.headline(&format!("{} ({page})", record.source));
        }
        look.result(&found.to_string());
        let distorted = distortion(std::slice::from_ref(record));
        for (name, distortion) in &distorted {
            look.result(&parity(name, distortion));
        }
        let path = args.out.join(page);
        write_text(&path, &found.page(&record.source))
            .map_err(|error| cannot_write(&path, &error))?;
        let document = looked(&found, &distorted, Some(&path.display().to_string()));
        documents.push(document.map_err(Failure::unwritable)?);
    }
    look.introduce(&format!("Wrote {} into {}", pages.join(", "), args.out.display()));
    look.document(&json!({ "schema": 1, "records": documents }));
    Ok(0)
}

/// What lines that the inputs leave empty say about what is not linear.
fn parity(name: &str, found: &Distortion) -> String {
    let kind = |word: &str, at: &Option<AtLines>| match at {
        Some(at) => {
            let level = if at.present { "there" } else { "not above the noise" };
            let (rms, noise) = (number(at.rms, None), number(at.noise_rms, None));
            format!("{word} {level} ({rms} rms, noise {noise})")
        }
        None => format!("{word} cannot be told"),
    };
    let excited = number(found.excited_rms, None);
    let (odd, even) = (kind("odd", &found.odd), kind("even", &found.even));
    format!(
        "{name}: distortion at lines that the inputs leave empty, beside {excited} rms at the others: {odd}, {even}"
    )
}
