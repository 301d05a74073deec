//! Everything on the shelf, ready to run: models by their example tables, effects with
//! values that do something, and every place where they may stand.

use lacuna::data::Record;
use lacuna::effect::{CandidateEffect, Mechanism, Role};
use lacuna::evaluate::{Init, Simulation};
use lacuna::file::{self, Format};
use lacuna::model::StateSpaceModel;
use lacuna::register::{self, PlugIn};
use lacuna::system::{Placed, System};

/// Sampling time of all runs, in s.
pub const STEP: f64 = 0.01;

/// The example of every registered model, with its name.
pub fn models() -> Vec<(&'static str, System)> {
    register::models()
        .into_iter()
        .map(|card| {
            let PlugIn::Model { example } = card.plug_in else { unreachable!() };
            assert!(!example.is_empty(), "`{}` is registered without an example", card.name);
            (card.name, parse(&model_file(card.name, example)))
        })
        .collect()
}

/// A model file around a model's example table.
pub fn model_file(name: &str, example: &str) -> toml::Table {
    let own: toml::Table = example.parse().unwrap_or_else(|e| panic!("example of {name}: {e}"));
    let text = format!("sampling_time = {STEP}\nintegrator = {{ substeps = 4 }}\n[model.{name}]\n");
    let mut whole: toml::Table = text.parse().unwrap();
    whole["model"][name] = own.into();
    whole
}

pub fn parse(table: &toml::Table) -> System {
    let text = table.to_string();
    file::parse(&text, "example.toml", Format::Toml)
        .unwrap_or_else(|error| panic!("{}\n{text}", error.pretty()))
}

/// A record with one smooth series per input of a system.
pub fn record(system: &System, samples: usize) -> Record {
    let mut record = Record::new(STEP);
    for (i, input) in system.signals().inputs.iter().enumerate() {
        let phase = 0.7 * i as f64;
        let values: Vec<f64> = (0..samples)
            .map(|k| {
                let t = k as f64 * STEP;
                0.2 + (3.0 * t + phase).sin() + 0.5 * (17.0 * t + phase).cos()
            })
            .collect();
        record = record.input(&input.name, values).unwrap();
    }
    record
}

/// Outputs of a free run from the stated initial values.
pub fn outputs(system: &System, record: &Record) -> Vec<Vec<f64>> {
    let run = Simulation::of(system, record, Init::Samples(0)).unwrap();
    assert_eq!(run.diverged_at, None, "{:?}", system.effects);
    run.outputs.into_iter().map(|(_, series)| series).collect()
}

/// Whether two runs are equal to the last bit, zeros of either sign being equal.
pub fn same_bits(a: &[Vec<f64>], b: &[Vec<f64>]) -> bool {
    let same = |a: &f64, b: &f64| a.to_bits() == b.to_bits() || (*a == 0.0 && *b == 0.0);
    a.len() == b.len()
        && a.iter()
            .zip(b)
            .all(|(a, b)| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b)))
}

/// The same effect with values at which it does something small.
pub fn working(effect: &dyn CandidateEffect) -> Box<dyn CandidateEffect> {
    if effect.typetag_name() == "free_form" {
        let fields = serde_json::json!({
            "free_form": { "knots": [-1.0, 0.0, 1.0], "values": [-0.2, 0.05, 0.1] }
        });
        return serde_json::from_value(fields).unwrap();
    }
    let values: Vec<f64> = effect
        .card()
        .parameters
        .iter()
        .map(|effect_parameter| match effect_parameter.role {
            Role::Choice | Role::Held => effect_parameter.value,
            Role::Origin => 0.2,
            // lags and delays of a few samples, bounds near the signal, small forces
            Role::Coefficient => 0.03_f64.clamp(effect_parameter.min, effect_parameter.max),
            Role::Shape if effect_parameter.name == "low" => -0.02,
            Role::Shape if effect_parameter.name == "high" => 0.03,
            Role::Shape => 0.5_f64.clamp(effect_parameter.min, effect_parameter.max),
        })
        .collect();
    effect.with_values(&values).unwrap()
}

