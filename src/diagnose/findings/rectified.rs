//! Whether a sensor reads the absolute value of what it measures: a full-wave rectifier, y = |z|.

use crate::candidates::coordinate::along;
use crate::findings::cause::Site;
use crate::findings::context::Context;
use crate::fit::problem::{Grain, Model};

/// Share of what rectifying changes up to which a reading may differ from the absolute value.
const OFF: f64 = 0.05;

impl Context<'_, '_> {
    /// Whether an output with these laws on its own path is the absolute value of what it was.
    pub fn rectifies(&self, model: &Model, own: &[usize]) -> bool {
        let cause = &model.added[own[0]].cause;
        let is_own = cause.site() == Site::Output && cause.of.as_deref() == Some(&cause.into[..]);
        if !is_own {
            return false;
        }
        let z = along(self.problem, self.nominal, model, cause, Grain::Fine);
        z.is_some_and(|z| is_absolute(&z, &model.sum(own, self.problem.step(Grain::Fine), &z)))
    }
}

/// Whether z + w is |z|, of values that have both signs.
fn is_absolute(z: &[f64], w: &[f64]) -> bool {
    let squares = |f: &dyn Fn(f64, f64) -> f64| -> f64 {
        z.iter().zip(w).map(|(z, w)| f(*z, *w).powi(2)).sum()
    };
    let changes = squares(&|z, _| z.abs() - z);
    let differs = squares(&|z, w| z + w - z.abs());
    changes > 0.0 && differs < OFF * OFF * changes
}

#[cfg(test)]
mod tests {
    use super::is_absolute;

    #[test]
    fn a_one_sided_law_of_slope_two_is_an_absolute_value() {
        let z: Vec<f64> = (0..200).map(|k| f64::from(k - 80) * 0.01).collect();
        let hinge = |slope: f64, start: f64| -> Vec<f64> {
            z.iter().map(|z| slope * (start - z).max(0.0)).collect()
        };
        assert!(is_absolute(&z, &hinge(2.0, 0.0)) && is_absolute(&z, &hinge(1.98, 0.001)));
        // a half-wave rectifier, another threshold, nothing, no negative values
        assert!(!is_absolute(&z, &hinge(1.0, 0.0)) && !is_absolute(&z, &hinge(2.0, 0.2)));
        assert!(!is_absolute(&z, &hinge(0.0, 0.0)) && !is_absolute(&z[90..], &vec![0.0; 110]));
    }
}
