//! Sentences of what is left and what was supposed.

use super::*;
use crate::diagnose::{Site, Wording};

#[test]
fn what_is_as_likely_as_a_parameter_and_less_usual_says_why() {
    let wording = Wording { site: Site::Parameter, ..Wording::default() };
    let mut moved = Cause { into: "m".into(), wording, ..Cause::default() };
    let gain = |probability| Alternative {
        effect: "gain".into(),
        into: "y".into(),
        of: Some("y".into()),
        title: "A wrong scale".into(),
        site: Site::Output,
        error_removed: 0.5,
        probability: Some(probability),
        unweighed: None,
    };
    assert!(why_less_sure(&moved).is_none());
    moved.indistinguishable = vec![gain(0.002)];
    let why = why_less_sure(&moved).unwrap();
    assert!(why.ends_with("a value that is a little wrong is more usual than a law"), "{why}");
    moved.indistinguishable.push(gain(0.3));
    assert!(why_less_sure(&moved).is_none());
}

fn leaves(ratio_to_noise: Option<f64>, white: bool) -> Left {
    Left { ratio_to_noise, white, score: 826.4, wanders_by: None, mean: None }
}

#[test]
fn what_is_left_and_what_was_supposed() {
    let on_a_mean = |ratio, white, wanders_by, mean| {
        left("y", &Left { wanders_by, mean, ..leaves(ratio, white) }, "V")
    };
    let of = |ratio, white, wanders_by| on_a_mean(ratio, white, wanders_by, None);
    assert_eq!(
        of(Some(1.03), true, None),
        "What is left of y is 1.0 times the noise, and white: a sample says nothing of the next."
    );
    assert!(of(Some(32.7), false, None).contains("33 times the noise, and coloured (score 826)"));
    let little = of(Some(0.68), true, None);
    assert!(little.starts_with("What is left of y is no more than the noise, and white"));
    assert!(of(None, false, None).contains("the noise is not known"));
    let wanders = of(Some(1.0), false, Some(0.01));
    assert!(wanders.contains("as of a sensor that wanders by 0.010 V from sample"), "{wanders}");
    let offset = on_a_mean(Some(1.0), false, Some(0.01), Some(2.87));
    assert!(
        offset.contains("from sample to sample. Most of it is its mean, 2.9 V: a constant offset")
    );
    let disturbed = left_by_disturbance("y", 6.94);
    let first = "A simulation of y leaves 6.9 times the noise, ";
    assert!(disturbed.starts_with(first), "{disturbed}");
    let facts = RecordFacts { records: 1, samples: 400, sampling_time: 0.1, test_samples: None };
    assert!(record(&facts).starts_with("400 samples of one record, 0.1000 s apart; "));
}

#[test]
fn what_is_fixed_is_named_and_may_be_the_cause() {
    assert_eq!(supposed_right(&[]), None);
    let text = supposed_right(&["m".into(), "l".into()]).unwrap();
    assert!(text.contains("held: m, l.") && text.contains("wrong or drifts"), "{text}");
    let drift = Alternative {
        effect: "drift".into(),
        into: "m".into(),
        of: Some("time".into()),
        error_removed: 0.5,
        probability: Some(0.25),
        unweighed: None,
        title: "A drift".into(),
        site: Site::Drift,
    };
    let held = alternative(&["m".into()], &drift);
    assert_eq!(held, "a drift of m (25 %), which is held as right");
    assert_eq!(alternative(&[], &drift), "a drift of m (25 %)");
    let twin = Alternative { probability: None, unweighed: Some(Unweighed::SameModel), ..drift };
    let said = "a drift of m (the same model under another name)";
    assert_eq!(alternative(&[], &twin), said);
}

#[test]
fn data_at_fault_do_not_hide_that_the_model_is_wrong_too() {
    let left = |white| leaves(Some(5.0), white);
    let (open, white) = ([left(true), left(false)], [left(true)]);
    let text = not_only_data(Verdict::DataFault, open.iter()).unwrap();
    assert!(text.contains("that is not all"), "{text}");
    assert_eq!(not_only_data(Verdict::DataFault, white.iter()), None);
    assert_eq!(not_only_data(Verdict::CausesFound, open.iter()), None);
}
