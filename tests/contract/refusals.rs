//! What no plug-in takes: unknown keys, values of a wrong type, two where one may stand.

use lacuna::effect::CandidateEffect;
use lacuna::fault::Explain;
use lacuna::file::{self, FileError, Format};
use lacuna::register::{self, PlugIn};

use super::shelf::{model_file, working};

/// The error of a model file, and the line that it names.
fn refused(table: &toml::Table, what: &str) -> (FileError, String) {
    let text = table.to_string();
    match file::parse(&text, "bad.toml", Format::Toml) {
        Ok(_) => panic!("{what} was accepted:\n{text}"),
        Err(error) => {
            let place = error.place();
            assert_eq!(place.file.as_deref(), Some("bad.toml"), "{what}: {error}");
            let line = place.line.unwrap_or_else(|| panic!("{what}: no line in {error}"));
            let line = text.lines().nth(line - 1).unwrap_or_default().to_string();
            (error, line)
        }
    }
}

fn examples() -> impl Iterator<Item = (&'static str, toml::Table)> {
    register::models().into_iter().map(|card| {
        let PlugIn::Model { example } = card.plug_in else { unreachable!() };
        (card.name, model_file(card.name, example))
    })
}

#[test]
fn an_unknown_key_of_a_model() {
    for (name, mut table) in examples() {
        table["model"][name].as_table_mut().unwrap().insert("zzz".into(), 1.0.into());
        let (error, line) = refused(&table, name);
        assert!(line.starts_with("zzz"), "{name}: {error}\n{line}");
        assert_eq!(error.place().key.as_deref(), Some(format!("model.{name}.zzz").as_str()));
    }
}

#[test]
fn a_wrong_type_in_every_key_of_a_model() {
    for (name, table) in examples() {
        for key in table["model"][name].as_table().unwrap().keys() {
            let mut table = table.clone();
            let own = table["model"][name].as_table_mut().unwrap();
            own.insert(key.clone(), toml::Value::Boolean(true));
            let (error, line) = refused(&table, &format!("{name}.{key} = true"));
            assert!(line.starts_with(key.as_str()), "{name}.{key}: {error}\n{line}");
            let place = error.place().key.unwrap_or_default();
            assert!(place.starts_with(&format!("model.{name}.{key}")), "{name}.{key}: {place}");
        }
    }
}

#[test]
fn two_models_in_one_file() {
    for (name, mut table) in examples() {
        let second = if name == "duffing" { "lti" } else { "duffing" };
        let model = table["model"].as_table_mut().unwrap();
        model.insert(second.into(), toml::Table::new().into());
        let (error, line) = refused(&table, name);
        let told = error.to_string();
        assert!(told.contains(name) && told.contains(second), "{told}");
        assert!(line.contains(name) || line.contains(second), "{told}\n{line}");
    }
}

/// A model file with one effect.
fn with_effect(effect: &dyn CandidateEffect, change: impl FnOnce(&mut toml::Table)) -> toml::Table {
    let (_, mut table) = examples().find(|(name, _)| *name == "duffing").unwrap();
    let mut effect = toml::Table::try_from(effect).unwrap();
    change(&mut effect);
    let mut entry = toml::Table::new();
    entry.insert("into".into(), "u".into());
    entry.insert("of".into(), "v".into());
    entry.insert("effect".into(), effect.into());
    table.insert("effects".into(), vec![toml::Value::from(entry)].into());
    table
}

#[test]
fn an_unknown_key_of_an_effect() {
    for (card, effect) in register::effects() {
        let name = card.name;
        let table = with_effect(working(effect.as_ref()).as_ref(), |effect| {
            effect[name].as_table_mut().unwrap().insert("zzz".into(), 1.0.into());
        });
        let (error, line) = refused(&table, name);
        assert!(line.starts_with("zzz"), "{name}: {error}\n{line}");
        let key = format!("effects[0].effect.{name}.zzz");
        assert_eq!(error.place().key.as_deref(), Some(key.as_str()));
    }
}

#[test]
fn a_wrong_type_in_every_key_of_an_effect() {
    for (card, effect) in register::effects() {
        let (name, effect) = (card.name, working(effect.as_ref()));
        let keys = toml::Table::try_from(effect.as_ref()).unwrap();
        for key in keys[name].as_table().unwrap().keys() {
            let table = with_effect(effect.as_ref(), |effect| {
                let own = effect[name].as_table_mut().unwrap();
                own.insert(key.clone(), "much".into());
            });
            let (error, line) = refused(&table, &format!("{name}.{key}"));
            assert!(line.starts_with(key.as_str()), "{name}.{key}: {error}\n{line}");
        }
    }
}

#[test]
fn two_effects_in_one_entry() {
    for (card, effect) in register::effects() {
        let second = if card.name == "bias" { "drag" } else { "bias" };
        let table = with_effect(working(effect.as_ref()).as_ref(), |effect| {
            effect.insert(second.into(), toml::Table::new().into());
        });
        let (error, _) = refused(&table, card.name);
        let told = error.to_string();
        assert!(told.contains(card.name) && told.contains(second), "{told}");
    }
}

#[test]
fn a_neighbour_is_suggested() {
    let (_, mut table) = examples().find(|(name, _)| *name == "duffing").unwrap();
    let duffing = table["model"].as_table_mut().unwrap().remove("duffing").unwrap();
    table["model"].as_table_mut().unwrap().insert("dufing".into(), duffing);
    let (error, _) = refused(&table, "dufing");
    assert_eq!(error.near().as_deref(), Some("duffing"), "{error}");
}
