//! A page as one HTML file that needs nothing else and obeys nothing else.
//!
//! Scripts and styles stand in the file, and its Content-Security-Policy (W3C, CSP Level 3)
//! admits these by their SHA-256 and nothing besides: no network, no script that came with a
//! name. Without scripts the file still shows every text, table and still picture.

use std::fmt::Write;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use sha2::{Digest, Sha256};

use super::chart::Charts;
use super::escape::{embedded, escape};
use super::page::{Block, Cell, Column, Kind, Page};

const STYLE: &str = concat!(include_str!("vendor/uPlot.min.css"), "\n", include_str!("style.css"));

/// The scripts of a page, in the order in which they use each other.
const SCRIPTS: [&str; 11] = [
    include_str!("vendor/uPlot.iife.min.js"),
    include_str!("web/decode.js"),
    include_str!("web/thin.js"),
    include_str!("web/csv.js"),
    include_str!("web/theme.js"),
    include_str!("web/draw.js"),
    include_str!("web/legend.js"),
    include_str!("web/chart.js"),
    include_str!("web/gestures.js"),
    include_str!("web/links.js"),
    include_str!("web/page.js"),
];

/// Figures, tables of this many columns or more are shown as cards where the page is narrow.
const WIDE: usize = 4;

fn script() -> String {
    let mut all = format!("\"use strict\";\n/*\n{}*/\n", include_str!("vendor/uPlot.LICENSE"));
    for part in SCRIPTS {
        all.push_str(part);
        all.push('\n');
    }
    all
}

/// What a policy calls a text that it admits.
fn admitted(text: &str) -> String {
    format!("'sha256-{}'", STANDARD.encode(Sha256::digest(text.as_bytes())))
}

impl Page {
    /// The whole file.
    pub fn html(&self) -> String {
        let (style, script) = (format!("\n{STYLE}\n"), script());
        let mut body = Body::default();
        for block in &self.blocks {
            body.block(block, self);
        }
        let body = body.finish(self);
        let policy = format!(
            "default-src 'none'; script-src {}; style-src {}; img-src data: blob:; base-uri 'none'; form-action 'none'",
            admitted(&script),
            admitted(&style)
        );
        let (refresh, again) = match self.again {
            Some(seconds) => (
                format!(
                    "<noscript><meta http-equiv=\"refresh\" content=\"{seconds}\"></noscript>\n"
                ),
                format!(" data-again=\"{seconds}\""),
            ),
            None => (String::new(), String::new()),
        };
        let data = match self.figures.is_empty() && self.again.is_none() {
            true => String::new(),
            false => {
                let charts = serde_json::to_string(&Charts::of(&self.figures)).unwrap_or_default();
                let charts = embedded(&charts);
                format!(
                    "<script type=\"application/json\" id=\"figures\">{charts}</script>\n\
                     <script>{script}</script>\n"
                )
            }
        };
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\"{again}><head><meta charset=\"utf-8\">\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta name=\"generator\" content=\"lacuna\">\n{refresh}\
             <title>{}</title>\n<style>{style}</style></head>\n<body>\n{body}{data}</body></html>\n",
            escape(&self.title),
        )
    }
}

/// The visible part under construction.
#[derive(Default)]
struct Body {
    main: String,
    /// Anchor and text of every heading.
    contents: Vec<(String, String)>,
    section: bool,
    folds: usize,
}

impl Body {
    fn block(&mut self, block: &Block, page: &Page) {
        match block {
            Block::Text { kind: Kind::Heading, text } => self.heading(text),
            Block::Text { kind, text } => {
                let (open, close) = match kind {
                    Kind::Kicker => ("<p class=\"kicker\">", "</p>"),
                    Kind::Title => ("<h1>", "</h1>"),
                    Kind::Heading => ("<h2>", "</h2>"),
                    Kind::Subheading => ("<h3>", "</h3>"),
                    Kind::Lead => ("<p class=\"gain\">", "</p>"),
                    Kind::Note => ("<p class=\"note\">", "</p>"),
                    Kind::Text => ("<p>", "</p>"),
                    Kind::Footer => ("<footer>", "</footer>"),
                };
                let _ = writeln!(self.main, "{open}{}{close}", escape(text));
            }
            Block::Table { header, rows } => self.table(header, rows),
            Block::Figure(number) => {
                let Some(figure) = page.figures.get(*number) else { return };
                let _ = writeln!(
                    self.main,
                    "<figure id=\"figure-{}\" data-figure=\"{number}\"><figcaption>{}</figcaption>\
                     <div class=\"still\">{}</div></figure>",
                    number + 1,
                    escape(&figure.title),
                    figure.svg()
                );
            }
            Block::Open(summary) => {
                self.folds += 1;
                let _ = write!(self.main, "<details><summary>{}</summary>", escape(summary));
            }
            Block::Close if self.folds > 0 => {
                self.folds -= 1;
                self.main.push_str("</details>\n");
            }
            Block::Close => {}
        }
    }

    fn end_section(&mut self) {
        for _ in 0..std::mem::take(&mut self.folds) {
            self.main.push_str("</details>\n");
        }
        if std::mem::replace(&mut self.section, true) {
            self.main.push_str("</section>\n");
        }
    }

