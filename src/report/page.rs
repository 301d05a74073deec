//! A page as plain data: texts, tables and figures in their order.
//!
//! What is written here is stored beside the page (`report-data.json`), so that the page can be
//! drawn again; [`html`](super::html) turns it into HTML.

use serde::{Deserialize, Serialize};

use super::chart::Charts;
use super::escape::plain;
use super::figure::Figure;

/// Version of the stored form.
const SCHEMA: u32 = 1;

/// What a text is on the page.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Kind {
    /// A line above the title.
    Kicker,
    /// The title.
    Title,
    /// Heads a section.
    Heading,
    /// Heads a part of a section.
    Subheading,
    /// A result in words.
    Lead,
    /// A remark.
    Note,
    /// Plain text.
    Text,
    /// Text at the end.
    Footer,
}

/// A cell of a table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Cell {
    /// Text.
    Text(String),
    /// A share from 0 to 1, shown as a bar with its per cent.
    Share(f64),
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(plain(&text))
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(plain(text))
    }
}

/// A cell with a share as a bar.
pub fn share(value: f64) -> Cell {
    Cell::Share(value)
}

/// A column of a table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Column {
    pub name: String,
    /// Whether it holds numbers, which stand right.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub numbers: bool,
}

/// A part of a page.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Block {
    Text {
        kind: Kind,
        text: String,
    },
    Table {
        header: Vec<Column>,
        rows: Vec<Vec<Cell>>,
    },
    /// Figure of this number.
    Figure(usize),
    /// What follows, down to `Close`, is folded under this text.
    Open(String),
    Close,
}

/// A page under construction.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Page {
    pub(super) title: String,
    pub(super) blocks: Vec<Block>,
    pub(super) figures: Vec<Figure>,
    /// Seconds after which the page loads itself again: it is rewritten while work goes on.
    pub(super) again: Option<u32>,
}

/// A page as it is stored.
#[derive(Serialize, Deserialize)]
struct Stored {
    schema: u32,
    title: String,
    blocks: Vec<Block>,
    #[serde(flatten)]
    charts: Charts,
}

impl Page {
    /// Adds text: `p` with the class `kicker`, `gain`, `note` or none, `h1`, `h2`, `h3`, `footer`.
    pub fn element(&mut self, tag: &str, class: &str, text: &str) {
        let kind = match (tag, class) {
            ("h1", _) => Kind::Title,
            ("h2", _) => Kind::Heading,
            ("h3", _) => Kind::Subheading,
            ("footer", _) => Kind::Footer,
            (_, "kicker") => Kind::Kicker,
            (_, "gain") => Kind::Lead,
            (_, "note") => Kind::Note,
            _ => Kind::Text,
        };
        // the terminal and the JSON document keep to ASCII; a number and its % stay together
        let text = plain(text).replace(" +- ", " \u{b1} ");
        let text = text.replace(" -> ", " \u{2192} ").replace(" %", "\u{a0}%");
        self.blocks.push(Block::Text { kind, text });
    }

    /// Adds a heading.
    pub fn heading(&mut self, text: &str) {
        self.element("h2", "", text);
    }

    /// Adds a figure.
    pub fn figure(&mut self, figure: Figure) {
        if figure.is_empty() {
            self.element("p", "note", "Nothing to draw.");
            return;
        }
        self.blocks.push(Block::Figure(self.figures.len()));
        self.figures.push(figure);
    }

    /// Adds a table; a header that begins with `#` is one of numbers.
    pub fn table<C: Clone + Into<Cell>>(&mut self, header: &[&str], rows: &[Vec<C>]) {
        let column = |text: &&str| Column {
            name: plain(text.trim_start_matches('#')),
            numbers: text.starts_with('#'),
        };
        let header = header.iter().map(column).collect();
        let row = |row: &Vec<C>| row.iter().cloned().map(Into::into).collect();
        self.blocks.push(Block::Table { header, rows: rows.iter().map(row).collect() });
    }

    /// Folds what follows under a text, down to [`Page::close`].
    pub fn open(&mut self, summary: &str) {
        self.blocks.push(Block::Open(plain(summary)));
    }

    /// Ends what [`Page::open`] began.
    pub fn close(&mut self) {
        self.blocks.push(Block::Close);
    }

    /// The same with a title for the window.
    #[must_use]
    pub fn titled(mut self, title: &str) -> Self {
        self.title = plain(title);
        self
    }

    /// The same, loaded again by itself after so many seconds.
    #[must_use]
    pub fn again(mut self, seconds: u32) -> Self {
        self.again = Some(seconds);
        self
    }

    /// The stored form as a JSON document.
    pub fn stored(&self) -> String {
        let (title, blocks) = (self.title.clone(), self.blocks.clone());
        let stored = Stored { schema: SCHEMA, title, blocks, charts: Charts::of(&self.figures) };
        serde_json::to_string(&stored).unwrap_or_default() + "\n"
    }

    /// The page of a stored form.
    ///
    /// # Errors
    ///
    /// In words, if the text is not the stored form of a page.
    pub fn from_stored(text: &str) -> Result<Self, String> {
        let stored: Stored = serde_json::from_str(text).map_err(|error| error.to_string())?;
        if stored.schema != SCHEMA {
            let found = stored.schema;
            return Err(format!("schema {found} is not known (this program reads {SCHEMA})"));
        }
        let figures = stored.charts.figures().ok_or("the columns of a figure are damaged")?;
        let missing = |b: &&Block| matches!(b, Block::Figure(number) if *number >= figures.len());
        if let Some(Block::Figure(number)) = stored.blocks.iter().find(missing) {
            return Err(format!("there is no figure {number}, of {}", figures.len()));
        }
        Ok(Self { title: plain(&stored.title), blocks: stored.blocks, figures, again: None })
    }
}

#[cfg(test)]
mod tests {
    use super::super::figure::Role;
    use super::*;

    #[test]
    fn a_page_comes_back_from_its_stored_form() {
        let mut page = Page::default().titled("press");
        page.element("p", "gain", "0.12 +- 0.01 N explains 98 % \u{202e}");
        page.open("more");
        page.table(&["a", "#b"], &[vec!["|<b>".into(), share(0.5)]]);
        page.close();
        page.figure(Figure::new("t", "y").line(
            Role::Before,
            "model",
            vec![(0.0, 1.0), (1.0, 2.0)],
        ));
        let stored = page.stored();
        let back = Page::from_stored(&stored).unwrap();
        assert_eq!(back, page);
        assert_eq!(back.stored(), stored);
        assert!(stored.contains("98\u{a0}% [U+202E]"), "{stored}");
        for (from, to, said) in [
            ("\"schema\":1", "\"schema\":7", "schema 7 is not known"),
            ("\"figure\":0", "\"figure\":4", "no figure 4"),
            ("\"y\":1", "\"y\":11", "damaged"),
            ("{", "[", "expected"),
        ] {
            let error = Page::from_stored(&stored.replacen(from, to, 1)).unwrap_err();
            assert!(error.contains(said), "{error}");
        }
    }
}
