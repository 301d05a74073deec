//! Where the linearisation stays, gains are those of the algebraic Riccati equation and are kept: the
//! likelihood and its slopes are those of the whole recursion, also about samples that are missing.

use super::plants::{OSCILLATOR, Sizes, excitation, simulate, system};
use crate::layout::Layout;
use crate::noise::Slow;
use crate::replay::Pass;
use crate::{Noise, Predictor};

fn pass(path: &crate::path::Path, noise: &Noise) -> (f64, Vec<f64>, usize) {
    let along = noise.components();
    let mut pass = Pass::new(path, Layout::of(path, noise), false);
    pass.forward(path, noise);
    let mut slopes = vec![0.0; along.len()];
    pass.gradient(path, noise, &along, &mut slopes);
    let kept = pass.s.windows(2).filter(|s| s[0] == s[1]).count();
    (pass.log_likelihood, slopes, kept)
}

#[test]
fn kept_gains_change_neither_likelihood_nor_slopes() {
    let system = system(OSCILLATOR);
    let sizes = Sizes { white: vec![0.5], measurement: vec![0.02], ..Sizes::default() };
    let record = simulate(&system, &excitation(3000, 0.05, 1.0, 5), &sizes, 7);
    let predictor = Predictor::new(&system, &[record]).unwrap();
    let mut noise = predictor.white(vec![4e-4]);
    noise.white[0] = 0.25;
    for wander in [Slow::NONE, Slow::fading(1e-5, 0.95)] {
        noise.wander[0] = wander;
        let mut path = predictor.run(&predictor.model, &noise, Default::default()).unwrap().path;
        for missing in [1500, 1501, 2100] {
            path.e[missing] = f64::NAN;
        }
        let (short, slopes, kept) = pass(&path, &noise);
        assert!(kept > 1000, "{kept} of 3000 gains were kept");
        path.as_before = vec![];
        let (whole, exact, _) = pass(&path, &noise);
        assert!((short - whole).abs() < 1e-8 * whole.abs(), "{short} {whole}");
        for (short, whole) in slopes.iter().zip(&exact) {
            assert!((short - whole).abs() < 1e-6 * whole.abs().max(1.0 / 4e-4), "{short} {whole}");
        }
    }
}
