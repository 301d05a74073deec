//! Names in the sources are in the words of the field (docs/terms.md), not in the private ones that
//! earlier versions had.

use super::{files, text};

/// Words that name nothing: what they stood for has a term.
const PRIVATE: [&str; 14] = [
    "alone", "believe", "believed", "beside", "felt", "knob", "knobs", "shown", "story", "tell",
    "teller", "tells", "together", "told",
];

/// Text without comments, strings and characters.
fn names_only(text: &str) -> String {
    let (mut out, mut rest) = (String::new(), text);
    while let Some(first) = rest.chars().next() {
        let skipped = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if let Some(raw) = rest.strip_prefix("r#\"") {
            raw.find("\"#").map_or(rest.len(), |end| end + 5)
        } else if let Some(quoted) = rest.strip_prefix('"') {
            let mut escaped = false;
            let end = quoted.find(|c| {
                let ends = c == '"' && !escaped;
                escaped = c == '\\' && !escaped;
                ends
            });
            end.map_or(rest.len(), |end| end + 2)
        } else if rest.starts_with("'\"'") {
            3
        } else if rest.starts_with("'\\\"'") {
            4
        } else {
            0
        };
        match skipped {
            0 => {
                out.push(first);
                rest = &rest[first.len_utf8()..];
            }
            n => {
                out.push(' ');
                rest = &rest[n..];
            }
        }
    }
    out
}

/// The words of a name: `held_out`, `HeldOut` and `HELD_OUT` are held, out.
fn words(name: &str) -> Vec<String> {
    let mut spaced = String::new();
    let mut before = '_';
    for c in name.chars() {
        if c.is_uppercase() && before.is_lowercase() {
            spaced.push('_');
        }
        spaced.push(c);
        before = c;
    }
    spaced.to_lowercase().split('_').map(String::from).collect()
}

fn private(text: &str) -> Vec<String> {
    let code = names_only(text);
    let names = code.split(|c: char| !c.is_alphanumeric() && c != '_');
    names
        .filter(|name| words(name).iter().any(|word| PRIVATE.contains(&word.as_str())))
        .map(String::from)
        .collect()
}

#[test]
fn names_are_told_from_prose() {
    let text = "// told\nlet a_tell = \"told \\\" told\"; fn BesideIt(c: '\"', d: r#\"told\"#) {}";
    assert_eq!(private(text), ["a_tell", "BesideIt"]);
}

#[test]
fn names_are_words_of_the_field() {
    let mut found = vec![];
    for path in files("src", &["rs"]) {
        let names = private(&text(&path));
        found.extend(names.into_iter().map(|name| format!("{}: `{name}`", path.display())));
    }
    assert!(found.is_empty(), "see docs/terms.md for the terms:\n{}", found.join("\n"));
}
