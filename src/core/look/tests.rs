//! What is seen in records that were made to show it.

use super::*;
use crate::statistics::test_noise::noise;

fn look(u: Vec<f64>, y: Vec<f64>) -> Look {
    Look::of(&Record::new(0.01).input("u [N]", u).unwrap().output("y [m]", y).unwrap())
}

/// A first-order lag with a delay, driven by coloured noise, with noise on the output.
fn lag(n: usize, delay: usize, size: f64) -> (Vec<f64>, Vec<f64>) {
    let (e, v) = (noise(n, 11), noise(n, 23));
    let (mut u, mut x, mut y) = (vec![0.0; n], 0.0, vec![0.0; n]);
    for k in 1..n {
        u[k] = 0.8 * u[k - 1] + e[k];
        y[k] = x + size * v[k];
        x = 0.9 * x + if k >= delay { u[k - delay] } else { 0.0 };
    }
    (u, y)
}

#[test]
fn a_delay_behind_coloured_inputs_is_seen() {
    for delay in [0, 1, 7] {
        let (u, y) = lag(4000, delay, 0.3);
        let look = look(u, y);
        // x follows u one sample later
        assert_eq!(look.responses[0].delay_samples, Some(delay + 1));
        assert_eq!(look.responses[0].reacts, Some(false));
        assert!(look.coherences[0].share > 0.9, "{}", look.coherences[0].share);
        assert_eq!(look.signals[0].excitation_order, Some(100));
    }
}

#[test]
fn unrelated_signals_are_not_coherent() {
    let mut late = 0;
    for seed in 1..=20 {
        let look = look(noise(2000, 7 * seed), noise(2000, 1000 + 13 * seed));
        assert!(look.coherences[0].share < 0.1, "{}", look.coherences[0].share);
        late += usize::from(look.responses[0].delay_samples.is_some());
        late += usize::from(look.responses[0].reacts == Some(true));
    }
    assert!(late <= 1, "{late} of 40 at a level of 0.1 %");
}

#[test]
fn feedback_is_seen() {
    let (e, v) = (noise(4000, 3), noise(4000, 5));
    let (mut u, mut y) = (vec![0.0; 4000], vec![0.0; 4000]);
    for k in 1..4000 {
        y[k] = 0.7 * y[k - 1] + 0.5 * u[k - 1] + v[k];
        u[k] = e[k] - 0.6 * y[k];
    }
    let found = look(u, y);
    assert_eq!(found.responses[0].reacts, Some(true));
    assert!(found.to_string().contains("closed loop"));
}

#[test]
fn lines_grain_clipping_and_what_is_stuck() {
    let n = 4000;
    let hum = |k: usize| 0.5 * (std::f64::consts::TAU * 12.5 * 0.01 * k as f64).sin();
    let e = noise(n, 9);
    let mut y: Vec<f64> = (0..n).map(|k| e[k] + hum(k)).collect();
    let found = look(noise(n, 2), y.clone());
    let line = &found.signals[1].lines[0];
    assert!((line.frequency - 12.5).abs() < 0.2, "{line:?}");
    assert!((line.rms - 0.5 / 2f64.sqrt()).abs() < 0.08, "{line:?}");
    assert!(found.signals[0].lines.is_empty());
    assert!(found.signals[1].stuck.is_none() && found.signals[1].clipped.is_none());
    y[1000..1040].fill(0.125);
    assert_eq!(look(noise(n, 2), y.clone()).signals[1].stuck, Some((1000, 40)));
    let slow: Vec<f64> = (0..n).map(|k| (0.01 * k as f64).sin().clamp(-1.0, 0.8)).collect();
    let clipped = look(noise(n, 2), slow).signals[1].clipped.clone().unwrap();
    assert!(clipped.low < 0.01 && (clipped.high - 0.205).abs() < 0.03, "{clipped:?}");
    let coarse: Vec<f64> = e.iter().map(|v| (v / 0.25).round() * 0.25).collect();
    assert_eq!(look(noise(n, 2), coarse).signals[1].resolution, Some(0.25));
    assert_eq!(look(noise(n, 2), e).signals[1].resolution, None);
}

#[test]
fn excitation_is_counted() {
    let sines = |m: usize| -> Vec<f64> {
        (0..8000).map(|k| (1..=m).map(|i| (0.11 * (i * k) as f64).sin()).sum()).collect()
    };
    // a sine excites two parameters
    let order = |u: Vec<f64>| look(u.clone(), u).signals[0].excitation_order;
    for m in [1, 2] {
        let found = order(sines(m)).unwrap();
        assert!((2 * m..=2 * m + 3).contains(&found), "{m} sines: {found}");
    }
    assert_eq!(order(vec![2.0; 1000]), Some(1));
    assert_eq!(order(vec![0.0; 1000]), Some(0));
}

#[test]
fn periods_give_the_noise() {
    let (period, v) = (noise(500, 4), noise(2000, 6));
    let u: Vec<f64> = (0..2000).map(|k| period[k % 500]).collect();
    let y: Vec<f64> = u.iter().zip(&v).map(|(u, v)| 2.0 * u + 0.1 * v).collect();
    let found = look(u, y);
    let repeats = found.period.unwrap();
    assert_eq!((repeats.samples, repeats.count), (500, 4));
    assert!((repeats.noise[0] - 0.1).abs() < 0.01, "{:?}", repeats.noise);
    assert_eq!(found.responses[0].reacts, None);
}

#[test]
fn poor_records_are_looked_at_too() {
    for (u, y) in [
        (vec![], vec![]),
        (vec![1.0], vec![2.0]),
        (vec![1.0; 40], vec![f64::NAN; 40]),
        (vec![f64::NAN; 40], vec![1.0; 40]),
        (vec![0.0; 500], vec![0.0; 500]),
    ] {
        let found = look(u, y);
        assert!(!found.to_string().is_empty());
        assert!(found.page("<b>").contains("&lt;b&gt;"));
        assert!(serde_json::to_string(&found).is_ok());
    }
}
