//! The book: every console block runs and prints what it shows, every chapter is there, every link
//! leads somewhere.

use super::*;

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs")
}

/// Blocks of code of a page: what stands behind the fence, and the lines.
fn blocks(text: &str) -> Vec<(&str, Vec<&str>)> {
    let (mut found, mut open) = (vec![], None::<(&str, Vec<&str>)>);
    for line in text.lines() {
        match (line.strip_prefix("```"), open.take()) {
            (Some(info), None) => open = Some((info, vec![])),
            (Some(_), Some(block)) => found.push(block),
            (None, Some((info, mut lines))) => {
                lines.push(line);
                open = Some((info, lines));
            }
            (None, None) => {}
        }
    }
    found
}

/// A word without the punctuation around it.
fn bare(word: &str) -> &str {
    word.trim_matches(|c: char| ",;:()".contains(c))
}

/// Whether a line begins as it is shown; numbers may differ by a third, so that a page need not be
/// written anew whenever an estimate moves within its error.
fn begins(line: &str, shown: &str) -> bool {
    let mut words = line.split_whitespace();
    shown.split_whitespace().all(|wanted| {
        let Some(word) = words.next() else { return false };
        match (bare(word).parse::<f64>(), bare(wanted).parse::<f64>()) {
            (Ok(a), Ok(b)) => (a - b).abs() <= a.abs().max(b.abs()) / 3.0,
            _ => bare(word) == bare(wanted),
        }
    })
}

/// Runs the lines of a console block in a folder; what each one prints has to hold the lines shown
/// below it, in their order.
fn run_block(folder: &Path, page: &str, lines: &[&str]) {
    let program = Path::new(env!("CARGO_BIN_EXE_lacuna")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap_or_default());
    let mut at = 0;
    while at < lines.len() {
        let call = lines[at].strip_prefix("$ ").unwrap_or_else(|| panic!("{page}: {}", lines[at]));
        let shown: Vec<&str> =
            lines[at + 1..].iter().copied().take_while(|l| !l.starts_with("$ ")).collect();
        at += 1 + shown.len();
        let output = Command::new("sh")
            .current_dir(folder)
            .args(["-c", &format!("{{ {call}\n}} 2>&1")])
            .env("PATH", &path)
            .stdin(Stdio::null())
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success(), "{page}: $ {call}\n{text}");
        let mut printed = text.lines();
        for line in shown {
            assert!(
                printed.by_ref().any(|own| begins(own, line)),
                "{page}: $ {call}\ndoes not print the line\n{line}\nbut\n{text}"
            );
        }
    }
}

/// Follows a page from its first block to its last, in a folder of its own.
fn follow(page: &str) {
    let folder = scratch(&format!("book-{page}"));
    let text = std::fs::read_to_string(docs().join("book").join(format!("{page}.md"))).unwrap();
    let mut ran = 0;
    for (info, lines) in blocks(&text) {
        match info {
            "toml" => {
                let name = lines[0].strip_prefix("# ").filter(|name| name.ends_with(".toml"));
                let name = name.unwrap_or_else(|| panic!("{page}: {} names no file", lines[0]));
                std::fs::write(folder.join(name), lines.join("\n") + "\n").unwrap();
            }
            "console" => {
                run_block(&folder, page, &lines);
                ran += 1;
            }
            _ => {}
        }
    }
    assert!(ran > 0, "{page} has no console block");
}

#[test]
fn the_first_cause() {
    follow("first_cause");
}

#[test]
fn a_machine_of_ones_own() {
    follow("own_machine");
}

#[test]
fn a_report() {
    follow("reading_a_report");
}

#[test]
fn what_is_refused() {
    follow("when_not");
}

#[test]
fn an_experiment() {
    follow("planning");
}

#[test]
fn a_training() {
    follow("learning");
}

/// Targets of all links of a page, without anchors; none in blocks of code.
fn links(text: &str) -> Vec<String> {
    let mut code = false;
    let prose = text.lines().filter(|line| {
        let fence = line.starts_with("```");
        code ^= fence;
        !code && !fence
    });
    let prose = prose.collect::<Vec<_>>().join("\n");
    let ends = prose.match_indices("](").map(|(at, _)| &prose[at + 2..]);
    let targets = ends.filter_map(|rest| Some(rest[..rest.find(')')?].to_string()));
    targets
        .filter(|target| !target.contains("://"))
        .map(|target| target.split('#').next().unwrap_or_default().to_string())
        .filter(|target| !target.is_empty())
        .collect()
}

