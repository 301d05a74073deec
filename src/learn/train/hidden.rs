//! Augmented states that start from data: the modes of a subspace model that the baseline lacks.
//!
//! A linear model of the record (and one of the baseline's error) gives modes
//! s[k+1] = A_m s[k] + B_m u[k]. Those are taken, by forward selection, that would remove most of
//! the error e if they entered the linearised baseline wherever the network may write:
//!
//! ```text
//! min over C_a, D_x, D_u of || e - T (C_a s + D_x x_b + D_u u) ||
//! ```
//!
//! with T the baseline's tangent. D_x and D_u, which need no state, are taken out first, so that
//! what a mode of the baseline could do counts for nothing (orthogonal least squares: Chen, Billings
//! and Luo, Int. J. Control 50, 1989). A_m and B_m become the network's linear part; its rows into
//! the baseline stay 0, so that the start is the baseline itself.

use nalgebra::DMatrix;

use super::left_over::LeftOver;
use super::modes::Mode;
use super::mover::Mover;
use super::tangent::Tangent;
use crate::data::{Record, Signal};
use crate::encoder::{Baseline as Known, Encoder, EncoderError, Spread};
use crate::estimate::linear;
use crate::lfr::{Block, Interconnection, Sink};

/// Samples that are looked at.
const MOST: usize = 8192;
/// Lags in samples that stand in where a record shows no mode for a state that is left.
const LAGS: [f64; 4] = [3.0, 10.0, 30.0, 100.0];

/// A mode with its states along the record.
struct Candidate {
    mode: Mode,
    series: Vec<Vec<f64>>,
}

/// Gives the augmented states of a model that stands at its start the modes that its record shows
/// beside the baseline, and the encoder what estimates them; what was found.
pub(super) fn start_from_data(
    model: &mut Interconnection,
    encoder: &mut dyn Encoder,
    known: &Known<'_>,
) -> Result<Vec<String>, EncoderError> {
    let first = known.shape().baseline_states;
    let Some(mover) = Mover::of(model, known, first)? else { return Ok(vec![]) };
    let mut notes = vec![];
    let chosen = match choose(&mover, known, &mut notes) {
        Ok(chosen) => chosen,
        Err(error) => {
            let note = format!("the added states start at rest: {error}");
            return Ok(vec![note]);
        }
    };
    let Block::Network(learned) = &mut model.blocks[mover.block] else { return Ok(vec![]) };
    let layout = learned.net.layout().clone();
    let (inputs, linear) = (layout.inputs(), layout.linear().start);
    let weights = learned.net.weights_mut();
    let (mut at, mut series) = (0, vec![]);
    for Candidate { mode, series: own } in chosen {
        let width = mode.width();
        for i in 0..width {
            let row = linear + mover.places[at + i].0 * inputs;
            (0..width).for_each(|j| weights[row + mover.places[at + j].1] = mode.a[(i, j)]);
            let drives = mover.drives.iter().enumerate();
            drives.for_each(|(d, drive)| weights[row + drive.at] = mode.b[(i, d)]);
        }
        let names: Vec<String> = (at..at + width).map(|i| format!("xa{}", i + 1)).collect();
        let verb = if width == 1 { "starts" } else { "start" };
        notes.push(format!("{} {verb} as {mode}", names.join(" and ")));
        series.extend(own);
        at += width;
    }
    if series.is_empty() {
        return Ok(notes);
    }
    // an encoder of one's own may have no linear part to be set: it then learns from where it is
    let map = known.map_to(encoder.window(), &series)?;
    match encoder.set_linear_from(first, &map) {
        Ok(()) | Err(EncoderError::NoLinearPart { .. }) => Ok(notes),
        Err(error) => Err(error),
    }
}

