//! A file's tables, lists and values, each with its place in the text.

use std::ops::Range;

/// A value and the bytes of the text that it was read from.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// Bytes of the value; of a table with a header, those of the header.
    pub span: Range<usize>,
    /// The value.
    pub value: Value,
}

/// What a TOML or JSON file can hold.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// JSON's null: as if the key were absent.
    Null,
    /// `true` or `false`.
    Bool(bool),
    /// A whole number.
    Integer(i128),
    /// Any other number.
    Float(f64),
    /// A text.
    Text(String),
    /// A list.
    List(Vec<Node>),
    /// A table, in the order of the file.
    Table(Vec<Entry>),
}

/// A key with its value.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// The key.
    pub key: String,
    /// Bytes of the key.
    pub at: Range<usize>,
    /// The value.
    pub node: Node,
}

/// Something that is not TOML or JSON at all.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Syntax {
    /// Bytes concerned.
    pub at: Range<usize>,
    /// What is wrong, in the parser's words.
    pub message: String,
}

/// One step of a key path.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Step {
    /// Into a table.
    Key(String),
    /// Into a list, from 0.
    Number(usize),
}

/// The steps of a key path: `effects[0].effect.free_form.values.3` (or `values[3]`).
pub fn steps(path: &str) -> Vec<Step> {
    let parts = path.split(['.', '[', ']']).filter(|part| !part.is_empty());
    parts
        .map(|part| match part.parse() {
            Ok(number) => Step::Number(number),
            Err(_) => Step::Key(part.into()),
        })
        .collect()
}

/// The key path of steps.
fn path(steps: &[Step]) -> String {
    let mut path = String::new();
    for step in steps {
        match step {
            Step::Number(number) => path += &format!("[{number}]"),
            Step::Key(key) if path.is_empty() => path += key,
            Step::Key(key) => path += &format!(".{key}"),
        }
    }
    path
}

impl Node {
    /// The entry of a key, where this is a table that has it.
    pub fn entry(&self, key: &str) -> Option<&Entry> {
        match &self.value {
            Value::Table(entries) => entries.iter().find(|entry| entry.key == key),
            _ => None,
        }
    }

    /// The value of a key, or number, where this has it.
    pub fn child(&self, step: &Step) -> Option<&Node> {
        match (step, &self.value) {
            (Step::Number(number), Value::List(list)) => list.get(*number),
            (Step::Number(number), _) => Some(&self.entry(&number.to_string())?.node),
            (Step::Key(key), _) => Some(&self.entry(key)?.node),
        }
    }

    /// The value at the end of a key path, or at the last step that leads somewhere, and
    /// whether that is the end.
    pub fn find(&self, path: &str) -> (&Node, bool) {
        let mut node = self;
        for step in steps(path) {
            match node.child(&step) {
                Some(child) => node = child,
                None => return (node, false),
            }
        }
        (node, true)
    }

    /// The full key paths that end in these steps.
    pub fn paths_to(&self, end: &[Step]) -> Vec<String> {
        let mut found = vec![];
        self.collect(end, &mut vec![], &mut found);
        found
    }

    fn collect(&self, end: &[Step], steps: &mut Vec<Step>, found: &mut Vec<String>) {
        if !end.is_empty() && steps.ends_with(end) {
            found.push(path(steps));
        }
        let mut follow = |step: Step, node: &Node| {
            steps.push(step);
            node.collect(end, steps, found);
            steps.pop();
        };
        match &self.value {
            Value::List(list) => {
                list.iter().enumerate().for_each(|(k, node)| follow(Step::Number(k), node));
            }
            Value::Table(entries) => {
                entries.iter().for_each(|entry| follow(Step::Key(entry.key.clone()), &entry.node));
            }
            _ => {}
        }
    }

    /// The text, where this is one.
    pub fn text(&self) -> Option<&str> {
        match &self.value {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }
}
