use super::*;
use crate::data::Record;
use crate::diagnose::library::library;
use crate::diagnose::prepared::Prepared;
use crate::file::{Format, parse};

const CART: &str = r#"
sampling_time = 0.1
[model.equations]
inputs = [{ name = "u" }]
states = [{ name = "v", derivative = "u - v" }]
outputs = [{ name = "y", value = "v" }]
channels = [{ name = "push", into = [{ state = "v" }] }]
"#;

#[test]
fn what_diverges_in_the_end_loses_its_last_cause() {
    let system = parse(CART, "cart.toml", Format::Toml).unwrap();
    let u: Vec<f64> = (0..600).map(|k| (0.1 * f64::from(k)).sin()).collect();
    let y = u.clone();
    let record = Record::new(0.1).input("u", u).unwrap().output("y", y).unwrap();
    let mut prepared = Prepared::new(&system, &[record], 0.7).unwrap();
    let allowed = Allowed::default();
    let all = library(&prepared.problem, &prepared.nominal, &prepared.start, vec![], &allowed);
    let cause = |effect: &str| {
        let mut into_push = all.iter().filter(|c| c.into == "push");
        into_push.find(|c| c.effect == effect).unwrap().clone()
    };
    // a cubic law that pushes outwards, so that no step follows it
    let (offset, outwards) = (cause("bias"), cause("cubic"));
    let model = prepared.start.with(&offset, vec![0.1]).with(&outwards, vec![1e9]);
    let found = Found {
        model,
        slots: vec![Slot::of(&offset), Slot::of(&outwards)],
        first: None,
        last: None,
        dependence: 0.0,
        spikes: vec![vec![]],
        full: false,
        given_up: false,
    };
    let held = Nuisance::new(&prepared.problem, &prepared.nominal);
    let Prepared { problem, nominal, start, .. } = &mut prepared;
    let mut tracks = Tracks { problem, nominal, start, allowed: &allowed, most: 2, watch: &() };
    let finished = tracks.finish(Track::ParametersTrusted, found, held).unwrap();
    let kept: Vec<&str> =
        finished.fitted.model.added.iter().map(|added| added.cause.effect).collect();
    assert_eq!(kept, ["bias"]);
    assert_eq!(finished.found.slots.len(), 1);
}
