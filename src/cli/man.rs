//! `lacuna man`: the manual pages.

use serde_json::json;

use super::args::{Man, help::command};
use super::console::{Console, print};
use super::failure::Failure;
use super::outputs::cannot_write;
use super::reference;
use lacuna::file::write_text;

pub fn run(args: &Man, look: &Console) -> Result<u8, Failure> {
    let command = command();
    if let Some(folder) = &args.out {
        std::fs::create_dir_all(folder).map_err(|error| cannot_write(folder, &error))?;
        if args.markdown {
            for (name, text) in reference::pages(command) {
                let path = folder.join(name);
                write_text(&path, &text).map_err(|error| cannot_write(&path, &error))?;
            }
            look.introduce(&format!("Wrote the reference into {}", folder.display()));
            look.document(&json!({ "schema": 1, "folder": folder }));
            return Ok(0);
        }
        clap_mangen::generate_to(command, folder).map_err(|error| cannot_write(folder, &error))?;
        look.introduce(&format!("Wrote the manual pages into {}", folder.display()));
        look.document(&json!({ "schema": 1, "folder": folder }));
        return Ok(0);
    }
    let mut page = vec![];
    let written = clap_mangen::Man::new(command).render(&mut page);
    written.map_err(|error| Failure::work(format!("the manual page cannot be made: {error}")))?;
    let text = String::from_utf8_lossy(&page);
    if look.json {
        look.document(&json!({ "schema": 1, "page": text }));
    } else {
        print(&text);
    }
    Ok(0)
}
