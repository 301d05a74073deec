//! Lines, fields and numbers of CSV text.

use crate::data::error::is_beyond;
use crate::data::table::CellProblem;
use std::borrow::Cow;

const SEPARATORS: [char; 3] = [';', '\t', ','];

/// The lines with their numbers from 1, whichever system wrote their ends.
pub(super) fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let end = if text.contains('\n') { '\n' } else { '\r' };
    let numbered = text.split(end).enumerate();
    numbered.map(|(k, line)| (k + 1, line.strip_suffix('\r').unwrap_or(line)))
}

pub(super) fn is_comment(line: &str) -> bool {
    line.trim_start().starts_with('#')
}

/// The separator that occurs most in the header, outside quotes and units.
pub(super) fn separator(header: &str) -> char {
    let mut counts = [0_usize; SEPARATORS.len()];
    let (mut in_quotes, mut in_unit) = (false, false);
    for c in header.chars() {
        match c {
            '"' => in_quotes = !in_quotes,
            '[' => in_unit = true,
            ']' => in_unit = false,
            _ if in_quotes || in_unit => {}
            _ => {
                if let Some(k) = SEPARATORS.iter().position(|s| *s == c) {
                    counts[k] += 1;
                }
            }
        }
    }
    // of equals the first, and a comma where there is none at all
    let most = counts.iter().max().copied().unwrap_or(0);
    let chosen = SEPARATORS.iter().zip(counts).find(|(_, count)| most > 0 && *count == most);
    chosen.map_or(',', |(separator, _)| *separator)
}

/// The fields of a line, of which some may stand in quotes. The error is the column of a
/// quote that is not closed.
pub(super) fn quoted(line: &str, separator: char) -> Result<Vec<Cow<'_, str>>, usize> {
    let mut fields = Vec::new();
    let mut rest = line;
    loop {
        let start = rest.trim_start_matches(' ');
        let (field, after) = if let Some(inside) = start.strip_prefix('"') {
            let mut end = 0;
            // a doubled quote stands for one quote
            loop {
                end += inside[end..].find('"').ok_or(fields.len() + 1)?;
                if !inside[end + 1..].starts_with('"') {
                    break;
                }
                end += 2;
            }
            let after = &inside[end + 1..];
            let tail = after.find(separator).unwrap_or(after.len());
            let text = inside[..end].replace("\"\"", "\"") + after[..tail].trim_end();
            (Cow::Owned(text), &after[tail..])
        } else {
            let end = rest.find(separator).unwrap_or(rest.len());
            (Cow::Borrowed(&rest[..end]), &rest[end..])
        };
        fields.push(field);
        match after.strip_prefix(separator) {
            Some(next) => rest = next,
            None => return Ok(fields),
        }
    }
}

/// The number in a trimmed cell; an empty cell and NaN are a missing value.
pub(super) fn number(field: &str) -> Result<f64, CellProblem> {
    if field.is_empty() {
        return Ok(f64::NAN);
    }
    match field.parse::<f64>() {
        Ok(value) if is_beyond(value) => Err(CellProblem::Infinite),
        Ok(value) => Ok(value),
        Err(_) => {
            // 1,5 as well as 1,234.5: a comma has no place in a number
            let comma = field.contains(',') && field.replace(',', "").parse::<f64>().is_ok();
            Err(if comma { CellProblem::DecimalComma } else { CellProblem::Text })
        }
    }
}

/// The number in a trimmed cell with one decimal comma and no other mark: `-1,5e3`.
pub(super) fn with_comma(field: &str) -> Option<f64> {
    let (whole, rest) = field.split_once(',')?;
    let digits = rest.starts_with(|c: char| c.is_ascii_digit());
    if !digits || rest.contains(',') || whole.contains(['.', 'e', 'E']) || rest.contains('.') {
        return None;
    }
    format!("{whole}.{rest}").parse().ok().filter(|value: &f64| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_separator_is_the_one_that_occurs_most() {
        assert_eq!(separator("a,b"), ',');
        assert_eq!(separator("a;b"), ';');
        assert_eq!(separator("a\tb"), '\t');
        assert_eq!(separator("a [N,m];b [x,y,z]"), ';');
        assert_eq!(separator("\"a;b;c\",d"), ',');
        assert_eq!(separator("alone"), ',');
    }

    #[test]
    fn quotes_hold_separators_and_doubled_quotes() {
        let fields = |line| quoted(line, ',').map(|f| f.join("|"));
        assert_eq!(fields("\"a,b\",c").as_deref(), Ok("a,b|c"));
        assert_eq!(fields("\"a \"\"b\"\"\", \"c\" ,").as_deref(), Ok("a \"b\"|c|"));
        assert_eq!(fields("a,\"b"), Err(2));
    }

    #[test]
    fn cells_are_numbers_missing_or_wrong() {
        assert_eq!(number("-1.5e-3"), Ok(-1.5e-3));
        for missing in ["", "NaN", "nan", "NAN", "-nan"] {
            assert!(number(missing).is_ok_and(f64::is_nan), "{missing}");
        }
        assert_eq!(number("Inf"), Err(CellProblem::Infinite));
        assert_eq!(number("1e999"), Err(CellProblem::Infinite));
        assert_eq!(number("1,5"), Err(CellProblem::DecimalComma));
        assert_eq!(number("1,234.5"), Err(CellProblem::DecimalComma));
        assert_eq!(number("NA"), Err(CellProblem::Text));
        assert_eq!(with_comma("-1,5e3"), Some(-1500.0));
        assert_eq!(with_comma(",25"), Some(0.25));
        for text in ["1.234,5", "1,234.5", "1,2,3", "1,", "1,x", "1e5,2", "1,e5"] {
            assert_eq!(with_comma(text), None, "{text}");
        }
    }
}
