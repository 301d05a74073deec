//! Values of a file turned into types, with the place of the first fault kept.
//!
//! Errors lose their place, and part of what they know, on their way out through boxed
//! models and effects. So the innermost value that a type refuses is noted here at once,
//! and whatever the error has become further out is not looked at.

use std::cell::RefCell;
use std::fmt;
use std::iter::Enumerate;
use std::ops::Range;
use std::slice::Iter;

use serde::Deserialize;
use serde::de::value::{BorrowedStrDeserializer, MapAccessDeserializer};
use serde::de::{self, DeserializeSeed, Deserializer, Expected, MapAccess, SeqAccess, Visitor};
use serde::forward_to_deserialize_any;

use super::complaint::Complaint;
use super::node::{Entry, Node, Value};

/// What is wrong, and where.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// Key path.
    pub key: String,
    /// Bytes concerned.
    pub at: Range<usize>,
    /// What is wrong.
    pub complaint: Complaint,
}

/// Reads a type.
///
/// # Errors
///
/// The first value that it does not take.
pub fn read<'de, T: Deserialize<'de>>(node: &'de Node) -> Result<T, Found> {
    let first = RefCell::new(None);
    let reader = Reader { node, path: Path::Root, first: &first };
    T::deserialize(reader).map_err(|complaint| {
        // what was never noted did not come from a value: it is about the whole
        first.into_inner().unwrap_or(Found { key: String::new(), at: node.span.clone(), complaint })
    })
}

/// The way to a value; the steps are on the stack.
#[derive(Clone, Copy)]
enum Path<'a> {
    Root,
    Key(&'a Path<'a>, &'a str),
    Number(&'a Path<'a>, usize),
}

impl fmt::Display for Path<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Root => Ok(()),
            Self::Key(Self::Root, key) => f.write_str(key),
            Self::Key(before, key) => write!(f, "{before}.{key}"),
            Self::Number(before, number) => write!(f, "{before}[{number}]"),
        }
    }
}

#[derive(Clone, Copy)]
struct Reader<'a, 'de> {
    node: &'de Node,
    path: Path<'a>,
    first: &'a RefCell<Option<Found>>,
}

impl Reader<'_, '_> {
    fn note<T>(
        &self,
        result: Result<T, Complaint>,
        at: &Range<usize>,
        key: Option<&str>,
    ) -> Result<T, Complaint> {
        result.inspect_err(|complaint| {
            let mut first = self.first.borrow_mut();
            if first.is_none() {
                let key = match (key, complaint) {
                    (Some(key), _) => Path::Key(&self.path, key).to_string(),
                    (None, Complaint::MissingKey { key }) => Path::Key(&self.path, key).to_string(),
                    _ => self.path.to_string(),
                };
                *first = Some(Found { key, at: at.clone(), complaint: complaint.clone() });
            }
        })
    }

    fn noted<T>(&self, result: Result<T, Complaint>) -> Result<T, Complaint> {
        self.note(result, &self.node.span, None)
    }
}

