//! The house rules: who may use whom, how long a file may be, what no file may mention.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

mod circles;
mod words;

/// Files of one concept that needs more than 300 lines; 450 are the limit.
const LONGER: [&str; 14] = [
    "src/core/effect/written.rs",
    "src/core/data/error.rs",
    "src/diagnose/finding.rs",
    "src/diagnose/fit/problem.rs",
    "src/learn/encoder/baseline.rs",
    "src/learn/lfr/engine.rs",
    "src/learn/lfr/program.rs",
    "src/learn/network/kernel.rs",
    "src/learn/train/steps.rs",
    "src/core/optimise/levenberg.rs",
    "src/core/system/engine.rs",
    "src/core/system/wiring.rs",
    "tests/encoder/initialisers.rs",
    "tests/training.rs",
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// All files below a folder with one of these endings, by their path from the root.
fn files(folder: &str, endings: &[&str]) -> Vec<PathBuf> {
    let mut found = vec![];
    let mut folders = vec![root().join(folder)];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
            let path = entry.path();
            match path.is_dir() {
                true if path.file_name().is_some_and(|name| name == "target") => {}
                true => folders.push(path),
                false => {
                    let ending = path.extension().and_then(|e| e.to_str()).unwrap_or("");
                    if endings.contains(&ending) {
                        found.push(path.strip_prefix(root()).unwrap().into());
                    }
                }
            }
        }
    }
    assert!(!found.is_empty(), "nothing in {folder}");
    found.sort();
    found
}

fn text(path: &Path) -> String {
    fs::read_to_string(root().join(path)).unwrap()
}

/// The table of rooms in the tour: every room and those it may use, from the ground up.
fn rooms() -> Vec<(String, BTreeSet<String>)> {
    let tour = text(Path::new("docs/tour.md"));
    let names = |cell: &str| -> Vec<String> {
        cell.split('`').skip(1).step_by(2).map(String::from).collect()
    };
    let rows = tour.lines().skip_while(|line| !line.starts_with("| room |")).skip(2);
    let rooms: Vec<_> = rows
        .take_while(|line| line.starts_with('|'))
        .map(|line| {
            let cells: Vec<&str> = line.trim_matches('|').split('|').collect();
            assert_eq!(cells.len(), 4, "{line}");
            (names(cells[0]).remove(0), names(cells[3]).into_iter().collect())
        })
        .collect();
    assert!(rooms.len() > 10, "the table of rooms cannot be read");
    rooms
}

/// Crates of several rooms; every other folder of `src` is a crate of one.
const SHARED: [&str; 2] = ["core", "learn"];

/// The room of a source file: its crate, or its folder or file in a crate of several.
fn room(path: &Path) -> String {
    let inside = path.strip_prefix("src").unwrap();
    let mut parts = inside.components().map(|part| Path::new(part.as_os_str()));
    let first = parts.next().unwrap();
    let shared = SHARED.iter().any(|name| first == Path::new(name));
    let room = if shared { parts.next().unwrap() } else { first };
    room.file_stem().unwrap().to_str().unwrap().into()
}

/// The code of a file: without comments, texts in quotes and items of tests.
fn code(path: &Path) -> String {
    without_tests(&text(path))
}

fn without_tests(text: &str) -> String {
    let (mut code, mut depth, mut in_test) = (String::new(), 0_i32, false);
    for line in text.lines() {
        if line.trim() == "#[cfg(test)]" {
            (in_test, depth) = (true, 0);
            continue;
        }
        let line = line.split("//").next().unwrap();
        let quoted = line.split('"').step_by(2).collect::<Vec<_>>().join("\"\"");
        if in_test {
            let count = |c: char| quoted.matches(c).count() as i32;
            depth += count('{') - count('}');
            let ends = quoted.trim_end().ends_with([';', '}']);
            in_test = depth > 0 || !ends;
            continue;
        }
        code += &quoted;
        code.push('\n');
    }
    code
}

fn is_test(path: &Path) -> bool {
    path.components().any(|c| c.as_os_str() == "tests")
        || path.file_stem().is_some_and(|s| s.to_str().unwrap().ends_with("tests"))
}

/// First parts of all paths that begin at the root of the crate, macros apart:
/// `crate::data::Record`, `use crate::{data, real}`, `lacuna::data`.
fn used(code: &str) -> BTreeSet<String> {
    let word = |text: &str| -> String {
        text.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_').collect()
    };
    let mut found = BTreeSet::new();
    for start in ["crate::", "lacuna::"] {
        for (at, _) in code.match_indices(start) {
            let rest = &code[at + start.len()..];
            if !rest.starts_with('{') {
                let name = word(rest);
                // a macro has no room
                if !rest[name.len()..].starts_with('!') {
                    found.insert(name);
                }
                continue;
            }
            let (mut depth, mut fresh) = (0, false);
            for (i, c) in rest.char_indices() {
                match c {
                    '{' => (depth, fresh) = (depth + 1, depth == 0),
                    '}' => depth -= 1,
                    ',' if depth == 1 => fresh = true,
                    c if fresh && !c.is_whitespace() => {
                        found.insert(word(&rest[i..]));
                        fresh = false;
                    }
                    _ => {}
                }
                if depth == 0 {
                    break;
                }
            }
        }
    }
    found
}

#[test]
fn paths_are_read_as_the_compiler_reads_them() {
    let code = "use crate::{data::{Record, noise}, real};\nlet x = crate::file::load();\ncrate::per_lanes! {";
    let names: Vec<String> = used(code).into_iter().collect();
    assert_eq!(names, ["data", "file", "real"]);
}

