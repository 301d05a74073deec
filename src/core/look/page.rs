//! A look as one page that needs nothing else: signals in time, spectra, coherence.

use super::Look;
use super::spectra::Spectra;
use crate::data::Record;
use std::fmt::Write;

/// Columns of a drawn signal.
const COLUMNS: usize = 700;
const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 130.0;
/// Room for the labels of the axes.
const LEFT: f64 = 72.0;
const BELOW: f64 = 26.0;

/// What is drawn.
#[derive(Debug, Clone, Default)]
pub(super) struct Drawn {
    /// Per signal, least and greatest value of each column of samples.
    bands: Vec<Vec<(f64, f64)>>,
    frequency: Vec<f64>,
    density: Vec<Vec<f64>>,
}

impl Drawn {
    pub fn of(record: &Record, spectra: &Spectra) -> Self {
        let n = record.len();
        let columns = COLUMNS.min(n);
        let band = |values: &[f64]| -> Vec<(f64, f64)> {
            (0..columns)
                .map(|c| {
                    let own = &values[c * n / columns..((c + 1) * n / columns).min(n)];
                    let known = || own.iter().copied().filter(|v| v.is_finite());
                    (
                        known().fold(f64::INFINITY, f64::min),
                        known().fold(f64::NEG_INFINITY, f64::max),
                    )
                })
                .collect()
        };
        let count = record.signals().count();
        let density = if spectra.count == 0 { 0 } else { count };
        Self {
            bands: record.signals().map(|signal| band(&signal.values)).collect(),
            frequency: spectra.frequency.clone(),
            density: (0..density).map(|k| spectra.density(k)).collect(),
        }
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A figure: a title, ends of both axes, and what is within.
fn figure(title: &str, x: (String, String), y: (String, String), inside: &str) -> String {
    let (right, bottom) = (LEFT + WIDTH, HEIGHT + BELOW);
    format!(
        "<figure><figcaption>{title}</figcaption>\
         <svg viewBox=\"0 0 {right} {bottom}\" role=\"img\" aria-label=\"{title}\">\
         <rect class=\"frame\" x=\"{LEFT}\" y=\"1\" width=\"{}\" height=\"{}\"/>{inside}\
         <text x=\"{}\" y=\"12\" text-anchor=\"end\">{}</text>\
         <text x=\"{}\" y=\"{HEIGHT}\" text-anchor=\"end\">{}</text>\
         <text x=\"{LEFT}\" y=\"{}\">{}</text>\
         <text x=\"{right}\" y=\"{}\" text-anchor=\"end\">{}</text></svg></figure>",
        WIDTH - 1.0,
        HEIGHT - 2.0,
        LEFT - 4.0,
        y.1,
        LEFT - 4.0,
        y.0,
        HEIGHT + 18.0,
        x.0,
        HEIGHT + 18.0,
        x.1
    )
}

fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    format!("{rounded}")
}

/// Heights of a figure from values between two ends.
fn height(value: f64, low: f64, high: f64) -> f64 {
    let span = if high > low { high - low } else { 1.0 };
    HEIGHT - 2.0 - (value - low) / span * (HEIGHT - 4.0)
}

impl Look {
    /// The page; `title` is what it is called.
    pub fn page(&self, title: &str) -> String {
        let mut body = String::new();
        for line in self.lines() {
            let deep = if line.starts_with("  ") { " class=\"deep\"" } else { "" };
            let _ = write!(body, "<li{deep}>{}</li>", escaped(line.trim()));
        }
        let mut figures = String::new();
        for (k, signal) in self.signals.iter().enumerate() {
            let unit =
                if signal.unit.is_empty() { String::new() } else { format!(" [{}]", signal.unit) };
            let name = escaped(&format!("{}{unit}", signal.name));
            figures += &self.in_time(k, &name);
            figures += &self.spectrum(k, &name);
        }
        for coherence in &self.coherences {
            figures += &self.coherence(&escaped(&coherence.output), &coherence.values);
        }
        format!(
            "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\
             <meta name=\"generator\" content=\"lacuna look\">\
             <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">\
             <title>{0}</title><style>{STYLE}</style></head><body><main><h1>{0}</h1><ul>{body}</ul>{figures}\
             </main></body></html>\n",
            escaped(title)
        )
    }

