//! The page of results: one JSON file for a claim, written by the command that measured it, and
//! one Markdown page made of all of them.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{fs, io};

use serde::Deserialize;

/// One claim and what was measured about it.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Claim {
    /// The claim, in one sentence.
    pub claim: String,
    /// Under which heading it stands.
    pub group: String,
    /// Commands that measure it.
    pub command: Vec<String>,
    /// The day, as 2026-11-25.
    pub date: String,
    /// The commit whose code was measured.
    pub commit: String,
    /// Seeds, in words.
    pub seeds: String,
    /// What was wanted.
    pub bar: String,
    /// What came out.
    pub figure: String,
    /// Whether that meets the bar; none where there is none, or it is met in part.
    pub passed: Option<bool>,
    /// Which method, where there were several.
    #[serde(default)]
    pub method: String,
    /// All figures.
    pub tables: Vec<Table>,
    /// What failed.
    #[serde(default)]
    pub missed: String,
    /// Conditions.
    #[serde(default)]
    pub notes: String,
}

/// Figures in rows.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// What it shows, where the claim does not say it.
    pub title: String,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Rows, each with an entry for every column.
    pub rows: Vec<Vec<String>>,
}

/// The headings, in order.
const GROUPS: [&str; 5] = ["Diagnosis", "Estimation", "Training", "Trust", "People"];

/// The claims of a folder, by name of their files.
///
/// # Errors
///
/// A file that cannot be read or is no claim, a heading that does not exist, a row that is too
/// short.
pub fn claims(folder: &Path) -> io::Result<Vec<(String, Claim)>> {
    let mut paths: Vec<PathBuf> =
        fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<io::Result<_>>()?;
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "json"));
    paths.sort();
    let wrong = |path: &Path, why: String| {
        io::Error::new(io::ErrorKind::InvalidData, format!("{}: {why}", path.display()))
    };
    let mut found = vec![];
    for path in paths {
        let text = fs::read_to_string(&path)?;
        // other documents may stand here; a claim says what it claims
        if !text.contains("\"claim\"") {
            continue;
        }
        let claim: Claim =
            serde_json::from_str(&text).map_err(|error| wrong(&path, error.to_string()))?;
        if !GROUPS.contains(&claim.group.as_str()) {
            return Err(wrong(&path, format!("group {:?} is none of {GROUPS:?}", claim.group)));
        }
        for table in &claim.tables {
            if let Some(row) = table.rows.iter().find(|row| row.len() != table.columns.len()) {
                return Err(wrong(&path, format!("a row of another length: {row:?}")));
            }
        }
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        found.push((name, claim));
    }
    Ok(found)
}

fn row(page: &mut String, cells: &[String]) {
    let _ = writeln!(page, "| {} |", cells.join(" | "));
}

/// The page.
pub fn page(claims: &[(String, Claim)]) -> String {
    let mut page = String::from(
        "# What was measured\n\n\
         Made from the files beside it by `cargo run --example results_page`; each is written by the command\n\
         that measured it. Times are of a shared machine with two cores and differ from hour to hour: read\n\
         ratios. How a figure came about over the first eighteen decisions stands in\n\
         [decisions/log.md](decisions/log.md); defects and what became of them in\n\
         [results/defects.md](results/defects.md).\n\n",
    );
    let titles = ["claim", "wanted", "measured", "passed", "date", "commit"];
    row(&mut page, &titles.map(String::from));
    row(&mut page, &titles.map(|_| "---".into()));
    for group in GROUPS {
        for (name, claim) in claims.iter().filter(|(_, claim)| claim.group == group) {
            let passed = match claim.passed {
                Some(true) => "yes",
                Some(false) => "**no**",
                None => "in part, or no bar",
            };
            let cells = [
                &format!("[{}](#{name})", claim.claim),
                &claim.bar,
                &claim.figure,
                passed,
                &claim.date,
                &claim.commit,
            ];
            row(&mut page, &cells.map(String::from));
        }
    }
    for group in GROUPS {
        if claims.iter().any(|(_, claim)| claim.group == group) {
            let _ = writeln!(page, "\n## {group}");
        }
        for (name, claim) in claims.iter().filter(|(_, claim)| claim.group == group) {
            let _ = writeln!(page, "\n### <a id=\"{name}\"></a>{}\n", claim.claim);
            let commands: String =
                claim.command.iter().map(|command| format!("$ {command}\n")).collect();
            let _ = writeln!(page, "```console\n{commands}```\n");
            let method = match claim.method.as_str() {
                "" => String::new(),
                method => format!("; method: {method}"),
            };
            let (date, commit, seeds) = (&claim.date, &claim.commit, &claim.seeds);
            let _ = writeln!(page, "{date}, commit {commit}, seeds {seeds}{method}.");
            for (lead, text) in [("", &claim.notes), ("**Missed**: ", &claim.missed)] {
                if !text.is_empty() {
                    let _ = writeln!(page, "{lead}{text}");
                }
            }
            for table in &claim.tables {
                let title = match table.title.as_str() {
                    "" => String::new(),
                    title => format!("{title}:\n\n"),
                };
                let _ = write!(page, "\n{title}");
                row(&mut page, &table.columns);
                row(&mut page, &vec!["---".to_string(); table.columns.len()]);
                table.rows.iter().for_each(|cells| row(&mut page, cells));
            }
        }
    }
    page
}
