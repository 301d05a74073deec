//! The header of an `.npy` file: a Python literal with the type, the order and the shape.

/// A type and where it belongs: the whole array, or a named field of its elements.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// Empty for the whole array.
    pub name: String,
    /// NumPy's letter: `f`, `i`, `u`, `b`, `M`, `m`, `c`, `O`, `S`, `U`, `V`.
    pub kind: char,
    /// Bytes of one number.
    pub size: usize,
    pub big: bool,
    /// Shape within one element.
    pub shape: Vec<usize>,
    /// Seconds in a tick of an instant or a span of time.
    pub second: Option<f64>,
}

impl Field {
    /// Bytes in one element; saturates where they cannot be counted.
    pub fn bytes(&self) -> usize {
        self.shape.iter().fold(self.size, |product, n| product.saturating_mul(*n))
    }

    /// A type such as `<f8`, `|S12`, `<M8[ns]`.
    fn parse(name: String, text: &str, shape: Vec<usize>) -> Option<Self> {
        let big = text.starts_with('>');
        let plain = text.strip_prefix(['<', '>', '|', '=']).unwrap_or(text);
        let kind = plain.chars().next().filter(char::is_ascii_alphabetic)?;
        let (size, unit) = match plain[1..].split_once('[') {
            Some((size, unit)) => (size, unit.strip_suffix(']')?),
            None => (&plain[1..], ""),
        };
        let size: usize = if kind == 'O' { 8 } else { size.parse().ok()? };
        // text of wide characters has four bytes each
        let size = if kind == 'U' { size.checked_mul(4)? } else { size };
        let known: &[usize] = match kind {
            'f' => &[2, 4, 8, 12, 16],
            'i' | 'u' => &[1, 2, 4, 8],
            'b' => &[1],
            'M' | 'm' => &[8],
            _ => &[],
        };
        if !(known.is_empty() || known.contains(&size)) {
            return None;
        }
        let timed = matches!(kind, 'M' | 'm');
        let second = if timed { Some(tick(unit)?) } else { None };
        Some(Self { name, kind, size, big, shape, second })
    }
}

/// Seconds in a unit such as `ns` or `25us`.
fn tick(unit: &str) -> Option<f64> {
    let digits = unit.len() - unit.trim_start_matches(|c: char| c.is_ascii_digit()).len();
    let count: f64 = if digits == 0 { 1.0 } else { unit[..digits].parse().ok()? };
    let one = match &unit[digits..] {
        "D" => 86_400.0,
        "h" => 3600.0,
        "m" => 60.0,
        "s" => 1.0,
        "ms" => 1e-3,
        "us" | "μs" => 1e-6,
        "ns" => 1e-9,
        "ps" => 1e-12,
        _ => return None,
    };
    Some(count * one)
}

/// What the header says.
#[derive(Debug, PartialEq)]
pub struct Header {
    pub fields: Vec<Field>,
    pub fortran: bool,
    pub shape: Vec<usize>,
}

impl Header {
    pub fn parse(text: &str) -> Option<Self> {
        let mut reader = Reader { rest: text.trim(), depth: 0 };
        let Literal::Map(pairs) = reader.literal()? else { return None };
        if !reader.rest.is_empty() {
            return None;
        }
        let get = |key: &str| pairs.iter().find(|(k, _)| k == key).map(|(_, value)| value);
        let Literal::Truth(fortran) = *get("fortran_order")? else { return None };
        let shape = get("shape")?.sizes()?;
        let fields = match get("descr")? {
            Literal::Text(text) => vec![Field::parse(String::new(), text, vec![])?],
            Literal::List(items) => items.iter().map(Literal::field).collect::<Option<Vec<_>>>()?,
            _ => return None,
        };
        Some(Self { fields, fortran, shape })
    }
}

/// A Python literal.
#[derive(Debug, PartialEq)]
enum Literal {
    Text(String),
    Whole(usize),
    Truth(bool),
    /// A list or a tuple.
    List(Vec<Literal>),
    Map(Vec<(String, Literal)>),
}

