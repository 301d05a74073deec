//! The still picture of a figure as SVG: for print, for a page without scripts, for a file.

use std::fmt::Write;

use super::axis::{Range, label, position, ticks};
use super::escape::escape;
use super::figure::{Figure, Item, Scale, Shape};
use super::thin::thinned;

const WIDTH: f64 = 760.0;
const LEFT: f64 = 78.0;
const RIGHT: f64 = 12.0;
const TOP: f64 = 12.0;
const BOTTOM: f64 = 44.0;
/// Height of one row of the legend.
const ROW: f64 = 18.0;
/// Stretches that a line is thinned to: more would fall on the same points of print.
const STRETCHES: usize = 380;
/// Characters of a label that the legend shows.
const LONGEST: usize = 60;

/// Where things lie in the picture.
struct Frame {
    x: ((f64, f64), Scale),
    y: ((f64, f64), Scale),
    top: f64,
    width: f64,
    height: f64,
}

impl Frame {
    fn x(&self, v: f64) -> f64 {
        LEFT + self.width * position(v, self.x.0, self.x.1)
    }

    fn y(&self, v: f64) -> f64 {
        self.top + self.height * (1.0 - position(v, self.y.0, self.y.1))
    }

    /// Whether a point can be drawn on these scales.
    fn shows(&self, x: f64, y: f64) -> bool {
        let fits = |v: f64, scale| v.is_finite() && (scale == Scale::Linear || v > 0.0);
        fits(x, self.x.1) && fits(y, self.y.1)
    }
}

impl Figure {
    /// The picture as a file of its own, with its colours in it.
    pub fn file(&self) -> String {
        let style = include_str!("style.css");
        let own = format!("<style>{style}text{{font-family:system-ui,sans-serif}}</style>");
        self.svg().replacen('>', &format!(">{own}"), 1)
    }

    /// The picture as an `<svg>` element whose colours come from the page's style.
    pub fn svg(&self) -> String {
        let items: Vec<Item> = self.items.iter().filter(|i| !i.off).map(|i| self.seen(i)).collect();
        let Some((xr, yr)) = self.ranges(&items) else {
            return "<p class=\"note\">Nothing to draw.</p>".into();
        };
        let (legend, rows) = legend(&items);
        let top = TOP + ROW * rows as f64;
        let frame = Frame {
            x: (xr, self.x.1),
            y: (yr, self.y.1),
            top,
            width: WIDTH - LEFT - RIGHT,
            height: self.height - TOP - ROW - BOTTOM,
        };
        let whole = top + frame.height + BOTTOM;
        let mut s = format!(
            "<svg viewBox=\"0 0 {WIDTH} {whole}\" role=\"img\" aria-label=\"{}\" xmlns=\"http://www.w3.org/2000/svg\">",
            escape(&self.title)
        );
        self.axes(&mut s, &frame);
        for item in &items {
            draw(&mut s, item, &frame);
        }
        s.push_str(&legend);
        let _ = write!(
            s,
            "<text class=\"axis\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
            LEFT + frame.width / 2.0,
            whole - 8.0,
            escape(&self.x.0)
        );
        let _ = write!(
            s,
            "<text class=\"axis\" transform=\"translate(14 {:.1}) rotate(-90)\" text-anchor=\"middle\">{}</text></svg>",
            top + frame.height / 2.0,
            escape(&self.y.0)
        );
        s
    }

    /// An item as the picture shows it: within the view, and thinned.
    fn seen(&self, item: &Item) -> Item {
        let inside = |x: f64| self.view.is_none_or(|(from, to)| (from..=to).contains(&x));
        let shape = match &item.shape {
            Shape::Band(points) => {
                Shape::Band(points.iter().copied().filter(|p| inside(p.0)).collect())
            }
            Shape::Dots(points) => {
                Shape::Dots(points.iter().copied().filter(|p| inside(p.0)).collect())
            }
            other => match other.points() {
                Some(points) => {
                    let seen: Vec<_> = points.iter().copied().filter(|p| inside(p.0)).collect();
                    Shape::Line(thinned(&seen, STRETCHES))
                }
                None => other.clone(),
            },
        };
        Item { shape, ..item.clone() }
    }

