//! Makes docs/results.md of the files in docs/results.
//!
//! ```console
//! $ cargo run --example results_page
//! ```
//!
//! With a folder as argument, the page is written there.

use std::path::{Path, PathBuf};

#[path = "../tests/results/page.rs"]
mod page;

fn main() -> std::io::Result<()> {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let claims = page::claims(&docs.join("results"))?;
    let to = std::env::args().nth(1).map_or(docs, PathBuf::from);
    std::fs::write(to.join("results.md"), page::page(&claims))
}