    fn in_time(&self, k: usize, name: &str) -> String {
        let Some(band) = self.drawn.bands.get(k) else { return String::new() };
        let (low, high) = (self.signals[k].min, self.signals[k].max);
        let (mut path, mut open) = (String::new(), false);
        for (c, (least, most)) in band.iter().enumerate() {
            if least > most {
                open = false;
                continue;
            }
            let x = LEFT + c as f64 / band.len() as f64 * WIDTH;
            let _ = write!(
                path,
                "{}{x:.1} {:.1}L{x:.1} {:.1}",
                if open { "L" } else { "M" },
                height(*least, low, high),
                height(*most, low, high)
            );
            open = true;
        }
        let end = self.start + (self.samples.max(1) - 1) as f64 * self.sampling_time;
        let x = (format!("{} s", short(self.start)), format!("{} s", short(end)));
        let inside = format!("<path d=\"{path}\"/>");
        figure(&format!("{name} over time"), x, (short(low), short(high)), &inside)
    }

    fn spectrum(&self, k: usize, name: &str) -> String {
        let Some(density) = self.drawn.density.get(k) else { return String::new() };
        let decibels: Vec<f64> =
            density.iter().skip(1).map(|power| 10.0 * power.max(1e-300).log10()).collect();
        let high = decibels.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let low = decibels.iter().copied().fold(f64::INFINITY, f64::min).max(high - 120.0);
        let ends = (format!("{low:.0} dB"), format!("{high:.0} dB"));
        self.over_frequency(&format!("{name}: power spectral density"), &decibels, low, high, ends)
    }

    fn coherence(&self, name: &str, values: &[f64]) -> String {
        let values: Vec<f64> = values.iter().skip(1).copied().collect();
        let title = format!("{name}: coherence with all inputs together");
        self.over_frequency(&title, &values, 0.0, 1.0, ("0".into(), "1".into()))
    }

    /// Values at all frequencies but 0, over the logarithm of the frequency.
    fn over_frequency(
        &self,
        title: &str,
        values: &[f64],
        low: f64,
        high: f64,
        ends: (String, String),
    ) -> String {
        let frequency = &self.drawn.frequency;
        let (Some(&first), Some(&last)) = (frequency.get(1), frequency.last()) else {
            return String::new();
        };
        let span = (last / first).ln().max(1e-9);
        let mut path = String::new();
        for (k, (value, f)) in values.iter().zip(&frequency[1..]).enumerate() {
            let x = LEFT + (f / first).ln() / span * WIDTH;
            let y = height(value.clamp(low, high), low, high);
            let _ = write!(path, "{}{x:.1} {y:.1}", if k == 0 { "M" } else { "L" });
        }
        let x = (format!("{} Hz", short(first)), format!("{} Hz", short(last)));
        figure(title, x, ends, &format!("<path d=\"{path}\"/>"))
    }
}

const STYLE: &str = "\
:root{color-scheme:light dark;--ink:#222;--line:#0b62a4;--frame:#bbb;--paper:#fff}\
@media(prefers-color-scheme:dark){:root{--ink:#ddd;--line:#6db3ef;--frame:#555;--paper:#161616}}\
body{font:15px/1.5 system-ui,sans-serif;color:var(--ink);background:var(--paper);margin:0}\
main{max-width:820px;margin:0 auto;padding:1rem}figure{margin:1.2rem 0}figcaption{font-weight:600}\
svg{width:100%;height:auto}svg text{font-size:11px;fill:var(--ink)}\
.frame{fill:none;stroke:var(--frame)}path{fill:none;stroke:var(--line);stroke-width:1.2}\
li.deep{margin-left:1.5rem}";
