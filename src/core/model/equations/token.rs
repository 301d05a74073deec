//! The words of an expression.

use std::fmt;

/// One word.
#[derive(Debug, Clone, PartialEq)]
pub enum Token {
    /// A number.
    Number(f64),
    /// A name.
    Name(String),
    /// `+`.
    Plus,
    /// `-`.
    Minus,
    /// `*`.
    Star,
    /// `/`.
    Slash,
    /// `^`.
    Caret,
    /// `(`.
    Open,
    /// `)`.
    Close,
    /// `,`.
    Comma,
    /// The end of the text.
    End,
}

impl fmt::Display for Token {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = match self {
            Self::Number(value) => return write!(f, "the number {value}"),
            Self::Name(name) => return write!(f, "`{name}`"),
            Self::End => return f.write_str("the end"),
            Self::Plus => '+',
            Self::Minus => '-',
            Self::Star => '*',
            Self::Slash => '/',
            Self::Caret => '^',
            Self::Open => '(',
            Self::Close => ')',
            Self::Comma => ',',
        };
        write!(f, "`{sign}`")
    }
}