    fn ranges(&self, items: &[Item]) -> Option<((f64, f64), (f64, f64))> {
        let (mut x, mut y) = (Range::new(self.x.1), Range::new(self.y.1));
        for item in items {
            match &item.shape {
                Shape::Line(points) => points.iter().for_each(|p| {
                    x.add(p.0);
                    y.add(p.1);
                }),
                Shape::Band(points) => points.iter().for_each(|p| {
                    x.add(p.0);
                    y.add(p.1);
                    y.add(p.2);
                }),
                Shape::Dots(points) => points.iter().for_each(|p| {
                    x.add(p.0);
                    y.add(p.1 - p.2);
                    y.add(p.1);
                    y.add(p.1 + p.2);
                }),
                Shape::Level(value) => y.add(*value),
                Shape::Upright(value) if self.view.is_none() => x.add(*value),
                Shape::Upright(_) | Shape::Difference(..) => {}
            }
        }
        // a dot on the frame would be half a dot
        let dots = items.iter().any(|item| matches!(item.shape, Shape::Dots(_)));
        Some((x.widened(if dots { 0.02 } else { 0.0 })?, y.widened(0.05)?))
    }

    fn axes(&self, s: &mut String, frame: &Frame) {
        let bottom = frame.top + frame.height;
        for (tick, text) in self.marks(frame.x.0) {
            let x = frame.x(tick);
            let _ = write!(
                s,
                "<line class=\"grid\" x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"{:.1}\" y2=\"{bottom:.1}\"/><text class=\"tick\" x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
                frame.top,
                bottom + 16.0,
                escape(&text)
            );
        }
        for tick in ticks(frame.y.0, frame.y.1, 5) {
            let y = frame.y(tick);
            let _ = write!(
                s,
                "<line class=\"grid\" x1=\"{LEFT}\" x2=\"{:.1}\" y1=\"{y:.1}\" y2=\"{y:.1}\"/><text class=\"tick\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
                LEFT + frame.width,
                LEFT - 6.0,
                y + 4.0,
                label(tick, frame.y.0, frame.y.1)
            );
        }
    }

    /// Where something stands along x, and what.
    fn marks(&self, range: (f64, f64)) -> Vec<(f64, String)> {
        if self.names.is_empty() {
            let all = ticks(range, self.x.1, 7).into_iter();
            return all.map(|tick| (tick, label(tick, range, self.x.1))).collect();
        }
        self.names.iter().zip(1..).map(|(name, at)| (f64::from(at), name.clone())).collect()
    }
}

/// The legend and how many rows it has.
fn legend(items: &[Item]) -> (String, usize) {
    let (mut s, mut at, mut row) = (String::new(), LEFT, 0);
    let listed = items.iter().filter(|item| !item.label.is_empty());
    for item in listed {
        let text: String = item.label.chars().take(LONGEST).collect();
        let width = 44.0 + 6.6 * text.chars().count() as f64;
        if row == 0 {
            row = 1;
        } else if at + width > WIDTH - RIGHT {
            (at, row) = (LEFT, row + 1);
        }
        let y = TOP + ROW * (row as f64 - 1.0);
        let class = item.role.class();
        let mark = match item.shape {
            Shape::Dots(_) => {
                format!("<circle class=\"{class} dot\" cx=\"{:.1}\" cy=\"{y}\" r=\"3\"/>", at + 9.0)
            }
            Shape::Band(_) => format!(
                "<rect class=\"{class} band\" x=\"{at:.1}\" y=\"{:.1}\" width=\"18\" height=\"8\"/>",
                y - 4.0
            ),
            _ => format!(
                "<line class=\"{class} line\" x1=\"{at:.1}\" x2=\"{:.1}\" y1=\"{y}\" y2=\"{y}\"/>",
                at + 18.0
            ),
        };
        let _ = write!(
            s,
            "{mark}<text class=\"tick\" x=\"{:.1}\" y=\"{:.1}\">{}</text>",
            at + 24.0,
            y + 4.0,
            escape(&text)
        );
        at += width;
    }
    (s, row)
}

