//! TOML with the places of all keys and values.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::node::{Entry, Node, Syntax, Value};

/// Reads a text.
///
/// # Errors
///
/// The first thing that is not TOML.
pub fn read(text: &str) -> Result<Node, Syntax> {
    match DeTable::parse(text) {
        Ok(table) => Ok(Node { span: table.span(), value: self::table(table.get_ref())? }),
        Err(error) => {
            let at = error.span().unwrap_or_default();
            Err(Syntax { at, message: error.message().to_string() })
        }
    }
}

fn table(table: &DeTable<'_>) -> Result<Value, Syntax> {
    let mut entries = vec![];
    for (key, value) in table.iter() {
        let (at, key) = (key.span(), key.get_ref().to_string());
        entries.push(Entry { key, at, node: node(value)? });
    }
    // the parser hands them out by name
    entries.sort_by_key(|entry| entry.at.start);
    Ok(Value::Table(entries))
}

/// The parser limits how deep values nest, and with that this recursion.
fn node(value: &Spanned<DeValue<'_>>) -> Result<Node, Syntax> {
    let span = value.span();
    let value = match value.get_ref() {
        DeValue::Boolean(value) => Value::Bool(*value),
        DeValue::String(text) => Value::Text(text.to_string()),
        // a model has no use for dates, and says so when it meets a text
        DeValue::Datetime(date) => Value::Text(date.to_string()),
        DeValue::Integer(integer) => {
            match i128::from_str_radix(integer.as_str(), integer.radix()) {
                Ok(value) => Value::Integer(value),
                Err(_) => return Err(Syntax { at: span, message: "too large a number".into() }),
            }
        }
        DeValue::Float(float) => match float.as_str().parse() {
            Ok(value) => Value::Float(value),
            Err(_) => return Err(Syntax { at: span, message: "not a number".into() }),
        },
        DeValue::Array(list) => Value::List(list.iter().map(node).collect::<Result<_, _>>()?),
        DeValue::Table(inner) => table(inner)?,
    };
    Ok(Node { span, value })
}
