//! Plots as SVG: lines, bands, dots with error bars, logarithmic axes.

use std::fmt::Write;

/// Where a number lies along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Even steps.
    Linear,
    /// Even ratios; what is not positive is left out.
    Log,
}

/// What is drawn.
#[derive(Debug, Clone)]
enum Item {
    Line(Vec<(f64, f64)>),
    Band(Vec<(f64, f64, f64)>),
    Dots(Vec<(f64, f64, f64)>),
    Level(f64),
    Upright(f64),
}

/// A plot with two axes.
#[derive(Debug, Clone)]
pub struct Figure {
    x: (String, Scale),
    y: (String, Scale),
    height: f64,
    items: Vec<(Item, &'static str, String)>,
    /// What stands at 1, 2, .. along x, instead of numbers.
    names: Vec<String>,
}

const WIDTH: f64 = 760.0;
const LEFT: f64 = 78.0;
const RIGHT: f64 = 12.0;
const TOP: f64 = 12.0;
const BOTTOM: f64 = 44.0;

impl Figure {
    /// An empty plot with the names of its axes.
    pub fn new(x: &str, y: &str) -> Self {
        Self {
            x: (x.into(), Scale::Linear),
            y: (y.into(), Scale::Linear),
            height: 260.0,
            items: vec![],
            names: vec![],
        }
    }

    /// The same with names at 1, 2, .. along x.
    #[must_use]
    pub fn named(mut self, names: &[String]) -> Self {
        self.names = names.to_vec();
        self
    }

    /// The same with other scales.
    #[must_use]
    pub fn scales(mut self, x: Scale, y: Scale) -> Self {
        (self.x.1, self.y.1) = (x, y);
        self
    }

    /// The same with another height, 260 being the usual one.
    #[must_use]
    pub fn height(mut self, height: f64) -> Self {
        self.height = height;
        self
    }

    /// Adds a line; `class` picks its colour, an empty `label` keeps it out of the legend.
    #[must_use]
    pub fn line(self, class: &'static str, label: &str, points: Vec<(f64, f64)>) -> Self {
        self.item(Item::Line(points), class, label)
    }

    /// Adds a band between two values at every x.
    #[must_use]
    pub fn band(self, class: &'static str, label: &str, points: Vec<(f64, f64, f64)>) -> Self {
        self.item(Item::Band(points), class, label)
    }

    /// Adds dots with bars of so much up and down.
    #[must_use]
    pub fn dots(self, class: &'static str, label: &str, points: Vec<(f64, f64, f64)>) -> Self {
        self.item(Item::Dots(points), class, label)
    }

    /// Adds a level line.
    #[must_use]
    pub fn level(self, class: &'static str, label: &str, y: f64) -> Self {
        self.item(Item::Level(y), class, label)
    }

    /// Adds an upright line.
    #[must_use]
    pub fn upright(self, class: &'static str, label: &str, x: f64) -> Self {
        self.item(Item::Upright(x), class, label)
    }

    fn item(mut self, item: Item, class: &'static str, label: &str) -> Self {
        self.items.push((item, class, label.into()));
        self
    }

    fn ranges(&self) -> Option<((f64, f64), (f64, f64))> {
        let (mut x, mut y) = (Range::new(self.x.1), Range::new(self.y.1));
        for (item, _, _) in &self.items {
            match item {
                Item::Line(points) => points.iter().for_each(|p| {
                    x.add(p.0);
                    y.add(p.1);
                }),
                Item::Band(points) => points.iter().for_each(|p| {
                    x.add(p.0);
                    y.add(p.1);
                    y.add(p.2);
                }),
                Item::Dots(points) => points.iter().for_each(|p| {
                    x.add(p.0);
                    y.add(p.1);
                }),
                Item::Level(value) => y.add(*value),
                Item::Upright(value) => x.add(*value),
            }
        }
        // a dot on the frame would be half a dot
        let dots = self.items.iter().any(|(item, _, _)| matches!(item, Item::Dots(_)));
        Some((x.widened(if dots { 0.02 } else { 0.0 })?, y.widened(0.05)?))
    }

