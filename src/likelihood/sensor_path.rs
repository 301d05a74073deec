//! Laws on the path of a sensor: what each reads, and how the reading follows from it.
//!
//! ```text
//! z[1] = h(x), z[i+1] = z[i] + f_i(z[i]), y = z[last + 1];     dy / df_i = product over j > i of (1 + f_j'(z[j]))
//! ```
//!
//! (the chain rule). The last law of a rectifier has a slope of -2 on one side, so that what stands before it
//! enters y with either sign.

use super::hypothesis::Part;
use super::path::Path;
use super::predictor::{Predictor, column, deviation};
use super::tangent::Site;
use crate::effect::curve;
use crate::system::{Origin, Placed};

/// Step of the central difference of a law, as a share of the standard deviation of what it reads.
const STEP: f64 = 1e-6;

/// What a law reads along a record, and how much of what it adds reaches the output.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reading {
    pub z: Vec<f64>,
    pub reaches: Vec<f64>,
}

impl Predictor {
    /// Every part of a hypothesis that is a law on the path of an output, of what the output reads; `None` for
    /// the others.
    pub(super) fn readings(&self, parts: &[Part], path: &Path) -> Vec<Option<Reading>> {
        let mut found = vec![None; parts.len()];
        for o in 0..path.outputs {
            let own: Vec<usize> =
                (0..parts.len()).filter(|&i| self.is_on_path(&parts[i], o)).collect();
            if own.is_empty() {
                continue;
            }
            let name = self.name(Site::Output(o));
            let is_own = |law: &&Placed| law.into == name && law.of.as_ref() == Some(&name);
            let known = self.system.effects.iter().filter(is_own).cloned();
            let parts: Vec<Part> = own.iter().map(|&i| parts[i].clone()).collect();
            let laws: Vec<Placed> = known.chain(self.placed(&parts)).collect();
            let first = laws.len() - own.len();
            let all = chained(&laws, column(&path.unread, path.outputs, o));
            for (i, reading) in own.into_iter().zip(all.into_iter().skip(first)) {
                found[i] = Some(reading);
            }
        }
        found
    }

    fn is_on_path(&self, part: &Part, output: usize) -> bool {
        let entries = &self.model.plan.sources.entries;
        let is_own = |e: usize| entries[e].1 == Origin::Output(output);
        match part {
            Part::Law { site: Site::Output(o), source: Some(e), .. } => *o == output && is_own(*e),
            _ => false,
        }
    }
}

/// The readings of laws one after the other, the first one of `z`.
fn chained(laws: &[Placed], z: Vec<f64>) -> Vec<Reading> {
    let mut all = vec![];
    let mut z = z;
    for law in laws {
        let values = law.effect.card().values();
        let added = |z: &[f64]| curve(law.effect.as_ref(), &values, z);
        let h = STEP * deviation(&z).max(f64::MIN_POSITIVE);
        let moved = |by: f64| added(&z.iter().map(|z| z + by).collect::<Vec<f64>>());
        let slope: Vec<f64> = moved(h)
            .iter()
            .zip(moved(-h))
            .map(|(up, down)| 1.0 + (up - down) / (2.0 * h))
            .collect();
        let next = z.iter().zip(added(&z)).map(|(z, w)| z + w).collect();
        all.push((std::mem::replace(&mut z, next), slope));
    }
    let mut reaches = vec![1.0; z.len()];
    let mut found = vec![];
    for (z, slope) in all.into_iter().rev() {
        found.push(Reading { z, reaches: reaches.clone() });
        reaches.iter_mut().zip(slope).for_each(|(reaches, slope)| *reaches *= slope);
    }
    found.reverse();
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use lacuna_core::file::{Format, parse};
    // registers the effects
    use lacuna_plugins as _;

    /// A gain before a rectifier: y = |1.1 z|.
    #[test]
    fn what_stands_before_a_rectifier_enters_with_either_sign() {
        let model = r#"
sampling_time = 0.1
[model.mass_spring_damper]
masses = [1.0]
stiffness = [1.0]
damping = [1.0]
[[effects]]
into = "y"
of = "y"
effect.gain = { gain = 0.1 }
[[effects]]
into = "y"
of = "y"
effect.hinge = { coefficient = 2.0, start = 0.0, side = -1 }
"#;
        let system = parse(model, "model.toml", Format::Toml).unwrap();
        let found = chained(&system.effects, vec![-2.0, 3.0]);
        assert_eq!(found[0].z, [-2.0, 3.0]);
        let near = |a: &[f64], b: [f64; 2]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
        assert!(near(&found[0].reaches, [-1.0, 1.0]), "{found:?}");
        assert!(near(&found[1].z, [-2.2, 3.3]) && near(&found[1].reaches, [1.0, 1.0]), "{found:?}");
    }
}
