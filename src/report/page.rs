//! One HTML page that needs nothing else.

use std::fmt::Write;

use super::svg::escape;

/// A page under construction.
#[derive(Debug, Default)]
pub struct Page {
    body: String,
}

impl Page {
    /// Adds HTML as it is.
    pub fn raw(&mut self, html: &str) {
        self.body.push_str(html);
        self.body.push('\n');
    }

    /// Adds an element with text.
    pub fn element(&mut self, tag: &str, class: &str, text: &str) {
        let class = if class.is_empty() { String::new() } else { format!(" class=\"{class}\"") };
        // the terminal and the JSON document keep to ASCII; a number and its % stay together
        let text = escape(&text.replace(" +- ", " \u{b1} ").replace(" %", "\u{a0}%"));
        let _ = writeln!(self.body, "<{tag}{class}>{text}</{tag}>");
    }

    /// Adds a heading.
    pub fn heading(&mut self, text: &str) {
        self.element("h2", "", text);
    }

    /// Adds a table; a header that begins with `#` is one of numbers, `|` begins a cell that
    /// is HTML already.
    pub fn table(&mut self, header: &[&str], rows: &[Vec<String>]) {
        let class = |i: usize| {
            if header.get(i).is_some_and(|h| h.starts_with('#')) { " class=\"n\"" } else { "" }
        };
        self.body.push_str("<div class=\"scroll\"><table><thead><tr>");
        for (i, text) in header.iter().enumerate() {
            let _ =
                write!(self.body, "<th{}>{}</th>", class(i), escape(text.trim_start_matches('#')));
        }
        self.body.push_str("</tr></thead><tbody>");
        for row in rows {
            self.body.push_str("<tr>");
            for (i, cell) in row.iter().enumerate() {
                let html = cell.strip_prefix('|').map_or_else(|| escape(cell), str::to_string);
                let _ = write!(self.body, "<td{}>{html}</td>", class(i));
            }
            self.body.push_str("</tr>");
        }
        self.body.push_str("</tbody></table></div>\n");
    }

    /// The whole file.
    pub fn html(self, title: &str) -> String {
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta name=\"generator\" content=\"lacuna\">\n\
             <title>{}</title>\n<style>\n{}</style></head>\n<body><main>\n{}</main></body></html>\n",
            escape(title),
            include_str!("style.css"),
            self.body
        )
    }
}

/// A cell with a share as a bar.
pub fn share(value: f64) -> String {
    let width = 90.0 * value.clamp(0.0, 1.0);
    format!("|<span class=\"share\" style=\"width:{width:.0}px\"></span>{:.1} %", 100.0 * value)
}
