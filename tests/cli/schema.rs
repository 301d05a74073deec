//! Every document that a command prints is what `docs/schema` says it is.

use super::*;

/// What is wrong with a value, by the part of JSON Schema that the files in `docs/schema` use:
/// `description`, `type`, `const`, `enum`, `required`, `properties`, `additionalProperties`, `items`.
fn faults(value: &Value, schema: &Value, path: &str, found: &mut Vec<String>) {
    for key in schema.as_object().unwrap().keys() {
        let known = [
            "$schema",
            "title",
            "description",
            "type",
            "const",
            "enum",
            "required",
            "properties",
            "additionalProperties",
            "items",
        ];
        assert!(known.contains(&key.as_str()), "the checker does not know `{key}`");
    }
    let kind = match value {
        Value::Null => "null",
        Value::Bool(_) => "boolean",
        Value::Number(number) if number.is_i64() || number.is_u64() => "integer",
        Value::Number(_) => "number",
        Value::String(_) => "string",
        Value::Array(_) => "array",
        Value::Object(_) => "object",
    };
    let fits = |wanted: &Value| wanted == kind || (wanted == "number" && kind == "integer");
    let of_type = match &schema["type"] {
        Value::Null => true,
        Value::Array(kinds) => kinds.iter().any(fits),
        wanted => fits(wanted),
    };
    let of_list = schema["enum"].as_array().is_none_or(|values| values.contains(value));
    let equal = schema.get("const").is_none_or(|wanted| wanted == value);
    if !(of_type && of_list && equal) {
        found.push(format!("{path} is {value}"));
        return;
    }
    for key in schema["required"].as_array().into_iter().flatten() {
        if value.get(key.as_str().unwrap()).is_none() {
            found.push(format!("{path} lacks {key}"));
        }
    }
    for (key, own) in value.as_object().into_iter().flatten() {
        let of_key = schema["properties"].get(key).or_else(|| schema.get("additionalProperties"));
        if let Some(schema) = of_key {
            faults(own, schema, &format!("{path}.{key}"), found);
        }
    }
    if let (Some(items), Some(schema)) = (value.as_array(), schema.get("items")) {
        for (k, item) in items.iter().enumerate() {
            faults(item, schema, &format!("{path}[{k}]"), found);
        }
    }
}

pub fn faults_of(document: &Value, schema: &str) -> Vec<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/schema");
    let text = std::fs::read_to_string(path.join(format!("{schema}.json"))).unwrap();
    let mut found = vec![];
    faults(document, &serde_json::from_str(&text).unwrap(), schema, &mut found);
    found
}

#[test]
fn documents_are_what_their_schemas_say() {
    let folder = scratch("schema");
    std::fs::write(folder.join("m.toml"), MODEL).unwrap();
    record(&folder, "d.csv", "m.toml", 600, 0.01);
    for (line, schema, status) in [
        ("simulate --model m.toml --data d.csv", "simulate", 0),
        ("check --model m.toml --data d.csv", "check", 0),
        ("estimate --model m.toml --data d.csv --out f.toml", "estimate", 0),
        ("estimate --lti 2 --data d.csv --out l.toml", "estimate-lti", 0),
        ("plan --model m.toml --data d.csv", "plan", 0),
        ("diagnose --model m.toml --data d.csv --out found", "diagnosis", 0),
        ("look --data d.csv --out looked", "look", 0),
        ("new duffing", "new", 0),
        ("export l.toml --to c --out source", "export", 0),
        ("models", "models", 0),
        ("effects", "effects", 0),
        ("simulate --model no.toml --data d.csv", "error", 2),
        ("look", "error", 2),
    ] {
        let document = run(&folder, &format!("{line} --json")).exits(status).json();
        assert_eq!(faults_of(&document, schema), Vec::<String>::new(), "{line}");
    }
}

#[test]
fn the_checker_finds_faults() {
    let document = serde_json::json!({ "schema": 2, "error": { "kind": "odd", "message": 1 } });
    let found = faults_of(&document, "error");
    for word in ["schema is 2", "kind is \"odd\"", "message is 1", "lacks \"hint\""] {
        assert!(found.iter().any(|fault| fault.contains(word)), "{word}: {found:?}");
    }
}
