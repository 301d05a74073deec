//! JSON with the places of all keys and values.

use super::node::{Entry, Node, Syntax, Value};

/// How many lists and tables may stand within each other.
const DEPTH: usize = 100;

/// Reads a text.
///
/// # Errors
///
/// The first thing that is not JSON; a key that a table has twice.
pub fn read(text: &str) -> Result<Node, Syntax> {
    let mut walker = Walker { text, at: 0, depth: 0 };
    let root = walker.value()?;
    walker.blanks();
    if walker.at < text.len() { Err(walker.fault("expected the end")) } else { Ok(root) }
}

struct Walker<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
}

impl Walker<'_> {
    fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    fn blanks(&mut self) {
        while matches!(self.peek(), Some(b' ' | b'\t' | b'\r' | b'\n')) {
            self.at += 1;
        }
    }

    fn fault(&self, message: &str) -> Syntax {
        let length = self.text[self.at..].chars().next().map_or(0, char::len_utf8);
        Syntax { at: self.at..self.at + length, message: message.into() }
    }

    fn takes(&mut self, wanted: u8) -> bool {
        self.blanks();
        let found = self.peek() == Some(wanted);
        self.at += usize::from(found);
        found
    }

    fn value(&mut self) -> Result<Node, Syntax> {
        self.blanks();
        let start = self.at;
        let value = match self.peek() {
            Some(b'{') => self.within(Self::table)?,
            Some(b'[') => self.within(Self::list)?,
            Some(b'"') => Value::Text(self.string()?),
            _ => self.word()?,
        };
        Ok(Node { span: start..self.at, value })
    }

    fn within(&mut self, read: fn(&mut Self) -> Result<Value, Syntax>) -> Result<Value, Syntax> {
        self.depth += 1;
        if self.depth > DEPTH {
            return Err(self.fault("too many lists and tables within each other"));
        }
        self.at += 1;
        let value = read(self)?;
        self.depth -= 1;
        Ok(value)
    }

    fn list(&mut self) -> Result<Value, Syntax> {
        let mut list = vec![];
        if self.takes(b']') {
            return Ok(Value::List(list));
        }
        loop {
            list.push(self.value()?);
            if self.takes(b']') {
                return Ok(Value::List(list));
            }
            if !self.takes(b',') {
                return Err(self.fault("expected `,` or `]`"));
            }
        }
    }

    fn table(&mut self) -> Result<Value, Syntax> {
        let mut entries: Vec<Entry> = vec![];
        if self.takes(b'}') {
            return Ok(Value::Table(entries));
        }
        loop {
            self.blanks();
            let start = self.at;
            if self.peek() != Some(b'"') {
                return Err(self.fault("expected a key in quotes"));
            }
            let key = self.string()?;
            let at = start..self.at;
            if entries.iter().any(|entry| entry.key == key) {
                return Err(Syntax { at, message: "duplicate key".into() });
            }
            if !self.takes(b':') {
                return Err(self.fault("expected `:`"));
            }
            let node = self.value()?;
            entries.push(Entry { key, at, node });
            if self.takes(b'}') {
                return Ok(Value::Table(entries));
            }
            if !self.takes(b',') {
                return Err(self.fault("expected `,` or `}`"));
            }
        }
    }

    /// A text in quotes, which end it unless they are escaped; its escapes are left to the
    /// JSON library.
    fn string(&mut self) -> Result<String, Syntax> {
        let start = self.at;
        let bytes = self.text.as_bytes();
        let mut end = start + 1;
        while let Some(byte) = bytes.get(end) {
            match byte {
                b'"' => break,
                b'\\' => end += 2,
                _ => end += 1,
            }
        }
        // an escaped character of several bytes may have been stepped into
        let written = self.text.get(start..=end).unwrap_or_default();
        let Ok(text) = serde_json::from_str(written) else {
            let line = self.text[start..].find('\n').map_or(self.text.len(), |at| start + at);
            let end = if end < line { end + 1 } else { line };
            let message = "not a text: an escape is wrong or the closing quote missing".into();
            return Err(Syntax { at: start..end, message });
        };
        self.at = end + 1;
        Ok(text)
    }

    /// A number, `true`, `false` or `null`.
    fn word(&mut self) -> Result<Value, Syntax> {
        let rest = &self.text[self.at..];
        let length = rest
            .find(|c: char| !(c.is_ascii_alphanumeric() || matches!(c, '+' | '-' | '.')))
            .unwrap_or(rest.len());
        let word = &rest[..length];
        let value = match word {
            "" => return Err(self.fault("expected a value")),
            "null" => Value::Null,
            "true" => Value::Bool(true),
            "false" => Value::Bool(false),
            // the JSON library knows which forms are numbers
            _ => {
                match (serde_json::from_str::<serde_json::Number>(word), word.parse(), word.parse())
                {
                    (Ok(_), Ok(value), _) => Value::Integer(value),
                    (Ok(_), _, Ok(value)) => Value::Float(value),
                    _ => {
                        let message = format!("`{word}` is not a value");
                        return Err(Syntax { at: self.at..self.at + length, message });
                    }
                }
            }
        };
        self.at += length;
        Ok(value)
    }
}