/// All pages below a folder.
fn pages(folder: &Path) -> Vec<PathBuf> {
    let mut found = vec![];
    for entry in std::fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let path = entry.path();
        if path.is_dir() {
            found.extend(pages(&path));
        } else if path.extension().is_some_and(|ending| ending == "md") {
            found.push(path);
        }
    }
    found
}

/// The pages that are made of the code when the book is built.
fn reference(folder: &Path) -> Vec<PathBuf> {
    run(folder, "man --markdown --out reference").exits(0);
    pages(&folder.join("reference"))
}

#[test]
fn every_chapter_is_there_and_every_link_leads_somewhere() {
    let made: Vec<PathBuf> = reference(&scratch("book-links"))
        .iter()
        .map(|path| docs().join("book/reference").join(path.file_name().unwrap()))
        .collect();
    let there = |path: &Path| path.exists() || made.iter().any(|page| page == path);
    let summary = std::fs::read_to_string(docs().join("SUMMARY.md")).unwrap();
    let chapters: Vec<PathBuf> = links(&summary).iter().map(|link| docs().join(link)).collect();
    for page in pages(&docs().join("book")).iter().chain(&made) {
        assert!(chapters.contains(page), "{} is no chapter of the summary", page.display());
    }
    let root = docs().join("..");
    let more = ["README.md", "CONTRIBUTING.md", "python/README.md"].map(|name| root.join(name));
    let mut dead = vec![];
    for page in pages(&docs()).iter().chain(&more) {
        let text = std::fs::read_to_string(page).unwrap();
        for link in links(&text) {
            // `a/../b` is `b`, also where `a` is only made later
            let mut target = page.parent().unwrap().to_path_buf();
            for part in Path::new(&link).components() {
                match part.as_os_str() == ".." {
                    true => target = target.parent().unwrap().to_path_buf(),
                    false => target.push(part),
                }
            }
            if !there(&target) {
                dead.push(format!("{}: {link}", page.display()));
            }
        }
    }
    assert!(dead.is_empty(), "links that lead nowhere:\n{}", dead.join("\n"));
}

#[test]
fn the_reference_has_every_command_effect_and_field() {
    let folder = scratch("book-reference");
    let pages = reference(&folder);
    assert_eq!(pages.len(), 4);
    let page = |name: &str| std::fs::read_to_string(folder.join("reference").join(name)).unwrap();
    let commands = page("commands.md");
    for command in ["lacuna diagnose", "lacuna exam write", "lacuna study merge", "lacuna man"] {
        assert!(commands.contains(&format!("\n## {command}\n")), "{command}");
    }
    assert!(commands.contains("--max-causes"));
    for (list, name) in [("models", "models.md"), ("effects", "effects.md")] {
        let document = run(&folder, &format!("{list} --json")).exits(0).json();
        let text = page(name);
        for entry in document[list].as_array().unwrap() {
            let name = entry["name"].as_str().unwrap();
            assert!(text.contains(name), "{name}");
        }
    }
    let fields = page("json.md");
    for entry in std::fs::read_dir(docs().join("schema")).unwrap().map(Result::unwrap) {
        let name = entry.path().file_stem().unwrap().to_str().unwrap().to_string();
        assert!(
            fields.contains(&format!("\n## {name}\n")),
            "{name} is missing in src/cli/reference.rs"
        );
    }
    for field in ["causes[].parameters[].value", "metrics.*.fit_percent", "error.hint"] {
        assert!(fields.contains(&format!("| `{field}` |")), "{field}\n{fields}");
    }
}

#[test]
fn lines_are_compared_as_the_page_says() {
    assert!(begins("y: RMSE 0.101 m, fit 90 %", "y: RMSE 0.100 m,"));
    assert!(!begins("y: RMSE 0.2 m", "y: RMSE 0.1 m"));
    assert!(!begins("x: RMSE 0.1 m", "y: RMSE 0.1 m"));
    assert!(!begins("y: RMSE", "y: RMSE 0.1"));
    assert_eq!(blocks("a\n```console\n$ b\nc\n```\n"), [("console", vec!["$ b", "c"])]);
    assert_eq!(links("[a](b.md#c) and [d](#e)\n```\n[f](g)\n```\n"), ["b.md"]);
}