    /// Where something stands along x, and what.
    fn marks(&self, range: (f64, f64)) -> Vec<(f64, String)> {
        if self.names.is_empty() {
            let all = ticks(range, self.x.1, 7).into_iter();
            return all.map(|tick| (tick, label(tick, range, self.x.1))).collect();
        }
        self.names.iter().zip(1..).map(|(name, at)| (f64::from(at), name.clone())).collect()
    }

    /// The plot as a file of its own, with its colours in it.
    pub fn file(&self) -> String {
        let style = include_str!("style.css");
        let own = format!("<style>{style}text{{font-family:system-ui,sans-serif}}</style>");
        self.drawing().replacen('>', &format!(">{own}"), 1)
    }

    /// The plot in a box that scrolls where the page is too narrow for it to be read.
    pub fn svg(&self) -> String {
        format!("<div class=\"scroll\">{}</div>", self.drawing())
    }

    /// The plot as an `<svg>` element whose colours come from the page's style.
    fn drawing(&self) -> String {
        let Some((xr, yr)) = self.ranges() else {
            return "<p class=\"note\">Nothing to draw.</p>".into();
        };
        let legend: Vec<(&Item, &str, &str)> = self
            .items
            .iter()
            .filter(|(_, _, label)| !label.is_empty())
            .map(|(item, class, label)| (item, *class, label.as_str()))
            .collect();
        let top = if legend.is_empty() { TOP } else { TOP + 20.0 };
        let (w, h) = (WIDTH - LEFT - RIGHT, self.height - top - BOTTOM);
        let px = |v: f64| LEFT + w * position(v, xr, self.x.1);
        let py = |v: f64| top + h * (1.0 - position(v, yr, self.y.1));
        let mut s = format!(
            "<svg viewBox=\"0 0 {WIDTH} {}\" role=\"img\" aria-label=\"{}\" xmlns=\"http://www.w3.org/2000/svg\">",
            self.height,
            escape(&format!("{} against {}", self.y.0, self.x.0))
        );
        for (tick, text) in self.marks(xr) {
            let x = px(tick);
            let _ = write!(
                s,
                "<line class=\"grid\" x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"{top}\" y2=\"{:.1}\"/><text class=\"tick\" x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
                top + h,
                top + h + 16.0,
                escape(&text)
            );
        }
        for tick in ticks(yr, self.y.1, 5) {
            let y = py(tick);
            let _ = write!(
                s,
                "<line class=\"grid\" x1=\"{LEFT}\" x2=\"{:.1}\" y1=\"{y:.1}\" y2=\"{y:.1}\"/><text class=\"tick\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
                LEFT + w,
                LEFT - 6.0,
                y + 4.0,
                label(tick, yr, self.y.1)
            );
        }
        for (item, class, _) in &self.items {
            draw(&mut s, item, class, &px, &py, (top, h), w, (self.x.1, self.y.1));
        }
        let mut at = LEFT;
        for (item, class, text) in legend {
            let mark = match item {
                Item::Dots(_) => format!(
                    "<circle class=\"{class} dot\" cx=\"{:.1}\" cy=\"{TOP}\" r=\"3\"/>",
                    at + 9.0
                ),
                Item::Band(_) => format!(
                    "<rect class=\"{class} band\" x=\"{at:.1}\" y=\"{:.1}\" width=\"18\" height=\"8\"/>",
                    TOP - 4.0
                ),
                _ => format!(
                    "<line class=\"{class} line\" x1=\"{at:.1}\" x2=\"{:.1}\" y1=\"{TOP}\" y2=\"{TOP}\"/>",
                    at + 18.0
                ),
            };
            let _ = write!(
                s,
                "{mark}<text class=\"tick\" x=\"{:.1}\" y=\"{:.1}\">{}</text>",
                at + 24.0,
                TOP + 4.0,
                escape(text)
            );
            at += 44.0 + 6.6 * text.chars().count() as f64;
        }
        let _ = write!(
            s,
            "<text class=\"axis\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
            LEFT + w / 2.0,
            self.height - 8.0,
            escape(&self.x.0)
        );
        let _ = write!(
            s,
            "<text class=\"axis\" transform=\"translate(14 {:.1}) rotate(-90)\" text-anchor=\"middle\">{}</text></svg>",
            top + h / 2.0,
            escape(&self.y.0)
        );
        s
    }
}

#[allow(clippy::too_many_arguments)]
fn draw(
    s: &mut String,
    item: &Item,
    class: &str,
    px: &dyn Fn(f64) -> f64,
    py: &dyn Fn(f64) -> f64,
    (top, h): (f64, f64),
    w: f64,
    scales: (Scale, Scale),
) {
    let seen = |x: f64, y: f64| {
        let fits = |v: f64, scale| v.is_finite() && (scale == Scale::Linear || v > 0.0);
        fits(x, scales.0) && fits(y, scales.1)
    };
    match item {
        Item::Line(points) => {
            for piece in points.split(|p| !seen(p.0, p.1)).filter(|piece| !piece.is_empty()) {
                let path: Vec<String> =
                    piece.iter().map(|p| format!("{:.1},{:.1}", px(p.0), py(p.1))).collect();
                let _ =
                    write!(s, "<polyline class=\"{class} line\" points=\"{}\"/>", path.join(" "));
            }
        }
        Item::Band(points) => {
            let there = || points.iter().filter(|p| seen(p.0, p.1) && seen(p.0, p.2));
            let up = there().map(|p| format!("{:.1},{:.1}", px(p.0), py(p.2)));
            let back = there().rev().map(|p| format!("{:.1},{:.1}", px(p.0), py(p.1)));
            let path: Vec<String> = up.chain(back).collect();
            let _ = write!(s, "<polygon class=\"{class} band\" points=\"{}\"/>", path.join(" "));
        }
        Item::Dots(points) => {
            for p in points.iter().filter(|p| seen(p.0, p.1)) {
                let (x, y) = (px(p.0), py(p.1));
                if p.2 > 0.0 && seen(p.0, p.1 - p.2) {
                    let clamp = |v: f64| v.clamp(top, top + h);
                    let _ = write!(
                        s,
                        "<line class=\"{class} bar\" x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"{:.1}\" y2=\"{:.1}\"/>",
                        clamp(py(p.1 - p.2)),
                        clamp(py(p.1 + p.2))
                    );
                }
                let _ = write!(
                    s,
                    "<circle class=\"{class} dot\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\"/>"
                );
            }
        }
        Item::Level(value) => {
            let y = py(*value);
            let _ = write!(
                s,
                "<line class=\"{class} line\" x1=\"{LEFT}\" x2=\"{:.1}\" y1=\"{y:.1}\" y2=\"{y:.1}\"/>",
                LEFT + w
            );
        }
        Item::Upright(value) => {
            let x = px(*value);
            let _ = write!(
                s,
                "<line class=\"{class} line\" x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"{top}\" y2=\"{:.1}\"/>",
                top + h
            );
        }
    }
}

struct Range {
    scale: Scale,
    low: f64,
    high: f64,
}

impl Range {
    fn new(scale: Scale) -> Self {
        Self { scale, low: f64::INFINITY, high: f64::NEG_INFINITY }
    }

