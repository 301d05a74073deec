//! `lacuna models`, `lacuna effects`, `lacuna completions`.

use clap::CommandFactory;
use serde_json::{Value, json};

use super::args::Args;
use super::console::{Console, print};
use super::failure::Failure;
use lacuna::effect::{EffectParameter, Needs};
use lacuna::file::{Format, parse};
use lacuna::model::{Signal, Signals};
use lacuna::register::{self, Card, PlugIn};

/// Signals of the example of a model.
fn signals(card: &Card) -> Option<Signals> {
    let PlugIn::Model { example } = card.plug_in else { return None };
    if example.is_empty() {
        return None;
    }
    let text = format!("sampling_time = 0.1\n[model.{}]\n{example}\n", card.name);
    parse(&text, card.name, Format::Toml).ok().map(|system| system.signals())
}

fn named(signals: &[Signal]) -> Value {
    signals.iter().map(|s| json!({ "name": s.name, "unit": s.unit })).collect()
}

pub fn models(look: &Console) -> Result<u8, Failure> {
    let (document, text) = all_models();
    show(look, &document, &text);
    Ok(0)
}

/// All models as a document and as text.
pub fn all_models() -> (Value, String) {
    let (mut all, mut text) = (vec![], String::new());
    for card in register::models() {
        let PlugIn::Model { example } = card.plug_in else { continue };
        let signals = signals(card);
        let entry = signals.as_ref().map(|s| {
            let parameters: Vec<Value> = s
                .parameters
                .iter()
                .map(|p| json!({ "name": p.name, "unit": p.unit, "value": p.value, "fixed": p.fixed }))
                .collect();
            let states: Vec<Signal> = s.states.iter().map(|state| state.signal.clone()).collect();
            json!({
                "inputs": named(&s.inputs),
                "states": named(&states),
                "outputs": named(&s.outputs),
                "parameters": parameters,
                "channels": named(&s.own_channels()),
                "coordinates": named(&s.own_coordinates()),
            })
        });
        all.push(json!({
            "name": card.name, "summary": card.summary, "example": example, "of_example": entry,
        }));
        text += &format!("{:<20} {}\n", card.name, card.summary);
        if let Some(s) = signals {
            let words = |signals: &[Signal]| -> String {
                let unit = |s: &Signal| {
                    if s.unit.is_empty() { String::new() } else { format!(" [{}]", s.unit) }
                };
                signals.iter().map(|s| s.name.clone() + &unit(s)).collect::<Vec<_>>().join(", ")
            };
            let parameters: Vec<Signal> =
                s.parameters.iter().map(|p| Signal::new(&p.name, &p.unit)).collect();
            for (role, signals) in [
                ("parameters", &parameters),
                ("channels", &s.own_channels()),
                ("coordinates", &s.own_coordinates()),
            ] {
                text += &format!("{:20}   {role}: {}\n", "", words(signals));
            }
        }
    }
    (json!({ "schema": 1, "models": all }), text)
}

pub fn effects(look: &Console) -> Result<u8, Failure> {
    let (document, text) = all_effects();
    show(look, &document, &text);
    Ok(0)
}

/// All effects as a document and as text.
pub fn all_effects() -> (Value, String) {
    let (mut all, mut text) = (vec![], String::new());
    for (card, effect) in register::effects() {
        let own = effect.card();
        let unit = |effect_parameter: &EffectParameter| {
            effect_parameter.unit.text("channel", "coordinate")
        };
        let needs = match own.needs {
            Needs::Nothing => "nothing",
            Needs::Coordinate => "a coordinate",
            Needs::Velocity => "a velocity",
            Needs::VelocityUnderLoad => "a velocity and a load",
            Needs::NoVelocity => "a coordinate that is no velocity",
            Needs::CoordinateWithRate => "a coordinate whose rate is known",
            Needs::Motion => "a position, a velocity or a force",
            Needs::AngleOrTime => "an angle, or time",
            Needs::Time => "time",
        };
        let effect_parameters: Vec<Value> =
            own.parameters.iter().map(|k| json!({ "name": k.name, "unit": unit(k) })).collect();
        all.push(json!({
            "name": card.name, "summary": card.summary, "parameters": effect_parameters, "of": needs,
        }));
        let words: Vec<String> = own
            .parameters
            .iter()
            .map(|k| match unit(k) {
                unit if unit.is_empty() => k.name.to_string(),
                unit => format!("{} [{unit}]", k.name),
            })
            .collect();
        text += &format!("{:<20} {}\n", card.name, card.summary);
        if !words.is_empty() {
            text += &format!("{:20}   of {needs}; parameters: {}\n", "", words.join(", "));
        }
    }
    (json!({ "schema": 1, "effects": all }), text)
}

pub fn completions(shell: clap_complete::Shell, look: &Console) -> Result<u8, Failure> {
    let mut script = vec![];
    clap_complete::generate(shell, &mut Args::command(), "lacuna", &mut script);
    let script = String::from_utf8_lossy(&script);
    show(look, &json!({ "schema": 1, "script": script }), &script);
    Ok(0)
}

/// A list is what was asked for: it goes to stdout in either form.
fn show(look: &Console, document: &Value, text: &str) {
    if look.json { look.document(document) } else { print(text) }
}
