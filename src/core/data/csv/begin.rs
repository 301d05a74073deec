//! Where the table begins: a line `sep=;`, what a logger writes above it, a row of units.
//!
//! The line of names is the first line that is no comment, as long as a row of numbers
//! follows it. Where none does, the first line further down that holds nothing but text, in
//! as many fields as the two rows of numbers below it, is taken, and that is said. Lines
//! above it with as many fields as itself are no preamble: then the table begins there, and
//! what is wrong with it is reported in its place.

use super::date::Instant;
use super::fields::{is_comment, lines, number, quoted, separator};
use crate::data::table::CellProblem;
use crate::data::unit;
use std::borrow::Cow;

/// Lines that a preamble may have.
const MOST: usize = 200;

/// What was found above the rows.
#[derive(Debug)]
pub struct Begin<'a> {
    /// Number and text of the line of names.
    pub header: (usize, &'a str),
    pub separator: char,
    /// Number of lines that are left out above it.
    pub preamble: usize,
    /// Line and cells of the row of units, if there is one.
    pub units: Option<(usize, Vec<String>)>,
    /// Last comment line above the names.
    pub comment: Option<usize>,
}

/// Finds the beginning; none where there are only blank lines and comments.
pub fn begin(text: &str) -> Option<Begin<'_>> {
    let mut all = lines(text).filter(|(_, line)| !(is_comment(line) || line.trim().is_empty()));
    let mut stated = None;
    let mut head: Vec<(usize, &str)> = Vec::new();
    let first = all.next()?;
    match first.1.trim().trim_matches('"').strip_prefix("sep=") {
        Some(rest) => {
            stated = rest.chars().next().filter(|c| matches!(c, ';' | ',' | '\t'));
            if rest.is_empty() && first.1.contains('\t') {
                stated = Some('\t');
            }
        }
        None => head.push(first),
    }
    if head.is_empty() {
        head.push(all.next()?);
    }
    // two more lines tell in nearly all files that the first is the right one
    head.extend(all.by_ref().take(3));
    let mut at = chosen(&head, stated);
    if at.is_none() {
        head.extend(all.by_ref().take(MOST));
        at = chosen(&head, stated);
    }
    let at = at.unwrap_or(0);
    let header = head[at];
    let separator = stated.unwrap_or_else(|| separator(header.1));
    let units = head.get(at + 1).and_then(|(number, line)| {
        let cells = units(&cells(line, separator)?, count(header.1, separator)?)?;
        Some((*number, cells))
    });
    // a comment below the names says nothing about them
    let comment = lines(text)
        .take_while(|(number, _)| *number < header.0)
        .filter(|(_, line)| is_comment(line))
        .last()
        .map(|(number, _)| number);
    Some(Begin { header, separator, preamble: at, units, comment })
}