/// The same effect made neutral in every way its card knows: all coefficients 0 with other
/// shapes than the default's, and all shapes at their neutral values.
pub fn neutral(effect: &dyn CandidateEffect) -> Vec<Box<dyn CandidateEffect>> {
    if effect.typetag_name() == "free_form" {
        let fields = serde_json::json!({
            "free_form": { "knots": [-1.0, 0.0, 1.0], "values": [0.0, 0.0, 0.0] }
        });
        return vec![serde_json::from_value(fields).unwrap()];
    }
    let card = effect.card();
    let shaped = |shape: &dyn Fn(&lacuna::effect::EffectParameter) -> f64,
                  coefficient: f64|
     -> Vec<f64> {
        let effect_parameters = card.parameters.iter();
        effect_parameters
            .map(|effect_parameter| match effect_parameter.role {
                Role::Coefficient => coefficient.clamp(effect_parameter.min, effect_parameter.max),
                Role::Choice | Role::Origin | Role::Held => effect_parameter.value,
                Role::Shape => shape(effect_parameter),
            })
            .collect()
    };
    let tries = [
        card.values(),
        shaped(
            &|effect_parameter| {
                if effect_parameter.value.is_finite() { 0.37 } else { effect_parameter.value }
            },
            0.0,
        ),
        shaped(&|effect_parameter| effect_parameter.neutral.unwrap_or(0.37), 1.0),
    ];
    let neutral = tries.iter().filter(|values| card.is_neutral(values));
    neutral.map(|values| effect.with_values(values).unwrap()).collect()
}

/// Every place of a model at which the library lets an effect stand.
pub fn places(system: &System, effect: &dyn CandidateEffect) -> Vec<Placed> {
    let signals = system.signals();
    let named =
        |list: &[lacuna::model::Signal]| list.iter().map(|s| s.name.clone()).collect::<Vec<_>>();
    let ends = [named(&signals.inputs), named(&signals.outputs)].concat();
    let parameters = signals.parameters.iter().map(|p| p.name.clone());
    let into: Vec<String> =
        named(&signals.own_channels()).into_iter().chain(ends.clone()).chain(parameters).collect();
    let mut of: Vec<Option<String>> = vec![None, Some("time".into())];
    of.extend(named(&signals.own_coordinates()).into_iter().chain(ends).map(Some));
    // what looks at several coordinates looks at outputs and inputs beside the first
    let further = effect.card().made_for.map_or(0, |made| made.len().saturating_sub(1));
    let beside = named(&signals.outputs).into_iter().chain(named(&signals.inputs));
    let beside: Vec<String> = beside.collect();
    let mut places = vec![];
    for into in &into {
        for of in &of {
            let mut placed = Placed::new(effect.boxed(), into, of.as_deref());
            let other = |name: &&String| Some(*name) != of.as_ref();
            placed.also_of = beside.iter().filter(other).take(further).cloned().collect();
            let own = signals.parameters.iter().find(|p| p.name == *into);
            if let (Mechanism::Parameter, Some(own)) = (effect.card().mechanism, own) {
                // a value near the present one, with which the model still runs
                let value = if own.value == 0.0 { 0.01 } else { 1.02 * own.value };
                placed.effect = effect.with_values(&[value.clamp(own.min, own.max)]).unwrap();
            }
            if extend(system, [placed.clone()]).is_some() {
                places.push(placed);
            }
        }
    }
    places
}

/// The system with these effects added, if it takes them: written and read again, as a
/// user's file would be.
pub fn extend(system: &System, effects: impl IntoIterator<Item = Placed>) -> Option<System> {
    let mut extended = system.clone();
    extended.effects.extend(effects);
    let text = file::to_toml(&extended).ok()?;
    file::parse(&text, "extended.toml", Format::Toml).ok()
}

/// The registered face of a system's model.
pub fn model(system: &System) -> &dyn StateSpaceModel {
    system.model.as_ref()
}