/// Why no mode was found.
#[derive(Debug, thiserror::Error)]
enum NotFound {
    #[error("nothing that the network sees beside them moves")]
    Still,
    #[error("the record lacks an output")]
    NotMeasured,
    #[error("{0}")]
    Linear(#[from] EncoderError),
}

/// Modes for all augmented states, best first.
fn choose(
    mover: &Mover,
    known: &Known<'_>,
    notes: &mut Vec<String>,
) -> Result<Vec<Candidate>, NotFound> {
    let measured = known.seen().ok_or(NotFound::NotMeasured)?;
    let (_, segments) = known.drives();
    let longest = segments.iter().max_by_key(|s| s.len()).cloned().unwrap_or(0..0);
    let part = longest.start..longest.end.min(longest.start + MOST);
    let drives: Vec<Vec<f64>> = mover.drives.iter().map(|d| d.values.clone()).collect();
    if drives.is_empty() || part.is_empty() {
        return Err(NotFound::Still);
    }
    let tangent = Tangent::of(known)?;
    let mut error = LeftOver::of(known, &tangent, &measured, part.clone())?;
    // what needs no state: a linear correction by what the network sees, and other first states
    let (course, n) = (known.simulate()?, known.shape().baseline_states);
    let targets: Vec<_> = mover.targets.iter().filter_map(|&to| tangent.enters(to)).collect();
    let silent = vec![0.0; part.len()];
    for state in 0..n {
        if let Some(by) = tangent.enters(Sink::State(state)) {
            error.take_out(tangent.answer(&by, &silent, Some(state)));
        }
    }
    let about = |values: &[f64]| -> Vec<f64> {
        let Spread { offset, scale } = Spread::of(values);
        values.iter().map(|v| (v - offset) / scale).collect()
    };
    let mut known_signals: Vec<Vec<f64>> = vec![vec![1.0; part.len()]];
    known_signals.extend(course.states.iter().map(|x| about(&x[part.clone()])));
    known_signals.extend(drives.iter().map(|u| u[part.clone()].to_vec()));
    for by in &targets {
        for signal in &known_signals {
            error.take_out(tangent.answer(by, signal, None));
        }
    }
    let without = error.square();
    let mut pool = pool(mover, known, &drives, &measured, &error, &part);
    let (mut chosen, mut room) = (vec![], mover.places.len());
    let columns = |candidate: &Candidate| -> Vec<Vec<f64>> {
        let each = candidate.series.iter().map(|series| {
            // a start that is not known counts as rest
            let own = series[part.clone()].iter().map(|v| if v.is_finite() { *v } else { 0.0 });
            own.collect::<Vec<f64>>()
        });
        let each: Vec<Vec<f64>> = each.collect();
        targets.iter().flat_map(|by| each.iter().map(|s| tangent.answer(by, s, None))).collect()
    };
    let mut lags = false;
    while room > 0 {
        let mut best: Option<(f64, usize)> = None;
        for (i, candidate) in pool.iter().enumerate().filter(|(_, c)| c.mode.width() <= room) {
            let gain = error.gain(columns(candidate));
            if best.is_none_or(|(most, _)| gain > most) {
                best = Some((gain, i));
            }
        }
        match best {
            Some((gain, i)) if gain > 1e-9 * without => {
                let candidate = pool.swap_remove(i);
                columns(&candidate).into_iter().for_each(|column| error.take_out(column));
                room -= candidate.mode.width();
                chosen.push(candidate);
            }
            _ if !lags => {
                lags = true;
                let step = known.record.sampling_time;
                let each = LAGS.iter().flat_map(|&lag| (0..drives.len()).map(move |d| (lag, d)));
                let more = each.map(|(lag, d)| Mode::lag(lag, d, drives.len(), step));
                pool.extend(more.filter_map(|mode| Candidate::of(mode, &drives, segments)));
            }
            _ => break,
        }
    }
    if !chosen.is_empty() {
        notes.push(format!(
            "of the baseline's error a linear correction would leave {:.1} % without added states, \
             {:.1} % with their start",
            100.0 * (without / error.whole).sqrt(),
            100.0 * (error.square() / error.whole).sqrt()
        ));
    }
    Ok(chosen)
}

impl Candidate {
    fn of(
        mut mode: Mode,
        drives: &[Vec<f64>],
        segments: &[std::ops::Range<usize>],
    ) -> Option<Self> {
        let series = mode.run(drives, segments)?;
        Some(Self { mode, series })
    }
}

/// Modes of linear models from what drives the network to what was measured, and to the error.
fn pool(
    mover: &Mover,
    known: &Known<'_>,
    drives: &[Vec<f64>],
    measured: &[&[f64]],
    error: &LeftOver,
    part: &std::ops::Range<usize>,
) -> Vec<Candidate> {
    let (n, added) = (known.shape().baseline_states, mover.places.len());
    let signal = |name: String, values: Vec<f64>| Signal { name, unit: String::new(), values };
    let inputs = drives.iter().enumerate();
    let inputs: Vec<Signal> =
        inputs.map(|(i, u)| signal(format!("u{}", i + 1), u[part.clone()].to_vec())).collect();
    let record = |outputs: Vec<Vec<f64>>| {
        let outputs = outputs.into_iter().enumerate();
        Record {
            source: known.record.source.clone(),
            sampling_time: known.record.sampling_time,
            start: 0.0,
            inputs: inputs.clone(),
            outputs: outputs.map(|(i, y)| signal(format!("y{}", i + 1), y)).collect(),
            segments: std::iter::once(0..part.len()).collect(),
        }
    };
    let measured_part = record(measured.iter().map(|y| y[part.clone()].to_vec()).collect());
    let wrong = record(error.series.chunks_exact(part.len()).map(<[f64]>::to_vec).collect());
    let (_, segments) = known.drives();
    let mut pool = vec![];
    for (record, order) in [(&measured_part, n + added), (&wrong, added), (&wrong, n + added)] {
        // a record of which no linear model can be made proposes nothing
        let Ok(found) = linear(std::slice::from_ref(record), Some(order)) else { continue };
        let Some(of) = found.system.model.matrices(&found.system.signals().theta()) else {
            continue;
        };
        let (a, b): (DMatrix<f64>, DMatrix<f64>) = (of.a, of.b);
        let modes = Mode::all(&a, &b, record.sampling_time);
        pool.extend(modes.into_iter().filter_map(|mode| Candidate::of(mode, drives, segments)));
    }
    pool
}
