//! Which combinations of parameters a record cannot tell.

use nalgebra::DMatrix;
use serde::Serialize;

/// A combination of parameters that moves freely: the record does not see it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Combination {
    /// Parameters with their relative changes, the largest being 1.
    pub changes: Vec<(String, f64)>,
    /// In words.
    pub text: String,
}

/// Share of the largest singular value below which a direction is not seen at all.
const UNSEEN: f64 = 1e-6;
/// Shares of a combination below this are left out of its description.
const MINOR: f64 = 0.05;

/// Combinations of parameters along which the outputs do not change, from the derivatives of
/// the residuals by relative changes of the parameters (columns of equal length).
pub fn unseen(names: &[String], columns: &[Vec<f64>]) -> Vec<Combination> {
    let n = columns.len();
    if n == 0 {
        return vec![];
    }
    let gram = DMatrix::from_fn(n, n, |i, j| crate::statistics::dot(&columns[i], &columns[j]));
    let eigen = gram.symmetric_eigen();
    let largest = eigen.eigenvalues.iter().fold(0.0, |m: f64, v| m.max(*v));
    let mut found = vec![];
    for (k, &value) in eigen.eigenvalues.iter().enumerate() {
        if value > UNSEEN * UNSEEN * largest {
            continue;
        }
        let direction = eigen.eigenvectors.column(k);
        let top = direction.iter().fold(0.0f64, |m, v| if v.abs() > m.abs() { *v } else { m });
        let changes: Vec<(String, f64)> = names
            .iter()
            .zip(direction.iter())
            .map(|(name, v)| (name.clone(), v / top))
            .filter(|(_, v)| v.abs() > MINOR)
            .collect();
        found.push(Combination { text: in_words(&changes), changes });
    }
    found
}

fn in_words(changes: &[(String, f64)]) -> String {
    match changes {
        [(name, _)] => format!("{name} leaves no trace in this record"),
        _ => {
            let parts: Vec<String> =
                changes.iter().map(|(name, v)| format!("{name} by {v:+.2} x")).collect();
            format!("changing {} together changes nothing that was measured", parts.join(", "))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ratio_is_all_that_is_seen() {
        // the output depends on a / b only: relative derivatives are opposite
        let up: Vec<f64> = (0..100).map(|k| (k as f64 * 0.1).sin()).collect();
        let down: Vec<f64> = up.iter().map(|v| -v).collect();
        let other: Vec<f64> = (0..100).map(|k| (k as f64 * 0.3).cos()).collect();
        let names = ["a".to_string(), "b".to_string(), "c".to_string()];
        let found = unseen(&names, &[up, down, other]);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].changes.len(), 2);
        let ratio = found[0].changes[0].1 / found[0].changes[1].1;
        assert!((ratio - 1.0).abs() < 1e-6, "{:?}", found[0]);
    }
}
