//! Names of functions and variables in exported text.

/// Words that a function cannot be called in one of the languages.
const TAKEN: [&str; 24] = [
    "auto", "break", "case", "class", "const", "def", "double", "else", "end", "enum", "float",
    "for", "function", "if", "int", "long", "main", "return", "short", "static", "struct",
    "switch", "void", "while",
];

/// Whether functions and files may be called so.
pub fn is_usable(name: &str) -> bool {
    name.len() <= 60
        && name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        && !TAKEN.contains(&name)
}

/// A name as part of an identifier.
pub fn identifier(name: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    name.chars().map(plain).collect()
}

/// Identifiers of several names, each once.
pub fn identifiers<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut all: Vec<String> = vec![];
    for name in names {
        let wanted = identifier(name);
        let mut made = wanted.clone();
        let mut number = 1;
        while all.contains(&made) {
            number += 1;
            made = format!("{wanted}_{number}");
        }
        all.push(made);
    }
    all
}

/// Text that ends no comment and stays on its line.
pub fn remark(text: &str) -> String {
    let kept: String = text.chars().filter(|c| !c.is_control()).collect();
    kept.replace("*/", "* /")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_identifier_is_there_once() {
        let made = identifiers(["a.b", "a b", "x"].into_iter());
        assert_eq!(made, ["a_b", "a_b_2", "x"]);
    }

    #[test]
    fn words_of_the_languages_are_refused() {
        assert!(is_usable("press_2"));
        for bad in ["", "2nd", "for", "a-b", "ä"] {
            assert!(!is_usable(bad), "{bad}");
        }
    }
}
