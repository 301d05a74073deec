//! The result of an exam as files: JSON, CSV and one page.

use std::fmt::Write as _;
use std::path::Path;

use super::{ExamResult, Kind, Tally};
use crate::StudyError;
use crate::file::write_text;
use crate::job::write;
use crate::report::{Figure, Page, Role, Scale};

/// Colours of the machines, in turn.
const ROLES: [Role; 5] = [Role::Measured, Role::Before, Role::After, Role::Floor, Role::Law];

fn asked(kind: Kind) -> &'static str {
    match kind {
        Kind::Nothing => "nothing",
        Kind::One => "one effect",
        Kind::Missing => "one, not looked for",
        Kind::Outside => "one, in no library",
        Kind::Two => "two effects",
        Kind::Three => "three effects",
    }
}

fn percent(value: Option<f64>) -> String {
    value.map_or_else(String::new, |v| format!("{:.1}", 100.0 * v))
}

const COLUMNS: [&str; 13] = [
    "hidden",
    "#g",
    "conditions",
    "#cases",
    "#first",
    "#named",
    "#exact",
    "#imitated",
    "#spurious",
    "#small sets",
    "#removed",
    "#covered",
    "#gain covered",
];

fn row(tally: &Tally) -> Vec<String> {
    vec![
        asked(tally.kind).into(),
        tally.g.to_string(),
        tally.conditions.to_string(),
        tally.cases.to_string(),
        percent(tally.first),
        percent(tally.named),
        percent(tally.exact),
        percent(tally.imitated),
        percent(Some(tally.spurious)),
        percent(tally.small_sets),
        tally.removed_median.map_or_else(String::new, |v| format!("{:.2}", 100.0 * v)),
        percent(tally.coverage),
        percent(tally.gain_coverage),
    ]
}

impl ExamResult {
    /// The exam as one JSON document.
    pub fn document(&self) -> serde_json::Value {
        serde_json::json!({
            "schema": 1,
            "cases": self.marks.len(),
            "tallies": self.tallies(),
            "systems": self.by_system().into_iter().collect::<std::collections::BTreeMap<_, _>>(),
            "confusion": self.confusion(),
        })
    }

    /// Writes `study.json`, `cases.csv` and `report.html`, which are the same wherever the cases were
    /// worked off, and `seconds.csv`, which is not.
    ///
    /// # Errors
    ///
    /// If a file cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), StudyError> {
        std::fs::create_dir_all(folder).map_err(|error| StudyError::write(folder, error))?;
        let put = |name: &str, text: String| {
            let path = folder.join(name);
            write_text(&path, &text).map_err(|error| StudyError::write(&path, error))
        };
        put("cases.csv", self.csv())?;
        put("seconds.csv", self.seconds())?;
        put("report.html", self.html())?;
        write(&folder.join("study.json"), &self.document())
    }

    fn csv(&self) -> String {
        let mut text = String::from(
            "case,system,hidden,g,samples,records,snr_db,noise,process_noise,input_noise,onset,\
             parameter_error,seed,named,exact,found,set_size,removed,verdict\n",
        );
        for m in &self.marks {
            let (c, exact) = (&m.case, m.hits.iter().all(|h| *h == super::Hit::Exact));
            let at = &c.conditions;
            let removed = m.removed.map_or_else(String::new, |r| r.to_string());
            let _ = writeln!(
                text,
                "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{exact},{},{},{removed},{}",
                c.number,
                m.system,
                m.hidden.join(" + "),
                c.g,
                at.samples,
                at.records,
                at.snr_db,
                at.noise,
                at.process_noise,
                at.input_noise,
                at.onset,
                at.parameter_error,
                c.seed,
                m.all(),
                m.found.join(" + "),
                m.set_size(),
                m.verdict
            );
        }
        text
    }

    /// How long each case took.
    fn seconds(&self) -> String {
        let line = |m: &super::Marks| format!("{},{:.2}\n", m.case.number, m.seconds);
        "case,seconds\n".to_string() + &self.marks.iter().map(line).collect::<String>()
    }

    fn html(&self) -> String {
        let mut page = Page::default();
        page.element("p", "kicker", "Exam of the diagnosis");
        page.element("h1", "", &format!("{} cases", self.marks.len()));
        let rows = |tallies: &[Tally]| tallies.iter().map(row).collect::<Vec<_>>();
        page.table(&COLUMNS, &rows(&self.tallies()));
        page.element(
            "p",
            "note",
            "All in per cent. First: a hidden effect stands in the first cause's set. Named: all stand \
             in the sets of causes; exact: all head one. Imitated: not all were named, but parameters \
             alone took at least 90 % of the error. Spurious: something was named beside what was \
             hidden. Small sets: of three names at most. Removed: median share of the mean square on \
             a third record without noise. Covered: true values inside 95 % intervals.",
        );
        self.power(&mut page);
        page.heading("What single effects were called");
        self.confusions(&mut page);
        page.heading("Machine by machine");
        let mut header = vec!["machine"];
        header.extend(COLUMNS);
        let of_machine = |(name, tallies): (String, Vec<Tally>)| {
            let named = move |tally: &Tally| [vec![name.clone()], row(tally)].concat();
            tallies.iter().map(named).collect::<Vec<_>>()
        };
        let rows: Vec<_> = self.by_system().into_iter().flat_map(of_machine).collect();
        page.table(&header, &rows);
        page.titled("Exam of the diagnosis").html()
    }

    /// Found against size, a line a machine.
    fn power(&self, page: &mut Page) {
        let mut figure = Figure::new("size g of the hidden effect", "share named")
            .scales(Scale::Log, Scale::Linear);
        let mut drawn = false;
        for (number, (name, tallies)) in self.by_system().into_iter().enumerate() {
            let single = tallies.iter().filter(|t| t.kind == Kind::One);
            let mut line: Vec<(f64, f64)> = single.filter_map(|t| Some((t.g, t.named?))).collect();
            line.sort_by(|a, b| a.0.total_cmp(&b.0));
            line.dedup_by_key(|p| p.0);
            drawn |= line.len() > 1;
            figure = figure.line(ROLES[number % ROLES.len()], &name, line);
        }
        if drawn {
            page.heading("Power");
            page.figure(figure);
        }
    }

    fn confusions(&self, page: &mut Page) {
        let table = self.confusion();
        let mut rows = vec![];
        for (hidden, found) in table {
            let all: usize = found.values().sum();
            let right = found.get(&hidden).copied().unwrap_or(0);
            let mut wrong: Vec<(usize, &String)> =
                found.iter().filter(|(name, _)| **name != hidden).map(|(n, &c)| (c, n)).collect();
            wrong.sort_by(|a, b| b.cmp(a));
            let wrong: Vec<String> = wrong.iter().map(|(c, name)| format!("{name} {c}")).collect();
            rows.push(vec![hidden, all.to_string(), right.to_string(), wrong.join(", ")]);
        }
        page.table(&["hidden", "#cases", "#named", "else called"], &rows);
    }
}
