use super::*;
use crate::candidates::library::library;
use crate::data::Record;
use crate::fit::found::{Off, Slot};
use crate::fit::problem::Added;
use crate::prepare::prepared::Prepared;
use crate::system::System;
use lacuna_core::file::{Format, parse};

const CART: &str = r#"
sampling_time = 0.1
[model.equations]
inputs = [{ name = "u" }]
states = [{ name = "v", derivative = "u - v" }]
outputs = [{ name = "y", value = "v" }]
channels = [{ name = "push", into = [{ state = "v" }] }]
"#;

/// The cart's record, and an offset and a cubic law that pushes outwards, so that no step
/// follows it.
fn pushed(system: &System) -> (Prepared<'_>, [Added; 2]) {
    let u: Vec<f64> = (0..600).map(|k| (0.1 * f64::from(k)).sin()).collect();
    let y = u.clone();
    let record = Record::new(0.1).input("u", u).unwrap().output("y", y).unwrap();
    let prepared = Prepared::new(system, &[record], 0.7).unwrap();
    let allowed = Allowed::default();
    let all = library(&prepared.problem, &prepared.nominal, &prepared.start, vec![], &allowed, &());
    let added = |effect: &str, parameters: Vec<f64>| {
        let mut into_push = all.iter().filter(|c| c.into == "push");
        let cause = into_push.find(|c| c.effect == effect).unwrap().clone();
        Added { cause, parameters }
    };
    let both = [added("bias", vec![0.1]), added("cubic", vec![1e9])];
    (prepared, both)
}

fn effects(model: &Model) -> Vec<&str> {
    model.added.iter().map(|added| added.cause.effect).collect()
}

#[test]
fn what_diverges_in_the_end_loses_its_last_cause() {
    let system = parse(CART, "cart.toml", Format::Toml).unwrap();
    let (mut prepared, [offset, outwards]) = pushed(&system);
    let mut model = prepared.start.clone();
    let slots = vec![Slot::of(&offset.cause), Slot::of(&outwards.cause)];
    model.added = vec![offset, outwards];
    let found = Found {
        model,
        slots,
        choice: 0.0,
        first: None,
        left_out: None,
        spikes: vec![vec![]],
        full: false,
        nothing: 0.0,
        suspected: vec![],
        off: Off::default(),
        withdrawn: vec![],
        refuted: vec![],
    };
    let held = Nuisance::new(&prepared.problem, &prepared.nominal);
    let Prepared { problem, nominal, start, .. } = &mut prepared;
    let allowed = &Allowed::default();
    let mut tracks = Tracks {
        problem,
        nominal,
        start,
        allowed,
        most: 2,
        breaks_off: &|_, _, _| false,
        watch: &(),
    };
    let finished = tracks.finish(Track::ParametersTrusted, found, held).unwrap();
    assert_eq!(effects(&finished.fitted.model), ["bias"]);
    assert_eq!(finished.found.slots.len(), 1);
}
