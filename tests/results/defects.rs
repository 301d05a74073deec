//! The table of defects names tests, and those tests are there.

use std::fs;
use std::path::{Path, PathBuf};

fn sources(folder: &Path, all: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
        match entry.path() {
            path if path.is_dir() => sources(&path, all),
            path if path.extension().is_some_and(|end| end == "rs") => all.push(path),
            _ => {}
        }
    }
}

#[test]
fn every_test_that_the_table_names_is_there() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = vec![];
    ["src", "tests", "plugins"].iter().for_each(|folder| sources(&root.join(folder), &mut files));
    let stems: Vec<&str> =
        files.iter().filter_map(|path| path.file_stem().and_then(|s| s.to_str())).collect();
    let code: String = files.iter().map(|path| fs::read_to_string(path).unwrap()).collect();
    let table = fs::read_to_string(root.join("docs/results/defects.md")).unwrap();
    let rows: Vec<&str> = table.lines().filter(|line| line.starts_with("| ")).collect();
    assert!(rows.len() > 40, "{} rows", rows.len());
    let mut named = 0;
    for row in rows {
        let tests = row.trim_end_matches([' ', '|']).rsplit('|').next().unwrap();
        for name in tests.split('`').skip(1).step_by(2) {
            let last = name.rsplit("::").next().unwrap();
            let there = code.contains(&format!("fn {last}("));
            // a file of tests, where the row is about many of them
            assert!(there || stems.contains(&last), "no test `{name}`, which is named in: {row}");
            named += 1;
        }
    }
    assert!(named > 30, "{named} names");
}
