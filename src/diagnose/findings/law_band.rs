//! Confidence band of a law: the delta method, var w(z) = g(z)' C g(z), where g is the slope of the law
//! by its numbers and C their covariance (Seber and Wild, "Nonlinear Regression", 1989, section 5.1).
//!
//! Slopes are taken over one standard error to either side, so that a threshold that the record hardly
//! tells is drawn as wide as it is; laws of a sum are taken together, for their numbers make up for
//! each other.

use crate::findings::cause::LawPart;
use crate::findings::series::OtherLaw;
use crate::fit::finished::Finished;
use crate::fit::found::OtherLaws;
use crate::fit::nuisance::Key;
use crate::fit::problem::Model;

/// Half of a 95 % interval in standard errors.
const HALF: f64 = 1.96;

/// Lower and upper bound of the sum of some laws (`own`, of one place) at values `z` of its coordinate;
/// none where the error of a number that was fitted is not known. Errors are those of the parts that
/// are told; `step` (s) is that of the integration.
pub(crate) fn band(
    chosen: &Finished,
    own: &[usize],
    parts: &[LawPart],
    step: f64,
    z: &[f64],
) -> Vec<(f64, f64, f64)> {
    let model = &chosen.fitted.model;
    let mut moved: Vec<(Key, f64)> = vec![];
    for &index in own {
        let cause = &model.added[index].cause;
        let Some(part) = parts.iter().find(|part| part.effect == cause.effect) else {
            return vec![];
        };
        for &parameter in cause.linear.iter().chain(&cause.refine) {
            let key = Key::EffectParameter(index, parameter);
            if !chosen.fitted.keys.contains(&key) {
                continue;
            }
            let name = cause.card.parameters[parameter].name.as_ref();
            let value = part.parameters.iter().find(|value| value.name == name);
            let Some(error) = value.and_then(|value| value.std_error).filter(|e| e.is_finite())
            else {
                return vec![];
            };
            moved.push((key, error));
        }
    }
    let keys: Vec<Key> = moved.iter().map(|(key, _)| *key).collect();
    let covariance = chosen.precision.as_ref().and_then(|precision| precision.between(&keys));
    let (Some(covariance), false) = (covariance, keys.is_empty()) else { return vec![] };
    // what one standard error of each number changes
    let change = |&(key, error): &(Key, f64)| -> Vec<f64> {
        let at = |by: f64| moved_by(model, key, by * error).sum(own, step, z);
        at(1.0).iter().zip(at(-1.0)).map(|(a, b)| 0.5 * (a - b)).collect()
    };
    let changes: Vec<Vec<f64>> = moved.iter().map(change).collect();
    let scale = |i: usize| covariance[(i, i)].max(0.0).sqrt();
    let correlation = |i: usize, j: usize| match scale(i) * scale(j) {
        size if i != j && size > 0.0 => covariance[(i, j)] / size,
        _ => f64::from(u8::from(i == j)),
    };
    let law = model.sum(own, step, z);
    let bound = |k: usize| {
        let mut variance = 0.0;
        for (i, a) in changes.iter().enumerate() {
            for (j, b) in changes.iter().enumerate() {
                variance += a[k] * correlation(i, j) * b[k];
            }
        }
        let half = HALF * variance.max(0.0).sqrt();
        (z[k], law[k] - half, law[k] + half)
    };
    (0..z.len()).map(bound).collect()
}

/// A model with one number of a law moved.
fn moved_by(model: &Model, key: Key, by: f64) -> Model {
    let mut moved = model.clone();
    if let Key::EffectParameter(index, parameter) = key {
        moved.added[index].parameters[parameter] += by;
    }
    moved
}

/// Another law of the same place at values of the coordinate.
pub(crate) fn other_law(of: &OtherLaws, model: &Model, step: f64, z: &[f64]) -> OtherLaw {
    let with = Model { added: of.added.clone(), ..model.clone() };
    let all: Vec<usize> = (0..of.added.len()).collect();
    let law = with.sum(&all, step, z);
    OtherLaw {
        effects: of.added.iter().map(|added| added.cause.effect.to_string()).collect(),
        probability: of.probability,
        law: z.iter().copied().zip(law).collect(),
    }
}