    fn add(&mut self, value: f64) {
        if value.is_finite() && (self.scale == Scale::Linear || value > 0.0) {
            self.low = self.low.min(value);
            self.high = self.high.max(value);
        }
    }

    /// The range with a margin on both sides; `None` where nothing was added.
    fn widened(&self, margin: f64) -> Option<(f64, f64)> {
        if self.low > self.high {
            return None;
        }
        if self.scale == Scale::Log {
            let ratio = (self.high / self.low).powf(margin).max(1.0 + 2.0 * margin);
            return Some((self.low / ratio, self.high * ratio));
        }
        let size = match self.high - self.low {
            0.0 if self.high == 0.0 => 1.0,
            0.0 => self.high.abs(),
            size => size,
        };
        let margin = if self.high == self.low { 0.5 } else { margin };
        Some((self.low - margin * size, self.high + margin * size))
    }
}

fn position(v: f64, (low, high): (f64, f64), scale: Scale) -> f64 {
    let share = match scale {
        Scale::Linear => (v - low) / (high - low),
        Scale::Log => (v.max(low) / low).ln() / (high / low).ln(),
    };
    share.clamp(-0.2, 1.2)
}

/// Round values within a range.
fn ticks((low, high): (f64, f64), scale: Scale, about: usize) -> Vec<f64> {
    if scale == Scale::Log {
        let (first, last) = (low.log10().ceil() as i32, high.log10().floor() as i32);
        let step = ((last - first) / about as i32).max(1) as usize;
        let powers: Vec<f64> = (first..=last).step_by(step).map(|e| 10f64.powi(e)).collect();
        if powers.len() > 2 {
            return powers;
        }
        let decades = (first - 1..=last).map(|e| 10f64.powi(e));
        let all = decades.flat_map(|power| [1.0, 2.0, 5.0].map(|m| m * power));
        return all.filter(|tick| (low..=high).contains(tick)).collect();
    }
    let raw = (high - low) / about as f64;
    let power = 10f64.powf(raw.log10().floor());
    let step =
        [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * power).find(|s| *s >= raw).unwrap_or(raw);
    let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
    (first..=last).map(|k| k as f64 * step).collect()
}

fn label(v: f64, (low, high): (f64, f64), scale: Scale) -> String {
    // even steps share their digits with the largest, even ratios each have their own
    let size = if scale == Scale::Log { v.abs() } else { low.abs().max(high.abs()) };
    if v == 0.0 {
        return "0".into();
    }
    if !(1e-3..1e5).contains(&size) {
        let text = format!("{v:.2e}");
        // 2.00e-4 is 2e-4
        let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
        let digits = digits.trim_end_matches('0').trim_end_matches('.');
        return format!("{digits}e{power}").replace('-', "\u{2212}");
    }
    let text = format!("{v:.6}");
    text.trim_end_matches('0').trim_end_matches('.').replace('-', "\u{2212}")
}

/// Text as it may stand in HTML and SVG.
pub fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            c => safe.push(c),
        }
    }
    safe
}

/// A series thinned to the smallest and the largest value of each of many stretches, so that
/// no peak is lost.
pub fn thinned(points: &[(f64, f64)], stretches: usize) -> Vec<(f64, f64)> {
    if points.len() <= 2 * stretches {
        return points.to_vec();
    }
    let mut kept = vec![];
    for piece in points.chunks(points.len().div_ceil(stretches)) {
        let by = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
        let finite = || piece.iter().filter(|p| p.1.is_finite());
        match (finite().min_by(by), finite().max_by(by)) {
            (Some(&low), Some(&high)) if low.0 <= high.0 => kept.extend([low, high]),
            (Some(&low), Some(&high)) => kept.extend([high, low]),
            _ => kept.push((piece[0].0, f64::NAN)),
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_of_few_powers_of_ten_is_marked_between_them() {
        let about = |range| ticks(range, Scale::Log, 5);
        assert_eq!(about((0.025, 0.3)), [0.05, 0.1, 0.2]);
        assert_eq!(about((0.5, 2e3)), [1.0, 10.0, 100.0, 1000.0]);
        let figure = Figure::new("start", "").named(&["random".into()]);
        assert!(figure.dots("", "", vec![(1.0, 2.0, 0.0)]).svg().contains(">random<"));
    }
}