#[test]
fn items_of_tests_are_left_out_and_nothing_behind_them() {
    let text =
        "use a;\n#[cfg(test)]\nmod tests {\n    use b;\n}\n#[cfg(test)]\nmod more;\nuse c;\n";
    assert_eq!(without_tests(text), "use a;\nuse c;\n");
}

#[test]
fn every_room_stands_in_the_tour() {
    let known: BTreeSet<String> = rooms().into_iter().map(|(name, _)| name).collect();
    let found: BTreeSet<String> =
        files("src", &["rs"]).iter().map(|path| room(path)).filter(|name| name != "lib").collect();
    let missing: Vec<_> = found.difference(&known).collect();
    assert!(missing.is_empty(), "not in the table of docs/tour.md: {missing:?}");
    let gone: Vec<_> = known.difference(&found).collect();
    assert!(gone.is_empty(), "in the table of docs/tour.md, but not in src: {gone:?}");
}

#[test]
fn a_room_uses_only_rooms_above_it() {
    let rooms = rooms();
    for (i, (name, uses)) in rooms.iter().enumerate() {
        for used in uses.iter().filter(|used| *used != "plugins") {
            let above = rooms[..i].iter().any(|(other, _)| other == used);
            assert!(above, "the table lets `{name}` use `{used}`, which does not stand above it");
        }
    }
}

#[test]
fn sources_keep_to_the_table() {
    let allowed: BTreeMap<String, BTreeSet<String>> = rooms().into_iter().collect();
    // macros and the number types' own helpers are exported at the root
    let everywhere = ["__private"];
    let macros = ["per_lanes", "per_isa"];
    let (mut wrong, mut needed) = (vec![], BTreeMap::<String, BTreeSet<String>>::new());
    for path in files("src", &["rs"]).iter().filter(|path| !is_test(path)) {
        let own = room(path);
        if own == "lib" {
            continue;
        }
        let alone = !SHARED.iter().any(|name| path.starts_with(Path::new("src").join(name)));
        for name in used(&code(path)) {
            let fine = name == own
                // in a crate of one room, what is no other room is its own
                || (alone && !allowed.contains_key(&name))
                || everywhere.contains(&name.as_str())
                || macros.contains(&name.as_str())
                || allowed[&own].contains(&name);
            needed.entry(own.clone()).or_default().insert(name.clone());
            if !fine {
                wrong.push(format!("{}: `{own}` uses `{name}`", path.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "against the table in docs/tour.md:\n{}", wrong.join("\n"));
    for (room, allowed) in allowed {
        let needed = needed.remove(&room).unwrap_or_default();
        let spare: Vec<_> = allowed.difference(&needed).collect();
        assert!(spare.is_empty(), "`{room}` may use {spare:?}, and does not");
    }
}

#[test]
fn no_path_climbs_out_of_its_room() {
    // the compiler sees to it in crates of one room
    let shared = SHARED.map(|name| files(&format!("src/{name}"), &["rs"])).concat();
    for path in shared.iter().filter(|path| !is_test(path)) {
        let code = code(path);
        let inside: PathBuf = path.components().skip(2).collect();
        let own = usize::from(!["mod.rs", "lib.rs"].iter().any(|name| inside.ends_with(name)));
        let depth = inside.components().count() - 1 + own;
        let modules = code.lines().filter(|l| l.contains("mod ") && l.ends_with('{')).count();
        let mut climb = String::from("super::");
        for _ in 0..depth.saturating_sub(1) + modules.min(1) {
            climb += "super::";
        }
        assert!(!code.contains(&climb), "{} climbs out by {climb}", path.display());
    }
}

#[test]
fn plug_ins_could_live_elsewhere() {
    for path in files("plugins", &["rs"]) {
        if path.starts_with("plugins/outside")
            || path.ends_with("mod.rs")
            || path.ends_with("lib.rs")
        {
            continue;
        }
        let code = code(&path);
        assert!(!code.contains("crate::"), "{} says `crate::`", path.display());
        assert!(code.contains("use lacuna::prelude::*;"), "{}", path.display());
    }
}

#[test]
fn files_stay_short() {
    let mut long = vec![];
    for folder in ["src", "plugins", "tests", "examples", "python"] {
        for path in files(folder, &["rs", "py"]) {
            let longer = LONGER.contains(&path.to_str().unwrap());
            let limit = if longer { 450 } else { 300 };
            let lines = text(&path).lines().count();
            if lines > limit {
                long.push(format!("{} has {lines} lines, {limit} allowed", path.display()));
            }
        }
    }
    assert!(long.is_empty(), "split these:\n{}", long.join("\n"));
}

#[test]
fn no_file_names_a_place_of_one_machine() {
    let places = ["tmp", "work", "root", "home"].map(|name| format!("/{name}/"));
    let mut all = vec![PathBuf::from("README.md"), "Cargo.toml".into(), ".ci/run".into()];
    for folder in ["src", "plugins", "tests", "examples", "docs", "python"] {
        all.extend(files(folder, &["rs", "md", "toml", "css", "json", "py", "ipynb"]));
    }
    for path in all {
        for (number, line) in text(&path).lines().enumerate() {
            let named = places.iter().find(|place| line.contains(place.as_str()));
            assert!(named.is_none(), "{}, line {}: {line}", path.display(), number + 1);
        }
    }
}
