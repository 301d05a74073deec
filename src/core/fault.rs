//! How errors explain themselves: what kind, at which place, and what to try.
//!
//! Every typed error of the library implements [`Explain`]. Its `Display` text says what
//! was found; the program adds [`Explain::place`] and [`Explain::hint`] on its own lines
//! or as fields of the JSON document, and a library user gets all of it in one piece
//! from [`render`].

use serde::Serialize;
use std::fmt;

/// Who has to act, which is also what the program's exit status says.
///
/// Serialises as `call`, `input` or `work`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
#[doc(hidden)]
pub enum Kind {
    /// The call is wrong: an argument, an option, a length.
    Call,
    /// A file handed in is wrong or cannot be read.
    Input,
    /// Call and input are right, the work itself failed.
    Work,
}

impl Kind {
    /// Exit status of the program: 2, 2 or 1.
    pub fn exit_status(self) -> u8 {
        match self {
            Self::Call | Self::Input => 2,
            Self::Work => 1,
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Call => "call",
            Self::Input => "input",
            Self::Work => "work",
        })
    }
}

/// Where a fault is. Whatever does not apply is `None`.
///
/// Its `Display` text is one phrase (press.csv, line 12, column 3, `force`), or nothing
/// where the place is empty.
#[doc(hidden)]
#[derive(Debug, Clone, Default, PartialEq, Eq, Hash, Serialize)]
pub struct Place {
    /// The file, as the user wrote its path.
    pub file: Option<String>,
    /// Line in the file, from 1.
    pub line: Option<usize>,
    /// Column from 1: the field of a table's line, the character of any other file's.
    pub column: Option<usize>,
    /// Name of the table's column, or key path in a model or configuration file.
    pub key: Option<String>,
}

impl Place {
    /// The place followed by `: `, or nothing where the place is empty: the beginning of
    /// an error's message.
    ///
    /// ```
    /// use lacuna::fault::Place;
    ///
    /// let place = Place { file: Some("press.csv".into()), line: Some(12), ..Place::default() };
    /// assert_eq!(place.lead(), "press.csv, line 12: ");
    /// assert_eq!(Place::default().lead(), "");
    /// ```
    pub fn lead(&self) -> String {
        let place = self.to_string();
        if place.is_empty() { place } else { place + ": " }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parts = [
            self.file.clone(),
            self.line.map(|line| format!("line {line}")),
            self.column.map(|column| format!("column {column}")),
            self.key.as_ref().map(|key| format!("`{key}`")),
        ];
        f.write_str(&parts.into_iter().flatten().collect::<Vec<_>>().join(", "))
    }
}

/// An error that says who has to act, where, and what to try.
pub trait Explain: std::error::Error {
    /// Who has to act.
    fn kind(&self) -> Kind;

    /// Where the fault is; empty by default.
    fn place(&self) -> Place {
        Place::default()
    }

    /// What to try, one sentence without a capital or full stop; none by default.
    fn hint(&self) -> Option<String> {
        None
    }
}

/// The message and, where there is one, the hint on a second line.
///
/// ```
/// use lacuna::data::Record;
/// use lacuna::fault::render;
///
/// let error = Record::csv("no/such/file.csv").unwrap_err();
/// assert!(render(&error).starts_with("no/such/file.csv: cannot be read"));
/// assert!(render(&error).contains("\n  try: "));
/// ```
#[doc(hidden)]
pub fn render(error: &dyn Explain) -> String {
    match error.hint() {
        Some(hint) => format!("{error}\n  try: {hint}"),
        None => error.to_string(),
    }
}

/// The known name that was probably meant by `wanted`, or none if nothing is near.
///
/// A name is near when it differs only in case, when at most a third of its characters
/// were mistyped (Damerau-Levenshtein: changed, added, left out or swapped with the
/// neighbour), or when it has the same beginning and most of the same letters
/// (Jaro-Winkler of at least 0.85). The nearest wins, the first of equals.
///
/// ```
/// use lacuna::fault::nearest;
///
/// let known = ["force", "position", "velocity"];
/// assert_eq!(nearest("postion", known.into_iter()).as_deref(), Some("position"));
/// assert_eq!(nearest("Force", known.into_iter()).as_deref(), Some("force"));
/// assert_eq!(nearest("temperature", known.into_iter()), None);
/// ```
#[doc(hidden)]
pub fn nearest<'a>(wanted: &str, known: impl Iterator<Item = &'a str>) -> Option<String> {
    let lower = wanted.to_lowercase();
    let mut best: Option<((bool, usize, f64), &str)> = None;
    for name in known {
        let candidate = name.to_lowercase();
        let mistyped = strsim::damerau_levenshtein(&lower, &candidate);
        let likeness = strsim::jaro_winkler(&lower, &candidate);
        // one letter may be wrong in two, two in five: `u` never suggests `y`
        let allowed = (lower.chars().count().max(candidate.chars().count()) + 1) / 3;
        let close = mistyped <= allowed;
        if !close && likeness < 0.85 {
            continue;
        }
        let score = (!close, if close { mistyped } else { 0 }, -likeness);
        if best.is_none_or(|(other, _)| score < other) {
            best = Some((score, name));
        }
    }
    best.map(|(_, name)| name.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_serialise_and_exit_as_the_contract_says() {
        for (kind, text, status) in
            [(Kind::Call, "call", 2), (Kind::Input, "input", 2), (Kind::Work, "work", 1)]
        {
            assert_eq!(serde_json::to_value(kind).unwrap(), text);
            assert_eq!(kind.to_string(), text);
            assert_eq!(kind.exit_status(), status);
        }
    }

    #[test]
    fn a_place_reads_as_one_phrase() {
        let place = Place {
            file: Some("a.csv".into()),
            line: Some(3),
            column: Some(2),
            key: Some("force".into()),
        };
        assert_eq!(place.to_string(), "a.csv, line 3, column 2, `force`");
    }

    #[test]
    fn nearest_knows_swaps_beginnings_and_strangers() {
        let known = ["u", "y", "angle", "coulomb_friction", "angle_rate"];
        let near = |wanted| nearest(wanted, known.into_iter());
        assert_eq!(near("anlge").as_deref(), Some("angle"));
        assert_eq!(near("coulomb").as_deref(), Some("coulomb_friction"));
        assert_eq!(near("Y").as_deref(), Some("y"));
        assert_eq!(near("x"), None);
        assert_eq!(near("pressure"), None);
        assert_eq!(nearest("u", std::iter::empty()), None);
    }
}
