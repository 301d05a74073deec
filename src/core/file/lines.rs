//! The layout of a model file in TOML.

use std::fmt::Write;

use serde_json::{Map, Value};

/// Columns that a line may have before a list is broken into one entry per line.
const WIDTH: usize = 100;

/// The text of a model file: comments, sampling, `[model.<name>]`, `[[effects]]`.
pub fn model_file(tables: &Map<String, Value>, header: &[String]) -> String {
    let mut text = String::new();
    for line in header.iter().flat_map(|entry| entry.lines()) {
        let line: String = line.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        line_of(&mut text, format_args!("{}", format!("# {line}").trim_end()));
    }
    if !header.is_empty() {
        text.push('\n');
    }
    for (key, value) in tables {
        match (key.as_str(), value) {
            ("model", Value::Object(model)) => {
                for (name, value) in model {
                    table(&mut text, &format!("model.{}", self::key(name)), value);
                }
            }
            ("effect", Value::Object(declared)) => {
                for (name, value) in declared {
                    let Value::Object(entries) = value else { continue };
                    line_of(&mut text, format_args!("\n[effect.{}]", self::key(name)));
                    entries.iter().for_each(|(key, value)| entry(&mut text, key, value));
                }
            }
            ("effects", Value::Array(effects)) => effects.iter().for_each(|entry| {
                effect(&mut text, entry);
            }),
            _ => entry(&mut text, key, value),
        }
    }
    text.trim_start_matches('\n').to_string()
}

/// A line; writing to a string cannot fail.
fn line_of(text: &mut String, line: std::fmt::Arguments<'_>) {
    let _ = writeln!(text, "{line}");
}

/// A table with its header. A table within it that names one other table is a model
/// within the model, and gets a header of its own.
fn table(text: &mut String, path: &str, value: &Value) {
    let Value::Object(entries) = value else {
        return entry(text, path, value);
    };
    let within = |value: &Value| match value {
        Value::Object(one) if one.len() == 1 => one.values().all(Value::is_object),
        _ => false,
    };
    if entries.is_empty() || entries.values().any(|value| !within(value)) {
        line_of(text, format_args!("\n[{path}]"));
    }
    for (key, value) in entries.iter().filter(|(_, value)| !within(value)) {
        entry(text, key, value);
    }
    for (key, value) in entries.iter().filter(|(_, value)| within(value)) {
        let Value::Object(one) = value else { continue };
        for (name, value) in one {
            table(text, &format!("{path}.{}.{}", self::key(key), self::key(name)), value);
        }
    }
}

/// One entry of `[[effects]]`, with the effect itself on one line.
fn effect(text: &mut String, value: &Value) {
    line_of(text, format_args!("\n[[effects]]"));
    let Value::Object(entries) = value else { return };
    for (key, value) in entries {
        match value {
            Value::Object(one) if key == "effect" && one.len() == 1 => {
                for (name, value) in one {
                    line_of(text, format_args!("effect.{} = {}", self::key(name), inline(value)));
                }
            }
            _ => line_of(text, format_args!("{} = {}", self::key(key), inline(value))),
        }
    }
}

/// `key = value`, a list of tables or a long list of lists with one entry per line.
fn entry(text: &mut String, key: &str, value: &Value) {
    let line = format!("{} = {}", self::key(key), inline(value));
    let broken = match value {
        Value::Array(list) if list.len() > 1 || line.chars().count() > WIDTH => {
            let tables = list.iter().all(Value::is_object);
            let lists = list.iter().all(Value::is_array) && line.chars().count() > WIDTH;
            (tables || lists).then_some(list)
        }
        _ => None,
    };
    let Some(list) = broken.filter(|list| !list.is_empty()) else {
        return line_of(text, format_args!("{line}"));
    };
    line_of(text, format_args!("{} = [", self::key(key)));
    for value in list {
        line_of(text, format_args!("  {},", inline(value)));
    }
    line_of(text, format_args!("]"));
}

/// A value on one line.
fn inline(value: &Value) -> String {
    match value {
        // nulls were taken out before
        Value::Null => "{}".into(),
        Value::Bool(value) => value.to_string(),
        Value::Number(number) => match number.as_f64().filter(|_| number.is_f64()) {
            Some(value) => format!("{value:?}"),
            None => number.to_string(),
        },
        Value::String(text) => quoted(text),
        Value::Array(list) => {
            let entries: Vec<_> = list.iter().map(inline).collect();
            format!("[{}]", entries.join(", "))
        }
        Value::Object(table) if table.is_empty() => "{}".into(),
        Value::Object(table) => {
            let entry =
                |(key, value): (&String, &Value)| format!("{} = {}", self::key(key), inline(value));
            let entries: Vec<_> = table.iter().map(entry).collect();
            format!("{{ {} }}", entries.join(", "))
        }
    }
}

fn key(key: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-');
    if !key.is_empty() && key.chars().all(bare) { key.into() } else { quoted(key) }
}

/// A text in double quotes.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => quoted.push_str("\\\""),
            '\\' => quoted.push_str("\\\\"),
            '\n' => quoted.push_str("\\n"),
            '\t' => quoted.push_str("\\t"),
            '\r' => quoted.push_str("\\r"),
            c if c.is_control() => {
                let _ = write!(quoted, "\\u{:04X}", u32::from(c));
            }
            c => quoted.push(c),
        }
    }
    quoted + "\""
}
