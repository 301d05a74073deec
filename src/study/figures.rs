//! A study as one page: error over epochs, box plot, error against noise.

use super::result::{Quartiles, StudyResult};
use crate::report::{Figure, Page, Role, Scale};

/// Colours of the starts, in turn.
const ROLES: [Role; 5] = [Role::Measured, Role::Before, Role::After, Role::Floor, Role::Law];

/// The report of a study: one self-contained HTML page.
#[derive(Debug, Clone, Copy)]
pub struct StudyReport<'a> {
    of: &'a StudyResult,
    running: bool,
}

/// Seconds after which the page of a study that goes on loads itself again.
const AGAIN: u32 = 15;

fn role(start: usize) -> Role {
    ROLES[start % ROLES.len()]
}

impl<'a> StudyReport<'a> {
    /// The report of a study's results.
    pub fn of(of: &'a StudyResult) -> Self {
        Self { of, running: false }
    }

    /// The same of a study that goes on: the page loads itself again.
    #[must_use]
    pub fn running(mut self) -> Self {
        self.running = true;
        self
    }

    /// The page.
    pub fn html(&self) -> String {
        let (mut page, frame) = (Page::default(), &self.of.frame);
        page.element("p", "kicker", "Monte Carlo study");
        let (starts, seeds) = (frame.starts.len(), frame.seeds);
        page.element("h1", "", &format!("{starts} starts, {seeds} seeds each"));
        if self.running {
            let (done, of) = (self.of.done.len(), starts as u64 * seeds);
            page.element("p", "gain", &format!("{done} of {of} trainings are done."));
        }
        self.courses(&mut page);
        self.boxes(&mut page);
        self.noise(&mut page);
        self.table(&mut page);
        let page = page.titled("Monte Carlo study");
        if self.running { page.again(AGAIN).html() } else { page.html() }
    }

    fn unit(&self) -> String {
        let unit = self.of.frame.outputs.first().map_or("", |(_, unit)| unit);
        if unit.is_empty() { String::new() } else { format!(" [{unit}]") }
    }

    fn courses(&self, page: &mut Page) {
        for (i, length) in self.of.frame.lengths.iter().enumerate() {
            page.heading(&format!("{length}-step RMSE on the validation records"));
            let label = format!("{length}-step RMSE{}", self.unit());
            let mut figure = Figure::new("epoch", &label).scales(Scale::Linear, Scale::Log);
            for (number, start) in self.of.frame.starts.iter().enumerate() {
                let course = thinned(self.of.course(number, i));
                let at = |e: &usize| *e as f64;
                let band = course.iter().map(|(e, q)| (at(e), q.least, q.greatest)).collect();
                let line = course.iter().map(|(e, q)| (at(e), q.median)).collect();
                figure = figure.band(role(number), "", band).line(role(number), start, line);
            }
            page.figure(figure);
            page.element(
                "p",
                "note",
                "Median over seeds; the band reaches from the least to the greatest.",
            );
        }
    }

    fn boxes(&self, page: &mut Page) {
        for (o, (name, _)) in self.of.frame.outputs.iter().enumerate() {
            page.heading(&format!("Simulation RMSE of {name} on the test record"));
            let mut figure =
                Figure::new("start", &format!("RMSE{}", self.unit())).named(&self.of.frame.starts);
            for (number, start) in self.of.frame.starts.iter().enumerate() {
                let values = |d: &super::Done| d.test.get(o).copied().flatten();
                let all: Vec<f64> = self.of.of_start(number).filter_map(values).collect();
                let Some(q) = Quartiles::of(all.clone()) else { continue };
                let (x, half) = (number as f64 + 1.0, 0.28);
                let across = |y: f64, half: f64| vec![(x - half, y), (x + half, y)];
                figure = figure
                    .band(
                        role(number),
                        "",
                        vec![(x - half, q.first, q.third), (x + half, q.first, q.third)],
                    )
                    .line(role(number), start, across(q.median, half))
                    .line(role(number), "", across(q.least, 0.5 * half))
                    .line(role(number), "", across(q.greatest, 0.5 * half))
                    .line(role(number), "", vec![(x, q.least), (x, q.first)])
                    .line(role(number), "", vec![(x, q.third), (x, q.greatest)])
                    .dots(role(number), "", all.iter().map(|&y| (x, y, 0.0)).collect());
            }
            page.figure(figure);
            page.element(
                "p",
                "note",
                "Box: quartiles and median; whiskers: least and greatest; a dot a seed.",
            );
        }
    }

    fn noise(&self, page: &mut Page) {
        if self.of.noise.is_empty() {
            return;
        }
        page.heading("Encoder error against noise");
        let mut figure = Figure::new("signal to noise [dB]", "state error / standard deviation")
            .scales(Scale::Linear, Scale::Log);
        for (number, start) in self.of.frame.starts.iter().enumerate() {
            let own = self.of.noise.iter().filter(|level| level.start == number);
            let points: Vec<(f64, Quartiles)> = own
                .filter_map(|level| Some((level.snr_db, Quartiles::of(level.errors.clone())?)))
                .collect();
            let band = points.iter().map(|(x, q)| (*x, q.least, q.greatest)).collect();
            let line = points.iter().map(|(x, q)| (*x, q.median)).collect();
            figure = figure.band(role(number), "", band).line(role(number), start, line);
        }
        page.figure(figure);
        page.element(
            "p",
            "note",
            "Untrained encoders on the baseline's own outputs with white noise.",
        );
    }

    fn table(&self, page: &mut Page) {
        page.heading("Figures");
        let mut header = vec!["start".to_string(), "#runs".into(), "#diverged".into()];
        for (name, _) in &self.of.frame.outputs {
            header.push(format!("#{name}: test RMSE, median{}", self.unit()));
            header.push("#least".into());
            header.push("#greatest".into());
        }
        for length in &self.of.frame.lengths {
            header.push(format!("#{length} steps, before"));
            header.push(format!("#{length} steps, after"));
        }
        let number = |value: Option<f64>| value.map_or_else(String::new, |v| format!("{v:.5}"));
        let row = |summary: super::Summary| {
            let mut row =
                vec![summary.start, summary.runs.to_string(), summary.diverged.to_string()];
            for q in &summary.test {
                row.extend(
                    [q.map(|q| q.median), q.map(|q| q.least), q.map(|q| q.greatest)].map(number),
                );
            }
            for (before, after) in summary.ahead_before.iter().zip(&summary.ahead_after) {
                row.extend([before.map(|q| q.median), after.map(|q| q.median)].map(number));
            }
            row
        };
        let rows: Vec<Vec<String>> = self.of.summaries().into_iter().map(row).collect();
        page.table(&header.iter().map(|h| &h[..]).collect::<Vec<_>>(), &rows);
    }
}

/// Some hundred points of a long course, the first and the last among them.
fn thinned(course: Vec<(usize, Quartiles)>) -> Vec<(usize, Quartiles)> {
    let every = course.len().div_ceil(400).max(1);
    let last = course.len().saturating_sub(1);
    let kept = course.into_iter().enumerate();
    kept.filter(|(i, _)| i % every == 0 || *i == last).map(|(_, point)| point).collect()
}
