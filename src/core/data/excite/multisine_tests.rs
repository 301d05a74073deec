use super::*;
use crate::data::excite::rms;

fn multisine(lines: Lines) -> Multisine {
    Multisine { period: 512, lines, rms: 3.0, phases: Phases::Random, crest_iterations: 0 }
}

/// Magnitudes of the lines of one period.
fn spectrum(signal: &[f64]) -> Vec<f64> {
    let forward = fourier::forward(signal.len());
    let mut lines = forward.make_output_vec();
    forward.process(&mut signal.to_vec(), &mut lines).unwrap();
    lines.iter().map(|line| line.norm()).collect()
}

#[test]
fn only_the_lines_asked_for_are_excited_and_alike() {
    for lines in [
        Lines::Full { from: 3, to: Some(40) },
        Lines::Full { from: 1, to: None },
        Lines::Odd { from: 1, to: Some(101) },
        Lines::OddRandom { from: 1, to: Some(101), group: 3 },
        Lines::List(vec![7, 2, 255]),
    ] {
        for (phases, crest_iterations) in [(Phases::Random, 0), (Phases::Schroeder, 20)] {
            let settings = Multisine { phases, crest_iterations, ..multisine(lines.clone()) };
            let u = settings.generate(512, 0.1, 9).unwrap();
            let excited = settings.excited(9).unwrap();
            assert!((rms(&u) - 3.0).abs() < 1e-12);
            let flat = 3.0 * 512.0 / (2.0 * excited.len() as f64).sqrt();
            for (k, magnitude) in spectrum(&u).iter().enumerate() {
                let expected = if excited.contains(&k) { flat } else { 0.0 };
                assert!((magnitude - expected).abs() < 1e-9, "line {k} of {lines:?}");
            }
        }
    }
}

#[test]
fn one_of_each_group_of_odd_lines_is_left_out() {
    let settings = multisine(Lines::OddRandom { from: 1, to: Some(23), group: 4 });
    let excited = settings.excited(1).unwrap();
    assert_eq!(excited.len(), 9);
    for group in [1..9, 9..17, 17..25] {
        assert_eq!(excited.iter().filter(|line| group.contains(*line)).count(), 3);
    }
    assert!((2..20).any(|seed| settings.excited(seed).unwrap() != excited));
}

#[test]
fn the_crest_factor_falls() {
    let random = multisine(Lines::Full { from: 1, to: Some(100) });
    let crest = |settings: &Multisine| crest_factor(&settings.generate(512, 0.1, 2).unwrap());
    let schroeder = Multisine { phases: Phases::Schroeder, ..random.clone() };
    let searched = Multisine { crest_iterations: 200, ..random.clone() };
    assert!(crest(&random) > 2.3, "{}", crest(&random));
    assert!(crest(&schroeder) < 1.9, "{}", crest(&schroeder));
    assert!(crest(&searched) < 1.7, "{}", crest(&searched));
}

#[test]
fn settings_are_validated_by_name() {
    use crate::fault::Explain;
    let good = multisine(Lines::Full { from: 1, to: None });
    let key = |settings: Multisine| {
        settings.generate(10, 0.1, 0).unwrap_err().place().key.unwrap_or_default()
    };
    assert_eq!(key(Multisine { rms: 0.0, ..good.clone() }), "rms");
    assert_eq!(key(Multisine { rms: f64::NAN, ..good.clone() }), "rms");
    assert_eq!(key(Multisine { period: 2, ..good.clone() }), "period");
    assert_eq!(key(Multisine { period: usize::MAX, ..good.clone() }), "period");
    for lines in [
        Lines::List(vec![]),
        Lines::List(vec![0]),
        Lines::List(vec![256]),
        Lines::List(vec![4, 4]),
        Lines::Full { from: 1, to: Some(256) },
        Lines::Odd { from: 9, to: Some(8) },
        Lines::Odd { from: 2, to: Some(2) },
        Lines::Full { from: 0, to: None },
    ] {
        assert_eq!(key(Multisine { lines, ..good.clone() }), "lines");
    }
    let lines = Lines::OddRandom { from: 1, to: None, group: 1 };
    assert_eq!(key(Multisine { lines, ..good }), "group");
}