impl<'de> Deserializer<'de> for Reader<'_, 'de> {
    type Error = Complaint;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Complaint> {
        let value = match &self.node.value {
            Value::Null => visitor.visit_unit(),
            Value::Bool(value) => visitor.visit_bool(*value),
            Value::Integer(value) => match (i64::try_from(*value), u64::try_from(*value)) {
                (Ok(value), _) => visitor.visit_i64(value),
                (_, Ok(value)) => visitor.visit_u64(value),
                _ => visitor.visit_i128(*value),
            },
            Value::Float(value) => visitor.visit_f64(*value),
            Value::Text(text) => visitor.visit_borrowed_str(text),
            Value::List(list) => {
                let mut rest = list.iter().enumerate();
                let value = visitor.visit_seq(ListReader { of: self, rest: &mut rest });
                match (value, list.len() - rest.len()) {
                    (Ok(_), taken) if taken < list.len() => Err(Complaint::Kind {
                        found: format!("{} entries", list.len()),
                        expected: format!("{taken}"),
                    }),
                    (value, _) => value,
                }
            }
            Value::Table(entries) => {
                let mut rest = entries.iter();
                let table = TableReader { of: self, rest: &mut rest, value: None };
                let value = visitor.visit_map(table);
                // a model, an effect or a choice reads one entry and leaves the others
                if let (Ok(_), Some(second), Some(first)) = (&value, rest.next(), entries.first()) {
                    let (first, second_key) = (first.key.clone(), second.key.clone());
                    let several = Complaint::Several { first, second: second_key };
                    return self.note(Err(several), &second.at, Some(&second.key));
                }
                value
            }
        };
        self.noted(value)
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Complaint> {
        // a model or an effect is named by the only key; which of two is complete is no matter
        let named = (&visitor as &dyn Expected).to_string().starts_with("dyn ");
        if let (true, Value::Table(entries)) = (named, &self.node.value)
            && let [first, second, ..] = entries.as_slice()
        {
            let (first, found) = (first.key.clone(), second.key.clone());
            let several = Complaint::Several { first, second: found };
            return self.note(Err(several), &second.at, Some(&second.key));
        }
        self.deserialize_any(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Complaint> {
        match self.node.value {
            Value::Null => visitor.visit_none(),
            _ => visitor.visit_some(self),
        }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        visitor: V,
    ) -> Result<V::Value, Complaint> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _name: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Complaint> {
        let value = match &self.node.value {
            Value::Text(text) => {
                let read = visitor.visit_enum(BorrowedStrDeserializer::<Complaint>::new(text));
                // a boxed model or effect keeps the words of an error, and not the names there are
                read.map_err(|error| match variants.contains(&text.as_str()) {
                    true => error,
                    false => de::Error::unknown_variant(text, variants),
                })
            }
            Value::Table(entries) if !entries.is_empty() => {
                if let [first, second, ..] = entries.as_slice() {
                    let (first, found) = (first.key.clone(), second.key.clone());
                    let several = Complaint::Several { first, second: found };
                    return self.note(Err(several), &second.at, Some(&second.key));
                }
                let mut rest = entries.iter();
                let table = TableReader { of: self, rest: &mut rest, value: None };
                visitor.visit_enum(MapAccessDeserializer::new(table))
            }
            _ => return self.deserialize_any(visitor),
        };
        self.noted(value)
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit
        unit_struct seq tuple tuple_struct struct identifier ignored_any
    }
}

struct ListReader<'a, 'b, 'de> {
    of: Reader<'a, 'de>,
    rest: &'b mut Enumerate<Iter<'de, Node>>,
}

impl<'de> SeqAccess<'de> for ListReader<'_, '_, 'de> {
    type Error = Complaint;

    fn next_element_seed<T: DeserializeSeed<'de>>(
        &mut self,
        seed: T,
    ) -> Result<Option<T::Value>, Complaint> {
        let Some((number, node)) = self.rest.next() else { return Ok(None) };
        let path = Path::Number(&self.of.path, number);
        let entry = Reader { node, path, first: self.of.first };
        entry.noted(seed.deserialize(entry)).map(Some)
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.rest.len())
    }
}

struct TableReader<'a, 'b, 'de> {
    of: Reader<'a, 'de>,
    rest: &'b mut Iter<'de, Entry>,
    value: Option<&'de Entry>,
}

impl<'de> MapAccess<'de> for TableReader<'_, '_, 'de> {
    type Error = Complaint;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, Complaint> {
        let Some(entry) = self.rest.next() else { return Ok(None) };
        self.value = Some(entry);
        seed.deserialize(KeyReader { of: self.of, entry }).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Complaint> {
        let Some(entry) = self.value.take() else {
            return Err(serde::de::Error::custom("a value was asked for before its key"));
        };
        let path = Path::Key(&self.of.path, &entry.key);
        let value = Reader { node: &entry.node, path, first: self.of.first };
        value.noted(seed.deserialize(value))
    }
}

/// A key; what is wrong with it is noted before a box on the way out turns it into words.
struct KeyReader<'a, 'de> {
    of: Reader<'a, 'de>,
    entry: &'de Entry,
}

impl<'de> Deserializer<'de> for KeyReader<'_, 'de> {
    type Error = Complaint;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Complaint> {
        let key = BorrowedStrDeserializer::<Complaint>::new(&self.entry.key);
        self.of.note(key.deserialize_any(visitor), &self.entry.at, Some(&self.entry.key))
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        name: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Complaint> {
        let key = BorrowedStrDeserializer::<Complaint>::new(&self.entry.key);
        let key = key.deserialize_enum(name, variants, visitor);
        self.of.note(key, &self.entry.at, Some(&self.entry.key))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option
        unit unit_struct newtype_struct seq tuple tuple_struct map struct identifier ignored_any
    }
}
