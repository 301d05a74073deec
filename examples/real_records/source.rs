//! Where the samples of a case come from: a file, a part of one, or two files of two instruments.

use std::f64::consts::{LN_2, TAU};
use std::ops::Range;
use std::path::Path;

use lacuna::data::Record;

use super::Outcome;

/// One record of a set.
#[derive(PartialEq)]
pub enum Source {
    /// Columns of a file: the input, the output.
    File(&'static str, &'static str, &'static str),
    /// The same, these samples of it.
    Part(&'static str, &'static str, &'static str, Range<usize>),
    /// The same of a file without a clock; its samples are counted as seconds.
    Counted(&'static str, &'static str, &'static str, Range<usize>),
    /// Force and speed of a rack and pinion, from two instruments.
    Rack,
}

impl Source {
    /// Reads it from the folder of its set.
    pub fn read(&self, folder: &Path) -> Outcome<Record> {
        Ok(match self {
            Self::File(name, u, y) => Record::csv(folder.join(name))?.pick(&[u], &[y])?,
            Self::Part(name, u, y, rows) => {
                Record::csv(folder.join(name))?.pick(&[u], &[y])?.slice(rows.clone())
            }
            Self::Counted(name, u, y, rows) => {
                let table = Record::csv(folder.join(name))?.sampled_at(1.0);
                table.pick(&[u], &[y])?.slice(rows.clone())
            }
            Self::Rack => rack(folder)?,
        })
    }
}

/// Force and speed on one clock of 1 ms: the force's own is 4 ms late, and both are smoothed
/// alike (-3 dB at 30 Hz), which a linear relation between them does not notice.
fn rack(folder: &Path) -> Outcome<Record> {
    const LATE: f64 = 0.004;
    const STEP: f64 = 0.001;
    let force = Record::csv(folder.join("force.csv"))?.pick(&["force"], &[])?;
    let servo = Record::csv(folder.join("servo.csv"))?.pick(&["speed"], &[])?;
    let end = |record: &Record| record.time(record.len() - 1);
    let from = (force.start + LATE).max(servo.start);
    let to = (end(&force) + LATE).min(end(&servo));
    let times: Vec<f64> =
        (0..((to - from) / STEP) as usize).map(|k| from + k as f64 * STEP).collect();
    let width = LN_2.sqrt() / (TAU * 30.0);
    let smooth = |record: &Record, late: f64, at: f64| {
        let (mut sum, mut weights) = (0.0, 0.0);
        for (k, value) in record.inputs[0].values.iter().enumerate() {
            let off = (record.time(k) + late - at) / width;
            let weight = (-0.5 * off * off).exp();
            sum += weight * value;
            weights += weight;
        }
        sum / weights
    };
    let u: Vec<f64> = times.iter().map(|&at| smooth(&force, LATE, at)).collect();
    let y: Vec<f64> = times.iter().map(|&at| smooth(&servo, 0.0, at)).collect();
    Ok(Record::new(STEP).input("u [N]", u)?.output("y [m/s]", y)?)
}
