//! The page of results says what the files beside it hold.

use std::fs;
use std::path::Path;

mod defects;
mod page;

#[test]
fn the_page_is_made_of_the_files() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let claims = page::claims(&docs.join("results")).unwrap();
    assert!(claims.len() > 10, "{} claims", claims.len());
    let written = fs::read_to_string(docs.join("results.md")).unwrap();
    assert!(
        written == page::page(&claims),
        "docs/results.md is not what docs/results/*.json say: cargo run --example results_page"
    );
}

#[test]
fn what_failed_is_as_visible_as_what_worked() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    for (name, claim) in page::claims(&docs.join("results")).unwrap() {
        let silent = claim.passed == Some(false) && claim.missed.is_empty();
        assert!(!silent, "{name} is not passed and does not say what was missed");
        assert!(!claim.command.is_empty() && claim.date.len() == 10, "{name}: command or date");
    }
}