    fn heading(&mut self, text: &str) {
        self.end_section();
        let anchor = format!("section-{}", self.contents.len() + 1);
        let _ = writeln!(
            self.main,
            "<section aria-labelledby=\"{anchor}\"><h2 id=\"{anchor}\">{}</h2>",
            escape(text)
        );
        self.contents.push((anchor, text.into()));
    }

    fn table(&mut self, header: &[Column], rows: &[Vec<Cell>]) {
        let class = |i: usize| match header.get(i).is_some_and(|column| column.numbers) {
            true => " class=\"n\"",
            false => "",
        };
        let kind = if header.len() >= WIDE { " class=\"wide\"" } else { "" };
        // roles, because a narrow page lays rows out as cards, which ends what is implied
        let _ = write!(
            self.main,
            "<div class=\"scroll\"><table{kind} role=\"table\"><thead role=\"rowgroup\"><tr role=\"row\">"
        );
        for (i, column) in header.iter().enumerate() {
            let _ = write!(
                self.main,
                "<th{} scope=\"col\" role=\"columnheader\">{}</th>",
                class(i),
                escape(&column.name)
            );
        }
        self.main.push_str("</tr></thead><tbody role=\"rowgroup\">");
        for row in rows {
            self.main.push_str("<tr role=\"row\">");
            for (i, cell) in row.iter().enumerate() {
                let name = header.get(i).map_or("", |column| &column.name);
                let html = match cell {
                    Cell::Text(text) => escape(text),
                    Cell::Share(value) => bar(*value),
                };
                let _ = write!(
                    self.main,
                    "<td{} role=\"cell\" data-name=\"{}\">{html}</td>",
                    class(i),
                    escape(name)
                );
            }
            self.main.push_str("</tr>");
        }
        self.main.push_str("</tbody></table></div>\n");
    }

    /// The body's elements, with a table of contents where there is much.
    fn finish(mut self, page: &Page) -> String {
        self.end_section();
        let mut contents = String::new();
        if self.contents.len() > 3 {
            contents.push_str("<nav aria-label=\"Contents\"><ul>");
            for (anchor, text) in &self.contents {
                let _ = write!(contents, "<li><a href=\"#{anchor}\">{}</a></li>", escape(text));
            }
            contents.push_str("</ul></nav>\n");
        }
        let running = match page.again {
            Some(_) => {
                "<p class=\"running\" role=\"status\">Running: this page follows by itself.</p>\n"
            }
            None => "",
        };
        // the contents stand after what was found
        let at = self.main.find("<section").unwrap_or(self.main.len());
        let (top, rest) = self.main.split_at(at);
        format!("<main>\n{running}{top}{contents}{rest}</main>\n")
    }
}

/// A share as a bar, drawn so that it prints, with its per cent.
fn bar(value: f64) -> String {
    let width = 90.0 * value.clamp(0.0, 1.0);
    let text = match value {
        v if !v.is_finite() => String::new(),
        // a probability may be too small for a number
        v if (0.0..5e-4).contains(&v) => "&lt;\u{a0}0.1\u{a0}%".into(),
        v => format!("{:.1}\u{a0}%", 100.0 * v),
    };
    format!(
        "<svg class=\"share\" viewBox=\"0 0 90 9\" aria-hidden=\"true\"><rect width=\"{width:.0}\" \
         height=\"9\" rx=\"2\"/></svg>{text}"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_policy_admits_what_the_page_holds_and_names_are_not_obeyed() {
        let mut page = Page::default().titled("</title><script>alert(1)</script>");
        page.element("h1", "", "<img src=x onerror=alert(1)>");
        let line = vec![(0.0, 1.0), (1.0, 2.0)];
        page.figure(super::super::figure::Figure::new("</script><b>", "\u{202e}y").line(
            super::super::figure::Role::Before,
            "<i>",
            line,
        ));
        let html = page.again(5).html();
        assert!(!html.contains("<img") && !html.contains("<b>") && !html.contains("<i>"));
        assert!(!html.contains('\u{202e}') && html.contains("[U+202E]y"));
        assert!(html.contains("content=\"5\"") && html.contains("data-again=\"5\""));
        let inside = |from: &str, to: &str| {
            let start = html.find(from).unwrap() + from.len();
            html[start..start + html[start..].find(to).unwrap()].to_string()
        };
        assert!(html.contains(&admitted(&inside("<script>", "</script>"))));
        assert!(html.contains(&admitted(&inside("<style>", "</style>"))));
        assert_eq!(html.matches("<script").count(), 2);
        assert_eq!(html.matches("</script>").count(), 2);
    }

    #[test]
    fn sections_and_folds_are_closed_whatever_was_stored() {
        let mut page = Page::default();
        page.close();
        page.heading("one");
        page.open("more");
        page.heading("two");
        let html = page.html();
        for name in ["section", "details", "main"] {
            let (open, close) = (format!("<{name}"), format!("</{name}>"));
            assert_eq!(html.matches(&open).count(), html.matches(&close).count(), "{name}");
        }
        assert!(!Page::default().html().contains("</section>"));
    }
}
