//! The missing force of every channel: in words, and as a page of pictures.

use std::path::Path;

use super::figure::{Figure, Role};
use super::overlay::with_unit as named;
use super::page::{Cell, Page, share};
use crate::diagnose::Finding;
use crate::digits::number;
use crate::likelihood::MissingForce;

/// Points of a drawn band at most.
const STRETCHES: usize = 900;
/// Dots of a cloud at most.
const DOTS: usize = 1500;
/// Coordinates that are drawn for each channel, and that are told in words.
const DRAWN: usize = 3;
const REPORTED: usize = 4;

/// The section of a diagnosis: what has to be added at each channel for the model to follow the record.
pub(super) fn section(page: &mut Page, finding: &Finding) {
    if finding.missing.is_empty() {
        return;
    }
    page.heading("Missing force");
    let mut rows: Vec<Vec<Cell>> = vec![];
    for force in &finding.missing {
        let rms = with_unit(force.rms, &force.unit);
        let by = force.explained_by.first();
        rows.push(vec![
            force.channel.as_str().into(),
            rms.into(),
            by.map_or("", |by| &by.coordinate[..]).into(),
            by.map_or_else(|| "".into(), |by| share(by.share)),
        ]);
    }
    page.table(&["channel", "#RMS", "best explained by", "share"], &rows);
    page.element(
        "p",
        "note",
        "Estimated without a law. The share is that of its mean square that a free curve of the \
         coordinate explains.",
    );
}

/// What `lacuna look` shows: the missing force of every channel.
///
/// # Example
///
/// ```no_run
/// # fn show(missing: &[lacuna::likelihood::MissingForce]) -> std::io::Result<()> {
/// lacuna::report::MissingReport::of(missing, 0.01).write("look.html".as_ref())
/// # }
/// ```
#[derive(Debug, Clone, Copy)]
pub struct MissingReport<'a> {
    missing: &'a [MissingForce],
    sampling_time: f64,
}

impl<'a> MissingReport<'a> {
    /// The report of some channels; the sampling time in s.
    pub fn of(missing: &'a [MissingForce], sampling_time: f64) -> Self {
        Self { missing, sampling_time }
    }

    /// A line per channel.
    pub fn lines(&self) -> Vec<String> {
        self.missing.iter().map(line).collect()
    }

    /// The page, self-contained.
    pub fn html(&self, title: &str) -> String {
        let mut page = Page::default();
        page.element(
            "p",
            "kicker",
            "What the model does not account for, as a force on each channel",
        );
        page.element("h1", "", title);
        page.element(
            "p",
            "note",
            "Smoothed with no law assumed: a random walk enters one channel at a time. A share is how \
             much of the force a curve of that coordinate explains on data not used to draw the curve. \
             A smoother blurs steps where the noise is large: this is a picture, not a finding.",
        );
        let rows: Vec<Vec<Cell>> = self
            .missing
            .iter()
            .map(|force| {
                let first = force.explained_by.first();
                vec![
                    force.channel.as_str().into(),
                    with_unit(force.rms, &force.unit).into(),
                    first.map_or("".into(), |e| e.coordinate.as_str().into()),
                    first.map_or("".into(), |e| share(e.share)),
                ]
            })
            .collect();
        page.table(&["channel", "#rms", "best explained by", "share"], &rows);
        for force in self.missing {
            self.channel(&mut page, force);
        }
        page.titled(title).html()
    }

    /// Writes the page.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn write(&self, path: &Path) -> std::io::Result<()> {
        std::fs::write(path, self.html("Missing force"))
    }

    fn channel(&self, page: &mut Page, force: &MissingForce) {
        page.heading(&force.channel);
        page.element("p", "", &line(force));
        let y = named("missing force", &force.unit);
        let time = |k: usize| k as f64 * self.sampling_time;
        let values: Vec<(f64, f64)> =
            force.values.iter().enumerate().map(|(k, v)| (time(k), *v)).collect();
        let step = (values.len() / STRETCHES).max(1);
        let band = (0..values.len())
            .step_by(step)
            .map(|k| {
                let (v, two) = (force.values[k], 2.0 * force.band[k]);
                (time(k), v - two, v + two)
            })
            .collect();
        let figure = Figure::new("time [s]", &y)
            .titled(&format!("Missing force on {} over time", force.channel))
            .linked("time")
            .band(Role::After, "95 %", band)
            .line(Role::After, "smoothed", values);
        page.figure(figure);
        for explained in force.explained_by.iter().take(DRAWN) {
            let x = named(&explained.coordinate, &explained.unit);
            let step = (force.values.len() / DOTS).max(1);
            let cloud = (0..force.values.len())
                .step_by(step)
                .filter(|&k| explained.values[k].is_finite() && force.values[k].is_finite())
                .map(|k| (explained.values[k], force.values[k], 0.0))
                .collect();
            let label = format!("share {:.0} %", 100.0 * explained.share);
            let title =
                format!("Missing force on {} against {}", force.channel, explained.coordinate);
            let figure = Figure::new(&x, &y)
                .titled(&title)
                .dots(Role::Measured, "samples", cloud)
                .line(Role::Law, &label, explained.curve.clone());
            page.figure(figure);
        }
    }
}

fn with_unit(value: f64, unit: &str) -> String {
    let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    format!("{}{unit}", number(value, None))
}

/// A channel in words.
fn line(force: &MissingForce) -> String {
    let channel = &force.channel;
    if !force.is_seen() {
        return format!("{channel}: no missing force is seen.");
    }
    let shares: Vec<String> = force
        .explained_by
        .iter()
        .take(REPORTED)
        .map(|e| format!("{} {:.0} %", e.coordinate, 100.0 * e.share))
        .collect();
    let by = match shares.is_empty() {
        true => "no coordinate moves enough to explain it".into(),
        false => format!("explained by {}", shares.join(", ")),
    };
    let alike = match force.alike.is_empty() {
        true => String::new(),
        false => format!("; a force on {} explains the record as well", force.alike.join(", ")),
    };
    format!("{channel}: {} rms, {by}{alike}.", with_unit(force.rms, &force.unit))
}
