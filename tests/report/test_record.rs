//! What a page draws of the data that neither fitted nor chose anything.

use lacuna::data::Record;
use lacuna::diagnose::{Diagnosis, Finding};
use lacuna::file::{self, Format};
use lacuna::report::Report;

/// RMSE of the first output along what is drawn.
fn rmse(finding: &Finding, simulated: &[f64]) -> f64 {
    let measured = &finding.series.test.measured[0];
    assert_eq!(measured.len(), simulated.len());
    let squares = measured.iter().zip(simulated).map(|(a, b)| (a - b).powi(2));
    (squares.sum::<f64>() / simulated.len() as f64).sqrt()
}

#[test]
fn the_test_record_is_drawn_as_it_was_scored() {
    let system = super::system("");
    let finding = super::finding(&system);
    let test = &finding.series.test;
    let said = [finding.before.test["y"].rmse, finding.after.test["y"].rmse];
    for (drawn, said) in [&test.before[0], &test.after[0]].into_iter().zip(said) {
        let found = rmse(&finding, drawn);
        assert!((found / said - 1.0).abs() < 1e-12, "{found} is not {said}");
    }
    for all in [&test.before, &test.after, &test.inputs] {
        assert_eq!(all[0].len(), test.measured[0].len());
    }
    // from the sample on that counts, with the input of the same samples
    let record = super::record("test.csv.gz", &system);
    assert!(test.skipped > 0 && test.begins == [0]);
    assert_eq!(test.inputs[0], record.inputs[0].values[test.skipped..]);
    assert_eq!(test.measured[0], record.outputs[0].values[test.skipped..]);
    let html = Report::of(&finding).html();
    assert!(html.contains("find the state that it begins in"), "what is left out is not said");

    // without a record of its own, the part that was kept is drawn at its own time
    let est = super::record("est.csv.gz", &system);
    let n = est.len();
    let finding = Diagnosis::of(&system).run(&[est], None, &()).unwrap();
    let test = &finding.series.test;
    assert_eq!(test.skipped + test.measured[0].len(), n);
    assert!(Report::of(&finding).html().contains("y on the part kept for the test"));
}

#[test]
fn models_that_forget_their_start_at_different_times_are_drawn_at_the_same_time() {
    // a filter ten times as slow as the model says
    let model = "[model.equations]
inputs  = [{ name = \"u\" }]
states  = [{ name = \"x\", derivative = \"u - a*x\" }]
outputs = [{ name = \"y\", value = \"x\" }]
parameters = [{ name = \"a\", value = 5.0 }]
";
    let system = file::parse(model, "m.toml", Format::Toml).unwrap();
    let record = |rate: f64| {
        let u: Vec<f64> =
            (0..1000).map(|k| (rate * f64::from(k)).sin() + (0.05 * f64::from(k)).cos()).collect();
        let (decay, mut x) = ((-0.5 * 0.05_f64).exp(), 0.0);
        let step = |u: &f64| {
            let now = x;
            x = decay * x + (1.0 - decay) / 0.5 * u;
            now
        };
        let y: Vec<f64> = u.iter().map(step).collect();
        let noise = |k: usize| 1e-3 * ((k * k * 7919 % 1013) as f64 / 1013.0 - 0.5);
        let y: Vec<f64> = y.iter().enumerate().map(|(k, y)| y + noise(k)).collect();
        Record::new(0.05).input("u", u).unwrap().output("y", y).unwrap()
    };
    let (est, test) = (record(0.31), record(0.23));
    let finding = Diagnosis::of(&system).max_causes(2).run(&[est], Some(&test), &()).unwrap();
    let drawn = &finding.series.test;
    assert_eq!(drawn.measured[0], test.outputs[0].values[drawn.skipped..]);
    assert_eq!(drawn.inputs[0], test.inputs[0].values[drawn.skipped..]);
    // the slow one counts fewer samples, and those are drawn
    let (before, after) = (rmse(&finding, &drawn.before[0]), rmse(&finding, &drawn.after[0]));
    assert!((after / finding.after.test["y"].rmse - 1.0).abs() < 1e-9, "{after}");
    assert!(after < 2e-3 && before > 100.0 * after, "{before} {after}");
    assert_ne!(before, finding.before.test["y"].rmse, "both forget at the same time");
}
