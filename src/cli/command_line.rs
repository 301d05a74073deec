//! The command line of a call, as it can be repeated.
//!
//! Uses no other file, for its test is compiled into `tests/program.rs`: a test binary of this crate would
//! compile every command a second time.

/// Options that change no result, and whether a value follows them.
const WITHOUT_EFFECT: [(&str, bool); 7] = [
    ("--threads", true),
    ("--out", true),
    ("--json", false),
    ("--quiet", false),
    ("--verbose", false),
    ("-v", false),
    ("--open", false),
];

/// The command as it can be repeated, without options that change no result.
pub fn command(words: impl Iterator<Item = String>) -> String {
    let mut kept = vec!["lacuna".to_string()];
    let mut skip = false;
    for word in words {
        if std::mem::take(&mut skip) {
            continue;
        }
        let (name, has_value) = match word.split_once('=') {
            Some((name, _)) => (name, true),
            None => (word.as_str(), false),
        };
        match WITHOUT_EFFECT.iter().find(|(known, _)| *known == name) {
            Some((_, takes)) => skip = *takes && !has_value,
            None => kept.push(quoted(&word)),
        }
    }
    kept.join(" ")
}

/// A word as a shell takes it.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./=,:+@%".contains(c);
    match !word.is_empty() && word.chars().all(plain) {
        true => word.into(),
        false => format!("'{}'", word.replace('\'', "'\\''")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_is_kept_without_what_changes_no_result() {
        let of = |line: &str| command(line.split(' ').map(String::from));
        let kept = "lacuna diagnose --model m.toml --data d.csv";
        assert_eq!(of("diagnose --model m.toml --data d.csv --threads 4 --out a -v --json"), kept);
        assert_eq!(of("diagnose --threads=4 --model m.toml --data d.csv --out=a"), kept);
        assert_eq!(
            command(["--data".into(), "a b.csv".into()].into_iter()),
            "lacuna --data 'a b.csv'"
        );
    }
}
