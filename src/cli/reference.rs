//! The reference of the book: every command, model, effect and JSON field, made of what the code
//! itself says of them.

use std::fmt::Write as _;

use clap::Command;
use serde_json::Value;

use super::list;

/// Schemas of what commands answer, in the order of the book.
const SCHEMAS: [(&str, &str); 13] = [
    ("diagnosis", include_str!("../../docs/schema/diagnosis.json")),
    ("simulate", include_str!("../../docs/schema/simulate.json")),
    ("estimate", include_str!("../../docs/schema/estimate.json")),
    ("estimate-lti", include_str!("../../docs/schema/estimate-lti.json")),
    ("check", include_str!("../../docs/schema/check.json")),
    ("plan", include_str!("../../docs/schema/plan.json")),
    ("look", include_str!("../../docs/schema/look.json")),
    ("new", include_str!("../../docs/schema/new.json")),
    ("export", include_str!("../../docs/schema/export.json")),
    ("models", include_str!("../../docs/schema/models.json")),
    ("effects", include_str!("../../docs/schema/effects.json")),
    ("answers", include_str!("../../docs/schema/answers.json")),
    ("error", include_str!("../../docs/schema/error.json")),
];

/// Pages by their file names.
pub fn pages(command: Command) -> [(&'static str, String); 4] {
    [
        ("commands.md", commands(command)),
        ("models.md", models()),
        ("effects.md", effects()),
        ("json.md", fields()),
    ]
}

/// Every command with its help.
fn commands(mut command: Command) -> String {
    command.build();
    let mut page = String::from("# Commands\n\nWhat `lacuna COMMAND --help` prints.\n");
    let own = command.render_long_help().to_string();
    let _ = write!(page, "\n## lacuna\n\n```text\n{}\n```\n", own.trim_end());
    below(&command, "lacuna", &mut page);
    page
}

fn below(command: &Command, path: &str, page: &mut String) {
    for sub in command.get_subcommands().filter(|sub| sub.get_name() != "help") {
        let name = format!("{path} {}", sub.get_name());
        let help = sub.clone().bin_name(&name).render_long_help().to_string();
        let _ = write!(page, "\n## {name}\n\n```text\n{}\n```\n", help.trim_end());
        below(sub, &name, page);
    }
}

/// Entries of a document's list.
fn entries(document: &Value, key: &str) -> Vec<Value> {
    document[key].as_array().cloned().unwrap_or_default()
}

fn word<'a>(entry: &'a Value, key: &str) -> &'a str {
    entry[key].as_str().unwrap_or_default()
}

/// Names with units.
fn named(list: &Value) -> String {
    let each = list.as_array().into_iter().flatten().map(|signal| match word(signal, "unit") {
        "" => format!("`{}`", word(signal, "name")),
        unit => format!("`{}` in {unit}", word(signal, "name")),
    });
    let text = each.collect::<Vec<_>>().join(", ");
    if text.is_empty() { "none".into() } else { text }
}

/// Every model with keys that work.
fn models() -> String {
    let mut page = String::from(
        "# Models\n\nA model file has exactly one of these tables. Its other keys are `sampling_time` (s), \
         `integrator` (`{ method = \"rk4\", substeps = 1 }`), `hold` (`\"zero\"`, `\"first\"`) and the list \
         `effects` (`into`, `of`, `effect`).\n",
    );
    for model in entries(&list::all_models().0, "models") {
        let name = word(&model, "name");
        let _ = write!(page, "\n## {name}\n\n{}.\n", word(&model, "summary"));
        if !word(&model, "example").is_empty() {
            let _ = write!(page, "\n```toml\n[model.{name}]\n{}\n```\n", word(&model, "example"));
        }
        let of = &model["of_example"];
        for role in ["inputs", "states", "outputs", "parameters", "channels", "coordinates"] {
            if !of[role].is_null() {
                let _ = write!(page, "\n- {role}: {}", named(&of[role]));
            }
        }
        page.push('\n');
    }
    page
}

/// Every effect with its parameters.
fn effects() -> String {
    let mut page = String::from(
        "# Effects\n\nA cause is an effect with a place: `into` names the channel that it enters, `of` the \
         coordinate that it depends on. Units are those of the channel and the coordinate.\n\n\
         | effect | what it is | parameters | of |\n| --- | --- | --- | --- |\n",
    );
    for effect in entries(&list::all_effects().0, "effects") {
        let (name, of) = (word(&effect, "name"), word(&effect, "of"));
        let summary = word(&effect, "summary").replace('|', "\\|");
        let _ =
            writeln!(page, "| `{name}` | {summary} | {} | {of} |", named(&effect["parameters"]));
    }
    page
}

/// Every field of every document.
fn fields() -> String {
    let mut page = String::from(
        "# JSON documents\n\nWhat `--json` prints, and what `to_dict()` gives in Python. `[]` stands for the entries \
         of a list, `*` for names such as those of outputs. The schemas are in `docs/schema`.\n",
    );
    for (name, text) in SCHEMAS {
        let schema: Value = serde_json::from_str(text).unwrap_or_default();
        let title = word(&schema, "title");
        let _ = write!(
            page,
            "\n## {name}\n\n{title}\n\n| field | type | always there | what it is |\n| --- | --- | --- | --- |\n"
        );
        below_schema(&schema, "", &mut page);
    }
    page
}

fn below_schema(schema: &Value, path: &str, page: &mut String) {
    let required = schema["required"].as_array().cloned().unwrap_or_default();
    for (key, own) in schema["properties"].as_object().into_iter().flatten() {
        let full = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        let there = if required.iter().any(|name| name == key) { "yes" } else { "" };
        let _ =
            writeln!(page, "| `{full}` | {} | {there} | {} |", kind(own), word(own, "description"));
        nested(own, &full, page);
    }
}

fn nested(own: &Value, full: &str, page: &mut String) {
    below_schema(own, full, page);
    for (deeper, mark) in [(&own["items"], "[]"), (&own["additionalProperties"], ".*")] {
        if deeper.is_object() {
            let path = format!("{full}{mark}");
            if !deeper["properties"].is_object() {
                let _ = writeln!(
                    page,
                    "| `{path}` | {} | | {} |",
                    kind(deeper),
                    word(deeper, "description")
                );
            }
            nested(deeper, &path, page);
        }
    }
}

/// A type in words.
fn kind(schema: &Value) -> String {
    let texts = |list: &Vec<Value>| {
        list.iter().map(|v| v.to_string().replace('"', "`")).collect::<Vec<_>>().join(" or ")
    };
    match (&schema["type"], &schema["enum"], schema.get("const")) {
        (_, Value::Array(values), _) => texts(values),
        (_, _, Some(value)) => value.to_string(),
        (Value::Array(types), ..) => texts(types).replace('`', ""),
        (Value::String(text), ..) => text.clone(),
        _ => "anything".into(),
    }
}
