//! Units in the headers of other programs: `torque (N m)`, `torque/N m`, `torque in N m`.
//!
//! The quotient notation `t/s` is that of ISO 80000-1, 7.1; parentheses are what
//! spreadsheets and loggers write. A text counts as a unit only where all its symbols are
//! known, so that `level (left)` and `a/b` stay names.

use super::product::Product;

/// Whether a text is a product of known unit symbols, or `-`.
pub fn known(text: &str) -> bool {
    let text = text.trim();
    text == "-" || Product::parse(text).is_some_and(|unit| unit.known && unit.symbols > 0)
}

/// Name and unit of a header in one of the other spellings; none where it is in none.
pub fn spelt(text: &str) -> Option<(String, String)> {
    let text = text.trim();
    let bracketed = text.strip_suffix(')').and_then(|opened| {
        // the parenthesis that is closed last, which may hold others: `speed (m/(s))`
        let mut depth = 1_usize;
        for (at, c) in opened.char_indices().rev() {
            match c {
                ')' => depth += 1,
                '(' if depth == 1 => return Some((&opened[..at], &opened[at + 1..])),
                '(' => depth -= 1,
                _ => {}
            }
        }
        None
    });
    let divided = || text.split_once('/');
    let worded = || text.rsplit_once(" in ");
    let good = |(name, unit): &(&str, &str)| {
        let name = name.trim();
        !name.is_empty() && !name.ends_with('/') && known(unit)
    };
    let (name, unit) = bracketed
        .filter(good)
        .or_else(|| divided().filter(good))
        .or_else(|| worded().filter(good))?;
    let unit = unit.trim();
    let unit = match unit.strip_prefix('(').and_then(|unit| unit.strip_suffix(')')) {
        Some(inner) if !inner.contains(['(', ')']) => inner.trim(),
        _ => unit,
    };
    Some((name.trim().into(), unit.into()))
}
