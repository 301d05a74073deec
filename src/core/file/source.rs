//! The text of a file: lines, columns, and how a place in it is shown.

use std::fmt::Write;
use std::ops::Range;

use super::node::Node;
use crate::fault::Place;

/// A text with the name it goes by.
#[derive(Debug, Clone)]
pub struct Source {
    /// The name: the file, as the user wrote its path.
    pub name: String,
    /// The text, without a byte order mark.
    pub text: String,
}

/// A place in a text, with the line that it is in.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Spot {
    /// File, line, column (the character, from 1) and key path.
    pub place: Place,
    /// The line.
    pub line: String,
    /// Characters of the line concerned, at least 1.
    pub width: usize,
}

/// Characters of a line that are shown at most.
const EXCERPT: usize = 100;

impl Source {
    /// The place of some bytes; of more than one line the first is shown.
    pub fn spot(&self, span: Range<usize>, key: &str) -> Spot {
        let text = self.text.as_str();
        let mut start = span.start.min(text.len());
        while !text.is_char_boundary(start) {
            start -= 1;
        }
        let begin = text[..start].rfind('\n').map_or(0, |at| at + 1);
        let line = text[begin..].split('\n').next().unwrap_or_default().trim_end_matches('\r');
        let column = text[begin..start].chars().count();
        let end = span.end.clamp(start, begin + line.len().max(start - begin));
        let width = text.get(start..end).map_or(1, |part| part.chars().count().max(1));
        let place = Place {
            file: Some(self.name.clone()),
            line: Some(text[..begin].matches('\n').count() + 1),
            column: Some(column + 1),
            key: Some(key.to_string()).filter(|key| !key.is_empty()),
        };
        Spot { place, line: line.into(), width }
    }

    /// The place of `length` characters from character `at` of a text value: exact where
    /// the value is written on one line without escapes, else the value's beginning.
    pub fn spot_inside(&self, node: &Node, at: usize, length: usize, key: &str) -> Spot {
        let written = self.text.get(node.span.clone()).unwrap_or_default();
        let inside = ['"', '\''].into_iter().find_map(|quote| {
            let inside = written.strip_prefix(quote)?.strip_suffix(quote)?;
            (Some(inside) == node.text()).then_some(inside)
        });
        let Some(inside) = inside else { return self.spot(node.span.clone(), key) };
        let byte = |character: usize| {
            inside.char_indices().nth(character).map_or(inside.len(), |(byte, _)| byte)
        };
        let first = node.span.start + 1;
        self.spot(first + byte(at)..first + byte(at.saturating_add(length)), key)
    }
}

impl Spot {
    /// A place that is a whole file.
    pub fn file(name: &str) -> Self {
        let place = Place { file: Some(name.into()), ..Place::default() };
        Self { place, line: String::new(), width: 0 }
    }

    /// The line with its number, and carets below what is concerned.
    pub fn excerpt(&self) -> String {
        let (Some(number), Some(column)) = (self.place.line, self.place.column) else {
            return String::new();
        };
        // a window around the place, where the line is long
        let characters = self.line.chars().count();
        let skipped =
            if characters > EXCERPT { (column - 1).saturating_sub(EXCERPT / 2) } else { 0 };
        let excerpt: String = self
            .line
            .chars()
            .skip(skipped)
            .take(EXCERPT)
            .map(|c| if c.is_control() { ' ' } else { c })
            .collect();
        let before = if skipped > 0 { "..." } else { "" };
        let after = if characters > skipped + EXCERPT { "..." } else { "" };
        let indent = before.len() + column - 1 - skipped;
        let width = self.width.clamp(1, EXCERPT - (column - 1 - skipped).min(EXCERPT - 1));
        let margin = " ".repeat(number.to_string().len());
        let mut text = String::new();
        // writing to a string cannot fail
        let _ = writeln!(text, " {number} | {before}{excerpt}{after}");
        let _ = write!(text, " {margin} | {}{}", " ".repeat(indent), "^".repeat(width));
        text
    }
}
