//! Files of one room that use each other in a circle: strongly connected components of the
//! graph of imports (Tarjan 1972).

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::{SHARED, code, files, is_test, room};

/// Circles that are there; each one is a debt, and none may be added. A circle that is mended
/// must be taken out of this list.
const KNOWN: [&str; 0] = [];

/// A file's place in the tree of modules of its room.
type Module = Vec<String>;

/// The modules of a room, each with its file.
fn modules(folder: &str) -> BTreeMap<Module, PathBuf> {
    let sources = files(folder, &["rs"]).into_iter().filter(|path| !is_test(path));
    sources
        .map(|path| {
            let inside = path.strip_prefix(folder).unwrap().with_extension("");
            let mut parts: Module =
                inside.iter().map(|part| part.to_str().unwrap().into()).collect();
            if ["mod", "lib", "main"].contains(&parts.last().unwrap().as_str()) {
                parts.pop();
            }
            (parts, path)
        })
        .collect()
}

/// The paths of a `use` or an expression that begins at `rest`: `a::b` or `a::{b, c::d}`.
fn paths(rest: &str) -> Vec<Module> {
    let plain: String =
        rest.chars().take_while(|c| c.is_ascii_alphanumeric() || "_:".contains(*c)).collect();
    let first: Module =
        plain.split("::").filter(|part| !part.is_empty()).map(String::from).collect();
    let Some(group) = rest[plain.len()..].strip_prefix('{') else { return vec![first] };
    let (mut depth, mut item, mut items) = (0, String::new(), vec![]);
    for c in group.chars() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            ',' if depth == 0 => items.push(std::mem::take(&mut item)),
            _ => {}
        }
        if c != ',' || depth > 0 {
            item.push(c);
        }
    }
    items.push(item);
    let inner = items.iter().map(|item| item.trim()).filter(|item| !item.is_empty());
    inner.flat_map(paths).map(|path| [first.clone(), path].concat()).collect()
}

/// The modules that a module uses.
fn used_by(
    own: &Module,
    text: &str,
    all: &BTreeMap<Module, PathBuf>,
    prefix: Option<&str>,
) -> BTreeSet<Module> {
    let mut found = BTreeSet::new();
    let mut note = |base: &[String], path: Module| {
        let full = [base.to_vec(), path].concat();
        let longest = (1..=full.len()).rev().find(|&n| all.contains_key(&full[..n]));
        // a module's own parents hold it; what it takes from them by name is not looked into
        let target = longest.map(|n| full[..n].to_vec());
        if let Some(target) = target.filter(|target| target != own && !own.starts_with(target)) {
            found.insert(target);
        }
    };
    for (at, _) in text.match_indices("super::") {
        if text[..at].ends_with("super::") {
            continue;
        }
        let (mut climbs, mut rest) = (0, &text[at..]);
        while let Some(next) = rest.strip_prefix("super::") {
            (climbs, rest) = (climbs + 1, next);
        }
        if let Some(kept) = own.len().checked_sub(climbs) {
            paths(rest).into_iter().for_each(|path| note(&own[..kept], path));
        }
    }
    let start = prefix.map_or("crate::".into(), |room| format!("crate::{room}::"));
    for (at, _) in text.match_indices(&start) {
        paths(&text[at + start.len()..]).into_iter().for_each(|path| note(&[], path));
    }
    found
}

/// Sets of modules each of which reaches all others of its set.
fn circles(graph: &BTreeMap<Module, BTreeSet<Module>>) -> Vec<BTreeSet<Module>> {
    let reach = |from: &Module| {
        let (mut seen, mut open) = (BTreeSet::new(), vec![from.clone()]);
        while let Some(module) = open.pop() {
            for next in &graph[&module] {
                if seen.insert(next.clone()) {
                    open.push(next.clone());
                }
            }
        }
        seen
    };
    let reached: BTreeMap<_, _> = graph.keys().map(|module| (module, reach(module))).collect();
    let mut found: Vec<BTreeSet<Module>> = vec![];
    for (module, seen) in &reached {
        let circle: BTreeSet<Module> =
            seen.iter().filter(|other| reached[other].contains(*module)).cloned().collect();
        if circle.len() > 1 && !found.contains(&circle) {
            found.push(circle);
        }
    }
    found
}

#[test]
fn groups_of_a_use_are_read() {
    let read: Vec<String> = paths("a::{b, c::{d, e}};").iter().map(|p| p.join("::")).collect();
    assert_eq!(read, ["a::b", "a::c::d", "a::c::e"]);
}

#[test]
fn no_circle_of_files_in_a_room() {
    let mut folders: BTreeMap<String, (String, bool)> = BTreeMap::new();
    for path in files("src", &["rs"]) {
        let shared = SHARED.iter().any(|name| path.starts_with(Path::new("src").join(name)));
        let parts = if shared { 3 } else { 2 };
        let folder: PathBuf = path.components().take(parts).collect();
        if folder.extension().is_none() {
            folders.insert(folder.to_str().unwrap().into(), (room(&path), shared));
        }
    }
    let mut found = BTreeSet::new();
    for (folder, (room, shared)) in folders {
        let all = modules(&folder);
        let prefix = shared.then_some(room.as_str());
        let graph: BTreeMap<Module, BTreeSet<Module>> = all
            .iter()
            .map(|(module, path)| (module.clone(), used_by(module, &code(path), &all, prefix)))
            .collect();
        for circle in circles(&graph) {
            let names: Vec<String> = circle.iter().map(|module| module.join("/")).collect();
            found.insert(format!("{folder}: {}", names.join(", ")));
        }
    }
    let known: BTreeSet<String> = KNOWN.iter().map(|circle| (*circle).into()).collect();
    let fresh: Vec<_> = found.difference(&known).collect();
    assert!(fresh.is_empty(), "files that use each other in a circle:\n{fresh:#?}");
    let mended: Vec<_> = known.difference(&found).collect();
    assert!(mended.is_empty(), "mended, take out of the list:\n{mended:#?}");
}
