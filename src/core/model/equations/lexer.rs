//! Lexical analysis: a text cut into the words of an expression (Aho, Sethi and Ullman, ch. 3).

use super::error::Located;
use super::problem::Problem;
use super::token::Token;

/// Whether a name may begin with this character.
fn begins_name(c: char) -> bool {
    c.is_alphabetic() || c == '_'
}

/// Whether a name may go on with this character.
fn continues_name(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Whether a text can be used as a name in expressions.
pub fn is_name(text: &str) -> bool {
    text.chars().next().is_some_and(begins_name) && text.chars().all(continues_name)
}

/// Cuts a text into words, each with the character at which it begins, from 0; the last
/// one is [`Token::End`].
///
/// # Errors
///
/// A character without a meaning, or digits that are no number.
pub fn tokens(text: &str) -> Result<Vec<(Token, usize)>, Located> {
    let text: Vec<char> = text.chars().collect();
    let mut tokens = vec![];
    let mut at = 0;
    while let Some(&c) = text.get(at) {
        let begin = at;
        at += 1;
        let token = match c {
            c if c.is_whitespace() => continue,
            '+' => Token::Plus,
            '-' => Token::Minus,
            '*' => Token::Star,
            '/' => Token::Slash,
            '^' => Token::Caret,
            '(' => Token::Open,
            ')' => Token::Close,
            ',' => Token::Comma,
            c if c.is_ascii_digit() || c == '.' => {
                at = number_end(&text, begin);
                let found: String = text[begin..at].iter().collect();
                match found.parse::<f64>() {
                    Ok(value) if value.is_finite() => Token::Number(value),
                    _ => return Err(Located::new(begin, at - begin, Problem::Number { found })),
                }
            }
            c if begins_name(c) => {
                at += text[at..].iter().take_while(|c| continues_name(**c)).count();
                Token::Name(text[begin..at].iter().collect())
            }
            found => return Err(Located::new(begin, 1, Problem::Character { found })),
        };
        tokens.push((token, begin));
    }
    tokens.push((Token::End, text.len()));
    Ok(tokens)
}

/// Where the digits, points and exponent that begin at `at` end.
fn number_end(text: &[char], mut at: usize) -> usize {
    let digits = |from: usize| {
        text[from.min(text.len())..].iter().take_while(|c| c.is_ascii_digit() || **c == '.').count()
    };
    at += digits(at);
    if matches!(text.get(at), Some('e' | 'E')) {
        let sign = usize::from(matches!(text.get(at + 1), Some('+' | '-')));
        if text.get(at + 1 + sign).is_some_and(char::is_ascii_digit) {
            at += 1 + sign;
            at += digits(at);
        }
    }
    at
}
