//! What a training lowers: the loss on its records as its settings have it.

use super::counted::counted;
use super::orthogonal::Orthogonal;
use super::settings::Weights;
use super::shooting::Shooting;
use super::{Augmented, MultipleShooting, TrainError, Trainer};
use crate::data::Record;

/// Weight of the penalty on what a learned part does in the place of parameters, where it must not.
const HELD: f64 = 1e3;

/// The loss, prepared.
pub(super) struct Task<'a> {
    pub loss: MultipleShooting<'a>,
    /// Standard deviation of each output in the training records.
    pub deviations: Vec<f64>,
    pub shooting: Shooting,
}

impl<'a> Task<'a> {
    /// Of a model before training along its records.
    pub fn of(
        trainer: &Trainer,
        start: &'a Augmented,
        training: &'a [Record],
    ) -> Result<Self, TrainError> {
        let by = &trainer.weights;
        let counts = match *by == Weights::default() {
            true => None,
            false => Some(counted(by, start, training)?),
        };
        let deviations = deviations(start, training, counts.as_deref())?;
        let variances: Vec<f64> = deviations.iter().map(|d| d * d).collect();
        let Trainer { length, threads, arithmetic, .. } = *trainer;
        let shooting = Shooting { length, threads, arithmetic };
        let mut loss = MultipleShooting::new(start, training, shooting, &variances)?;
        loss.set_settle(trainer.settle);
        if let Some(counts) = counts {
            loss.count_by(counts);
        }
        // between two steps the penalty holds what every step is brought back to
        let weight = if trainer.orthogonal { trainer.disguise.max(HELD) } else { trainer.disguise };
        if let (true, Some(record)) = (weight > 0.0, training.first())
            && let Some(penalty) = Orthogonal::new(start, record, weight)?
        {
            loss.penalise(penalty);
        }
        loss.follow_innovations(trainer.innovations);
        Ok(Self { loss, deviations, shooting })
    }
}

/// Standard deviation of each output over all records, without what does not count; 1 where that
/// is 0.
fn deviations(
    model: &Augmented,
    records: &[Record],
    counts: Option<&[Vec<f64>]>,
) -> Result<Vec<f64>, TrainError> {
    let mut values = vec![vec![]; model.model.outputs];
    for (i, record) in records.iter().enumerate() {
        for (all, own) in values.iter_mut().zip(model.series(record, i + 1)?.y) {
            all.extend_from_slice(own);
        }
    }
    for (values, counts) in values.iter_mut().zip(counts.unwrap_or_default()) {
        let masked = values.iter_mut().zip(counts).filter(|(_, count)| **count == 0.0);
        masked.for_each(|(value, _)| *value = f64::NAN);
    }
    let deviation = |values: &Vec<f64>| crate::encoder::Spread::of(values).scale;
    Ok(values.iter().map(deviation).collect())
}
