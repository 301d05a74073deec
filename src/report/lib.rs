//! Turns results into one HTML file that needs nothing else.

use lacuna_core::{data, digits, effect, evaluate, file, look, model, register, system};
use lacuna_diagnose as diagnose;
use lacuna_estimate as estimate;
use lacuna_fourier as fourier;
use lacuna_learn::train;
use lacuna_likelihood as likelihood;

mod analysis;
mod apart;
mod axis;
mod cause;
mod chart;
mod column;
mod distortion;
#[doc(hidden)]
pub mod documents;
mod escape;
mod figure;
mod html;
mod learned;
mod missing;
mod overlay;
mod page;
mod parameters;
mod provenance;
mod read_back;
pub mod sentences;
mod signals;
mod svg;
mod tables;
mod test_record;
mod thin;
mod training;

use std::path::Path;

use crate::diagnose::{Finding, Gain, Outlook, Verdict};
use crate::digits::number;
use crate::system::System;
pub use missing::MissingReport;
pub use provenance::Provenance;
pub use training::TrainingReport;

// machinery that sibling crates and the program share; it may change at any time
#[doc(hidden)]
pub use self::{
    documents::{Document, FileNames, cause_document},
    figure::{Figure, Role, Scale},
    learned::LearnedCurve,
    page::{Cell, Page, share},
    provenance::FileUsed,
    read_back::ReadBack,
    training::Compared,
};

/// The report of a diagnosis: one self-contained HTML page.
///
/// ```no_run
/// # fn show(finding: &lacuna::diagnose::Finding) -> std::io::Result<()> {
/// lacuna::report::Report::of(finding).titled("press").write("report.html".as_ref())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct Report<'a> {
    finding: &'a Finding,
    title: String,
    from: Option<&'a Provenance>,
    system: Option<&'a System>,
    outlook: Option<&'a Outlook>,
}

impl<'a> Report<'a> {
    /// The report of a finding.
    pub fn of(finding: &'a Finding) -> Self {
        let title = "Diagnosis".into();
        Self { finding, title, from: None, system: None, outlook: None }
    }

    /// The same with where it is from: program, command, files, seed, date.
    #[must_use]
    pub fn from(mut self, provenance: &'a Provenance) -> Self {
        self.from = Some(provenance);
        self
    }

    /// The same with a title: what was diagnosed.
    #[must_use]
    pub fn titled(mut self, title: &str) -> Self {
        self.title = title.into();
        self
    }

    /// The same with the model that was handed in, for a table of its parameters before and after.
    #[must_use]
    pub fn model(mut self, system: &'a System) -> Self {
        self.system = Some(system);
        self
    }

    /// The same with the experiments that would tell look-alikes apart.
    #[must_use]
    pub fn outlook(mut self, outlook: &'a Outlook) -> Self {
        self.outlook = Some(outlook);
        self
    }