impl Literal {
    fn sizes(&self) -> Option<Vec<usize>> {
        let Self::List(items) = self else { return None };
        let size = |item: &Self| if let Self::Whole(n) = item { Some(*n) } else { None };
        items.iter().map(size).collect()
    }

    /// `('name', '<f8')` or `('name', '<f8', (2,))`; a name may have a title before it.
    fn field(&self) -> Option<Field> {
        let Self::List(parts) = self else { return None };
        let (Self::Text(name), Self::Text(descr)) = (parts.first()?.name()?, parts.get(1)?) else {
            return None;
        };
        let shape = match parts.get(2) {
            None => vec![],
            Some(Self::Whole(n)) => vec![*n],
            Some(list) => list.sizes()?,
        };
        Field::parse(name.clone(), descr, shape)
    }

    fn name(&self) -> Option<&Self> {
        match self {
            Self::List(pair) => pair.last(),
            own => Some(own),
        }
    }
}

struct Reader<'a> {
    rest: &'a str,
    depth: usize,
}

impl Reader<'_> {
    fn skip(&mut self, c: char) -> bool {
        self.rest = self.rest.trim_start();
        let found = self.rest.strip_prefix(c);
        self.rest = found.unwrap_or(self.rest).trim_start();
        found.is_some()
    }

    fn literal(&mut self) -> Option<Literal> {
        self.depth += 1;
        if self.depth > 8 {
            return None;
        }
        self.rest = self.rest.trim_start();
        let first = self.rest.chars().next()?;
        let value = match first {
            '{' => {
                self.skip('{');
                let mut pairs = vec![];
                while !self.skip('}') {
                    let Literal::Text(key) = self.literal()? else { return None };
                    if !self.skip(':') {
                        return None;
                    }
                    pairs.push((key, self.literal()?));
                    if !self.skip(',') && !self.rest.starts_with('}') {
                        return None;
                    }
                }
                Literal::Map(pairs)
            }
            '(' | '[' => {
                let close = if first == '(' { ')' } else { ']' };
                self.skip(first);
                let mut items = vec![];
                while !self.skip(close) {
                    items.push(self.literal()?);
                    if !self.skip(',') && !self.rest.starts_with(close) {
                        return None;
                    }
                }
                Literal::List(items)
            }
            '\'' | '"' => {
                let (text, rest) = self.rest[1..].split_once(first)?;
                self.rest = rest;
                Literal::Text(text.to_owned())
            }
            _ => {
                let end = self.rest.find(|c: char| !c.is_ascii_alphanumeric());
                let (word, rest) = self.rest.split_at(end.unwrap_or(self.rest.len()));
                self.rest = rest;
                match word {
                    "True" => Literal::Truth(true),
                    "False" => Literal::Truth(false),
                    // Python 2 wrote `5L`
                    _ => Literal::Whole(word.strip_suffix('L').unwrap_or(word).parse().ok()?),
                }
            }
        };
        self.rest = self.rest.trim_start();
        self.depth -= 1;
        Some(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_are_read() {
        let text = "{'descr': '<f8', 'fortran_order': False, 'shape': (3L, 2), }   \n";
        let header = Header::parse(text).unwrap();
        assert_eq!((header.shape.as_slice(), header.fields[0].size), (&[3, 2][..], 8));
        let fields = "{'descr': [('a', '<f4'), (('title', 'b'), '<i2', (2, 2))], 'fortran_order': True, 'shape': ()}";
        let header = Header::parse(fields).unwrap();
        assert_eq!((header.fields[1].name.as_str(), header.fields[1].bytes()), ("b", 8));
        assert!(header.fortran && header.shape.is_empty());
    }

    #[test]
    fn nonsense_is_none() {
        for text in [
            "",
            "{",
            "{'descr': '<f8'}",
            "{'a' 1}",
            "((((((((((1",
            "{'descr': '<f3', 'fortran_order': False, 'shape': (1,)}",
            "{'descr': 'é8', 'fortran_order': False, 'shape': (1,)}",
        ] {
            assert_eq!(Header::parse(text), None, "{text}");
        }
    }
}