fn draw(s: &mut String, item: &Item, frame: &Frame) {
    let class = item.role.class();
    let (top, bottom, right) = (frame.top, frame.top + frame.height, LEFT + frame.width);
    match &item.shape {
        Shape::Line(points) => {
            let seen = |p: &(f64, f64)| frame.shows(p.0, p.1);
            for piece in points.split(|p| !seen(p)).filter(|piece| !piece.is_empty()) {
                let path = piece.iter().map(|p| format!("{:.1},{:.1}", frame.x(p.0), frame.y(p.1)));
                let path: Vec<String> = path.collect();
                let path = path.join(" ");
                let _ = write!(s, "<polyline class=\"{class} line\" points=\"{path}\"/>");
            }
        }
        Shape::Band(points) => {
            let there = || points.iter().filter(|p| frame.shows(p.0, p.1) && frame.shows(p.0, p.2));
            let up = there().map(|p| format!("{:.1},{:.1}", frame.x(p.0), frame.y(p.2)));
            let back = there().rev().map(|p| format!("{:.1},{:.1}", frame.x(p.0), frame.y(p.1)));
            let path: Vec<String> = up.chain(back).collect();
            let _ = write!(s, "<polygon class=\"{class} band\" points=\"{}\"/>", path.join(" "));
        }
        Shape::Dots(points) => {
            for p in points.iter().filter(|p| frame.shows(p.0, p.1)) {
                let (x, y) = (frame.x(p.0), frame.y(p.1));
                if p.2 > 0.0 && frame.shows(p.0, p.1 - p.2) {
                    let within = |v: f64| frame.y(v).clamp(top, bottom);
                    let _ = write!(
                        s,
                        "<line class=\"{class} bar\" x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"{:.1}\" y2=\"{:.1}\"/>",
                        within(p.1 - p.2),
                        within(p.1 + p.2)
                    );
                }
                let _ = write!(
                    s,
                    "<circle class=\"{class} dot\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\"/>"
                );
            }
        }
        Shape::Level(value) => {
            let y = frame.y(*value);
            let _ = write!(
                s,
                "<line class=\"{class} line\" x1=\"{LEFT}\" x2=\"{right:.1}\" y1=\"{y:.1}\" y2=\"{y:.1}\"/>"
            );
        }
        Shape::Upright(value) if (frame.x.0.0..=frame.x.0.1).contains(value) => {
            let x = frame.x(*value);
            let _ = write!(
                s,
                "<line class=\"{class} line\" x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"{top:.1}\" y2=\"{bottom:.1}\"/>"
            );
        }
        Shape::Upright(_) | Shape::Difference(..) => {}
    }
}

#[cfg(test)]
mod tests {
    use super::super::figure::Role;
    use super::*;

    #[test]
    fn a_picture_keeps_to_its_view_and_to_what_is_switched_on() {
        let line = |size: f64| (0..5000).map(|k| (f64::from(k), size * f64::from(k))).collect();
        let figure = Figure::new("t", "y").view(100.0, 200.0);
        let figure = figure.line(Role::Before, "model", line(1.0));
        let figure = figure.line(Role::Law, "another", line(-1.0)).off();
        let svg = figure.svg();
        assert!(!svg.contains("another") && svg.contains(">model<"), "{svg}");
        assert!(svg.contains(">150<") && !svg.contains(">1000<"), "{svg}");
        assert!(svg.len() < 20_000, "{}", svg.len());
    }

    #[test]
    fn names_stand_along_an_axis() {
        let figure = Figure::new("start", "").named(&["random".into()]);
        let svg = figure.dots(Role::Before, "", vec![(1.0, 2.0, 0.0)]).svg();
        assert!(svg.contains(">random<"), "{svg}");
    }
}