/// Index of the line of names.
fn chosen(head: &[(usize, &str)], stated: Option<char>) -> Option<usize> {
    let fits = |at: usize| {
        let separator = stated.unwrap_or_else(|| separator(head[at].1));
        let names = cells(head[at].1, separator)?;
        let text = names.iter().all(|cell| cell.is_empty() || !numeric(cell));
        if !text || names.iter().all(|cell| cell.is_empty()) {
            return None;
        }
        let mut rows = head[at + 1..].iter().filter_map(|(_, line)| cells(line, separator));
        let mut next = rows.next()?;
        if units(&next, names.len()).is_some() {
            next = rows.next()?;
        }
        let row = |cells: &[Cow<'_, str>]| cells.iter().any(|cell| numeric(cell));
        let alike = |cells: &[Cow<'_, str>]| at == 0 || cells.len() == names.len();
        let second = rows.next().is_none_or(|cells| row(&cells) && alike(&cells));
        (row(&next) && second && alike(&next)).then_some(names.len())
    };
    let (at, width) = (0..head.len()).find_map(|at| Some((at, fits(at)?)))?;
    let separator = stated.unwrap_or_else(|| separator(head[at].1));
    let alike =
        head[..at].iter().any(|(_, line)| width > 1 && count(line, separator) == Some(width));
    (!alike).then_some(at)
}

/// Trimmed cells of a line; none where a quote is not closed.
fn cells(line: &str, separator: char) -> Option<Vec<Cow<'_, str>>> {
    let mut cells = quoted(line, separator).ok()?;
    for cell in &mut cells {
        if cell.trim().len() != cell.len() {
            *cell = Cow::Owned(cell.trim().to_owned());
        }
    }
    Some(cells)
}

fn count(line: &str, separator: char) -> Option<usize> {
    cells(line, separator).map(|cells| cells.len())
}

/// A number, with a point or a comma, a missing one or an instant.
fn numeric(cell: &str) -> bool {
    !matches!(number(cell), Err(CellProblem::Text)) || Instant::parse(cell).is_some()
}

/// The units in a row of them: no numbers, known units or texts in brackets, at least one.
fn units(cells: &[Cow<'_, str>], width: usize) -> Option<Vec<String>> {
    if cells.len() > width {
        return None;
    }
    let mut any = false;
    let mut found = Vec::with_capacity(cells.len());
    for cell in cells {
        let pairs = [('[', ']'), ('(', ')')];
        let inner =
            pairs.iter().find_map(|(open, close)| cell.strip_prefix(*open)?.strip_suffix(*close));
        let good = cell.is_empty() || (inner.is_some() || unit::known(cell));
        if !good || cell.parse::<f64>().is_ok() {
            return None;
        }
        any |= !cell.is_empty() && &**cell != "-";
        found.push(inner.unwrap_or(cell).trim().to_owned());
    }
    any.then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(text: &str) -> (usize, char, usize, Option<usize>) {
        let begin = begin(text).unwrap();
        (begin.header.0, begin.separator, begin.preamble, begin.units.map(|(line, _)| line))
    }

    #[test]
    fn plain_tables_begin_at_once() {
        assert_eq!(found("a,b\n1,2\n"), (1, ',', 0, None));
        assert_eq!(found("# c\n\na;b\n1;2\n3;4"), (3, ';', 0, None));
        assert_eq!(found("a\n1\n2\n"), (1, ',', 0, None));
        assert_eq!(found("a,note,b\n1,start,2\n3,,4\n"), (1, ',', 0, None));
        assert_eq!(found("a,b\n"), (1, ',', 0, None));
        // what is wrong stays in its place
        assert_eq!(found("a,b\nabc,x\n1,2\n1,2\n"), (1, ',', 0, None));
        assert_eq!(found("1,2\n3,4\n"), (1, ',', 0, None));
        assert!(begin("\n# only\n").is_none());
    }

    #[test]
    fn a_separator_may_be_stated() {
        assert_eq!(found("sep=;\na;b\n1;2\n"), (2, ';', 0, None));
        assert_eq!(found("\"sep=,\"\na,b\n1,2\n"), (2, ',', 0, None));
    }

    #[test]
    fn units_may_stand_below_the_names() {
        assert_eq!(found("t;F;x\ns;N;mm\n0;1;2\n1;1;2\n"), (1, ';', 0, Some(2)));
        assert_eq!(found("t,n\n[s],(turns)\n0,1\n"), (1, ',', 0, Some(2)));
        assert_eq!(found("t,F\nNA,x\n0,1\n"), (1, ',', 0, None));
    }

    #[test]
    fn a_preamble_is_left_out() {
        let logger = "Logger 5000\nDate: 2026-05-01\nRate,100,Hz\n\ntime,F\n0,1\n0.1,2\n";
        assert_eq!(found(logger), (5, ',', 3, None));
        let tabs = "Channel list\nserial no. 12;x\ntime\tF\ns\tN\n0,1\t1,5\n0,2\t1,5\n";
        assert_eq!(found(tabs), (3, '\t', 2, Some(4)));
    }
}
