//! Pages with their stored form, and `lacuna report`, which draws them again from it.

use std::path::{Path, PathBuf};

use super::args::Report as Args;
use super::console::{Console, print};
use super::failure::Failure;
use super::outputs::{self, cannot_write};
use super::stdout;
use lacuna::fault::Place;
use lacuna::file::write_text;
use lacuna::report::Page;

/// The stored form of a page, beside it.
pub const STORED: &str = "report-data.json";
/// The page.
const PAGE: &str = "report.html";

/// Writes a page and its stored form into a folder.
pub fn write(page: &Page, folder: &Path, name: &str) -> Result<(), Failure> {
    put(&folder.join(name), &page.html())?;
    put(&folder.join(STORED), &page.stored())
}

fn put(path: &Path, text: &str) -> Result<(), Failure> {
    write_text(path, text).map_err(|error| cannot_write(path, &error))
}

/// `lacuna report`: draws the page of a folder again.
pub fn run(args: &Args, look: &Console) -> Result<u8, Failure> {
    // a folder, or a file in it such as diagnosis.json
    let folder = match args.of.is_dir() {
        true => args.of.clone(),
        false => args.of.parent().map_or_else(PathBuf::new, Path::to_path_buf),
    };
    let stored = folder.join(STORED);
    let text = std::fs::read_to_string(&stored).map_err(|error| {
        let place = Place { file: Some(stored.display().to_string()), ..Place::default() };
        let message = format!("{}cannot be read ({error})", place.lead());
        let hint =
            "give the folder of a result: `lacuna diagnose` writes this file beside report.html";
        Failure::input(message, place, hint.into())
    })?;
    let page = Page::from_stored(&text).map_err(|reason| {
        Failure::work(format!(
            "{}: not the stored form of a report ({reason}); run the diagnosis again",
            stored.display()
        ))
    })?;
    let path = args.out.clone().unwrap_or_else(|| folder.join(PAGE));
    if stdout::given_to(&path, look)? {
        print(&page.html());
        return Ok(0);
    }
    outputs::check(&[&stored], std::slice::from_ref(&path), look)?;
    put(&path, &page.html())?;
    look.result(&format!("Wrote {}", path.display()));
    look.document(&serde_json::json!({ "schema": 1, "report": path.display().to_string() }));
    Ok(0)
}
