//! How a refusal looks: the same as text and as JSON.

use std::path::Path;

use serde_json::Value;

use super::run;

/// What is said about a fault. A place that does not apply is 0 or empty.
#[derive(Debug, Clone, Copy)]
pub struct At<'a> {
    pub file: &'a str,
    pub line: usize,
    pub column: usize,
    pub key: &'a str,
}

/// A call that is refused: kind, place, words of its message. Returns message and hint.
#[track_caller]
pub fn refused(folder: &Path, line: &str, kind: &str, at: At<'_>, words: &[&str]) -> String {
    let status = if kind == "work" { 1 } else { 2 };
    let ran = run(folder, &format!("{line} --json")).exits(status);
    assert_eq!(ran.err, "", "{line}: words beside the JSON document");
    let error = ran.json()["error"].clone();
    let number = |n: usize| if n == 0 { Value::Null } else { n.into() };
    let name = |s: &str| if s.is_empty() { Value::Null } else { s.into() };
    assert_eq!(error["kind"], kind, "{line}: {error}");
    assert_eq!(error["file"], name(at.file), "{line}: {error}");
    assert_eq!(error["line"], number(at.line), "{line}: {error}");
    assert_eq!(error["column"], number(at.column), "{line}: {error}");
    assert_eq!(error["key"], name(at.key), "{line}: {error}");
    let message = error["message"].as_str().unwrap();
    let all = format!("{message} {}", error["hint"].as_str().unwrap_or_default());
    for word in words {
        assert!(all.contains(word), "{line}: no `{word}` in: {all}");
    }
    // a person reads the same
    let ran = run(folder, line).exits(status);
    assert_eq!(ran.out, "", "{line}: an error on stdout");
    assert!(ran.err.starts_with("error: "), "{line}: {}", ran.err);
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words(&ran.err).contains(&words(message)), "{line}: {}\n{message}", ran.err);
    for (what, n) in [("line", at.line), ("column", at.column)] {
        assert!(n == 0 || message.contains(&format!("{what} {n}")), "{line}: {message}");
    }
    assert!(message.contains(at.file) && message.contains(at.key), "{line}: {message}");
    assert!(!ran.err.contains("\u{1b}["), "{line}: colour without a terminal");
    all
}

#[test]
fn a_setting_is_found_in_the_file_that_sets_it() {
    let folder = super::scratch("setting_place");
    std::fs::write(folder.join("m.toml"), super::MODEL).unwrap();
    let generate = |rms: f64, into: &str| {
        let text = format!(
            "model = \"m.toml\"\nsamples = {{ est = 50, test = 30 }}\nsnr_db = 30.0\n\
             [excitation.filtered_noise]\ncutoff = 2.0\norder = 2\nrms = {rms:?}\n\
             [[hidden]]\ninto = \"{into}\"\nof = \"v\"\neffect.cubic = {{ coefficient = -4.0 }}\n"
        );
        std::fs::write(folder.join("g.toml"), text).unwrap();
    };
    let at = |line, column, key| At { file: "g.toml", line, column, key };
    generate(0.0, "force");
    let place = at(7, 7, "excitation.filtered_noise.rms");
    refused(&folder, "generate --config g.toml --out out", "input", place, &["positive"]);
    generate(1.0, "nowhere");
    let place = at(9, 8, "hidden[0].into");
    refused(&folder, "generate --config g.toml --out out", "input", place, &["nowhere", "force"]);
}

#[test]
fn a_size_that_no_memory_holds_is_found_in_the_file_that_asks_for_it() {
    let folder = super::scratch("setting_size");
    std::fs::write(folder.join("m.toml"), super::MODEL).unwrap();
    super::record(&folder, "d.csv", "m.toml", 300, 0.01);
    super::record(&folder, "v.csv", "m.toml", 200, 0.02);
    let fit = |key: &str, value: &str| {
        let text = "[structure]\nhidden = [4]\n[encoder.resnet]\nn_a = 3\nn_b = 3\nhidden = [4]\n\
                    [initialiser.random]\n[training]\nlength = 20\nepochs = 1\n";
        assert!(text.contains(key));
        std::fs::write(folder.join("f.toml"), text.replace(key, value)).unwrap();
    };
    let call = "fit --model m.toml --data d.csv --validate v.csv --config f.toml --out out";
    let at = |line, column, key| At { file: "f.toml", line, column, key };
    fit("[structure]\nhidden = [4]", "[structure]\nhidden = [9223372036854775807]");
    refused(&folder, call, "input", at(2, 10, "structure.hidden"), &["weights"]);
    fit("n_b = 3\nhidden = [4]", "n_b = 3\nhidden = [4294967296, 4294967296]");
    refused(&folder, call, "input", at(3, 2, "encoder"), &["weights"]);
    fit("n_b = 3", "n_b = 4294967296");
    refused(&folder, call, "input", at(3, 2, "encoder"), &["4294967296"]);
    fit("length = 20", "length = 0");
    refused(&folder, call, "input", at(9, 10, "training.length"), &["0"]);
    std::fs::write(
        folder.join("g.toml"),
        "model = \"m.toml\"\nsamples = { est = 9223372036854775807, test = 30 }\nsnr_db = 30.0\n\
         [excitation.filtered_noise]\ncutoff = 2.0\norder = 2\nrms = 1.0\n",
    )
    .unwrap();
    let place = At { file: "g.toml", line: 2, column: 19, key: "samples.est" };
    refused(&folder, "generate --config g.toml --out out", "input", place, &["100000000"]);
}
