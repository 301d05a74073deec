//! Every function that docs/theory.md names exists, and so does every label it cites.

use std::fs;
use std::path::{Path, PathBuf};

fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        match entry.is_dir() {
            true => files(&entry, found),
            false => found.push(entry),
        }
    }
}

/// All code of a room, which is a folder or a file.
fn room(name: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = ["src/core", "src/learn", "src", ""]
        .map(|crates| root.join(crates).join(name))
        .into_iter()
        .find(|folder| folder.is_dir() || folder.with_extension("rs").exists());
    let folder = folder.unwrap_or_else(|| panic!("no room `{name}`"));
    let mut found = vec![];
    match folder.is_dir() {
        true => files(&folder, &mut found),
        false => found.push(folder.with_extension("rs")),
    }
    let text = |path: &PathBuf| fs::read_to_string(path).unwrap_or_default();
    found.iter().map(text).collect()
}

#[test]
fn every_name_of_the_table_is_there() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let theory = fs::read_to_string(root.join("docs/theory.md")).unwrap();
    let quoted = theory.split('`').skip(1).step_by(2);
    let (mut names, mut paths) = (0, 0);
    for name in quoted {
        if name.contains('/') {
            assert!(root.join(name).exists(), "{name} is not there");
            paths += 1;
            continue;
        }
        let Some((first, rest)) = name.split_once("::") else { continue };
        let code = room(first);
        for part in rest.split("::") {
            let declared = ["struct", "enum", "trait", "fn", "mod", "const", "type", "pub"]
                .iter()
                .any(|word| code.contains(&format!("{word} {part}")));
            let variant = code.contains(&format!("    {part}("))
                || code.contains(&format!("    {part},"))
                || code.contains(&format!("    {part} {{"));
            assert!(declared || variant, "{name}: no `{part}` in {first}");
        }
        names += 1;
    }
    assert!(names > 40 && paths > 3, "{names} names and {paths} files");
    // all 22 items of the paper
    for item in 1..=22 {
        assert!(theory.contains(&format!("| {item} |")), "item {item} is missing");
    }
}