    /// Writes the page to a file.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn write(&self, path: &Path) -> std::io::Result<()> {
        crate::file::write_text(path, &self.html())
    }

    /// What the model lacks at a cause's place, against the coordinate, as an SVG file's text;
    /// `None` where there is no such cause, or no curve of it.
    pub fn picture(&self, cause: usize) -> Option<String> {
        let curve = self.finding.series.curves.iter().find(|c| c.cause == cause)?;
        Some(cause::figure(curve).file())
    }

    /// The page.
    pub fn html(&self) -> String {
        self.page().html()
    }

    /// The page as plain data: texts, tables and figures.
    pub fn page(&self) -> Page {
        let finding = self.finding;
        let mut page = Page::default();
        page.element("p", "kicker", &self.title);
        if finding.interrupted {
            page.element("p", "note", sentences::INTERRUPTED);
        }
        self.headline(&mut page);
        for index in 0..finding.causes.len() {
            cause::section(&mut page, finding, index);
        }
        cause::unexplained(&mut page, finding);
        cause::single_records(&mut page, finding);
        apart::section(&mut page, finding, self.outlook);
        missing::section(&mut page, finding);
        signals::sections(&mut page, &finding.series, finding);
        test_record::section(&mut page, finding);
        distortion::section(&mut page, finding);
        if let Some(system) = self.system {
            parameters::section(&mut page, finding, system);
        }
        tables::sections(&mut page, finding);
        self.origin(&mut page);
        page.element("footer", "", FOOTER);
        page.titled(&format!("{} - lacuna", self.title))
    }

    /// What was recorded, and where the page is from.
    fn origin(&self, page: &mut Page) {
        page.heading("Where this is from");
        page.element("p", "", &sentences::record(&self.finding.record));
        for line in self.from.map(Provenance::lines).unwrap_or_default() {
            page.element("p", "note", &line);
        }
    }

    fn headline(&self, page: &mut Page) {
        let finding = self.finding;
        let many = finding.causes.len() > 1;
        if many {
            let what = match finding.verdict {
                Verdict::DataFault => "The data are at fault, in more than one way.".into(),
                _ => format!("{} causes explain what the model gets wrong.", finding.causes.len()),
            };
            page.element("h1", "", &what);
            for cause in &finding.causes {
                page.element("p", "gain", &sentences::cause(cause));
            }
        } else {
            page.element("h1", "", &sentences::headline(finding));
        }
        if finding.causes.is_empty() {
            let note = match finding.verdict {
                Verdict::Unexplained => {
                    "The pictures below show where the simulation is off; the ranking shows what \
                     came nearest. A record with another level, offset or sensor may tell more."
                }
                _ => {
                    "The list at the end says what was looked for, and how large it would have to be \
                     to be seen in this record."
                }
            };
            page.element("p", "note", note);
            return;
        }
        for (name, before) in &finding.before.test {
            let Some(after) = finding.after.test.get(name) else { continue };
            let unit =
                finding.series.outputs.iter().find(|(n, _)| n == name).map_or("", |(_, u)| u);
            let fit = sentences::fit(&[before, after]).replace("->", "\u{2192}");
            page.element(
                "p",
                "gain",
                &format!(
                    "{name}, on data not used before: RMSE {} \u{2192} {} {unit} ({fit}).",
                    number(before.rmse, None),
                    number(after.rmse, None),
                ),
            );
        }
        match &finding.ahead {
            Some(found) => {
                for sentence in sentences::ahead(finding, found) {
                    page.element("p", "note", &sentence);
                }
            }
            None => shares_of_gain(page, &finding.gain),
        }
        if let Some(promise) = finding.false_discovery.as_ref().filter(|f| f.confirmed > 0) {
            page.element("p", "note", &format!(
                "Tested on data that neither fitted nor chose it: {} of {} causes in the machine confirmed, \
                 false discovery rate at most {}.",
                promise.confirmed, promise.confirmed + promise.not_confirmed.len(),
                match promise.rate {
                    rate if rate < LEAST_RATE => "one in a million".into(),
                    rate => number(rate, None),
                },
            ));
        }
    }
}

/// No test on a record makes a cause more certain than this: its assumptions are less so.
const LEAST_RATE: f64 = 1e-6;

const FOOTER: &str = "Read from top to bottom: what was found, how it shows, what else was \
considered, what is left. A value \"a \u{b1} b\" has b as two standard errors. \"Removable\" is the mean \
square error above the noise floor. A look-alike would remove nearly as much: the record cannot tell \
it from the cause named; a runner-up would remove clearly less.";

/// What the extended model removes of the error of a simulation.
fn shares_of_gain(page: &mut Page, gain: &Gain) {
    let [low, high] = sentences::shares(gain.interval95);
    page.element("p", "note", &format!(
        "{:.1} % of the mean square error above the noise floor is gone (95 % interval {low} to {high} %); \
         RMSE over all outputs times {}.",
        100.0 * gain.error_removed, number(gain.test_rmse_ratio, None),
    ));
}
