//! Sums of outputs, followed back and simulated.

use std::sync::Arc;

use super::*;
use crate::candidates::candidate::{Candidate, Wire};
use crate::candidates::library::{Allowed, library};
use crate::data::{Random, Record};
use crate::fit::adjoint::{About, Extent};
use crate::fit::problem::{Grain, Model, Part, Span};
use crate::prepare::prepared::Prepared;
use crate::statistics::add_to_basis;
use lacuna_core::file::{Format, parse};

const SIGNS: usize = 16;
/// What a sensor of speed reads.
const SPEED: &str = "v + 0.1*x";
const EXTENT: Extent = Extent { signs: SIGNS, parameters: true, room: 1 << 30 };

/// A nonlinear machine, by steps of an integrator or from sample to sample, with this second output.
fn model(time: &str, second: &str) -> String {
    let states = match time {
        "continuous" => {
            "{ name = \"x\", derivative = \"v\" }, \
             { name = \"v\", derivative = \"u - k*x - 0.8*v - x^3\" }"
        }
        _ => {
            "{ name = \"x\", next = \"x + 0.05*v\" }, \
             { name = \"v\", next = \"v + 0.05*(u - k*x - 0.8*v - x^3)\" }"
        }
    };
    format!(
        "sampling_time = 0.05\n[model.equations]\ninputs = [{{ name = \"u\" }}]\nstates = [{states}]\n\
         outputs = [{{ name = \"y\", value = \"x\" }}, {{ name = \"z\", value = \"{second}\" }}]\n\
         parameters = [{{ name = \"k\", value = 4.0 }}]\n"
    )
}

/// A record of two segments whose outputs the model does not follow.
fn record() -> Record {
    let mut random = Random::new(3);
    let u: Vec<f64> = (0..600).map(|_| 3.0 * random.normal()).collect();
    let own: Vec<Vec<f64>> = (0..2).map(|_| (0..600).map(|_| random.normal()).collect()).collect();
    let record = Record::new(0.05).input("u", u).unwrap();
    record.output("y", own[0].clone()).unwrap().output("z", own[1].clone()).unwrap()
}

/// What the baseline leaves of the samples that are fitted.
fn left(prepared: &Prepared<'_>) -> Vec<f64> {
    let y = prepared.problem.simulate(&prepared.start, Grain::Coarse).unwrap();
    prepared.problem.residual(&y, Part::Fit)
}

/// What a unit of a law takes off these residuals, by simulation: so little of it that the machine answers
/// as a line.
fn column(prepared: &Prepared<'_>, cause: &Arc<Candidate>, residual: &[f64]) -> Vec<f64> {
    let (problem, size) = (&prepared.problem, 1e-8);
    let job = problem.job(&prepared.start.with(cause, vec![size]), Grain::Coarse).unwrap();
    let moved = problem.run(&[job], Span::Fit).swap_remove(0).unwrap();
    let moved = problem.residual(&moved, Part::Fit);
    moved.iter().zip(residual).map(|(a, b)| (b - a) / size).collect()
}

/// What every law of one number does by simulation, against what the adjoint says of it.
fn compared(time: &str, second: &str, tolerance: f64) {
    let system = parse(&model(time, second), "machine.toml", Format::Toml).unwrap();
    let prepared = Prepared::new(&system, &[record()], 0.7).unwrap();
    let (problem, nominal) = (&prepared.problem, &prepared.nominal);
    let start: &Model = &prepared.start;
    let residual = left(&prepared);
    let about = About { model: start, residual: &residual, basis: &[] };
    let adjoint = Adjoint::new(problem, &about, EXTENT, &()).unwrap();
    let only = Allowed { only: vec!["cubic".into(), "parameter".into()], ..Allowed::default() };
    let mut seen = 0;
    for cause in library(problem, nominal, start, vec![], &only, &()) {
        let column = column(&prepared, &cause, &residual);
        let (sums, place): (Vec<f64>, _) = match &cause.wire {
            Wire::Parameter(p) => {
                let own = &adjoint.parameters.as_ref().unwrap()[0];
                (own[p * (SIGNS + 1)..][..SIGNS + 1].to_vec(), "parameter".into())
            }
            Wire::Stage(route) => {
                let w: Vec<f64> = adjoint.seen[route.source].iter().map(|z| z.powi(3)).collect();
                let place = match &cause.into[..] {
                    "x" => 0,
                    "v" => 1,
                    "u" => 2,
                    _ => continue,
                };
                let mut sums = vec![0.0; SIGNS + 1];
                let own = adjoint.at(Place::Force(place));
                own.zip(&w).for_each(|(own, w)| add(&mut sums, own, *w));
                (sums, cause.into.clone())
            }
            _ => continue,
        };
        seen += 1;
        let (exact, size) = (dot(&column, &residual), dot(&column, &column));
        let scale = (size * dot(&residual, &residual)).sqrt();
        assert!((sums[0] - exact).abs() < tolerance * scale, "{place}: {} is not {exact}", sums[0]);
        // a size from random signs is known within a third, one time in 300 within all
        let estimated = dot(&sums[1..], &sums[1..]) / SIGNS as f64;
        assert!(
            estimated > 0.2 * size && estimated < 3.0 * size,
            "{place}: {estimated} is not {size}"
        );
    }
    assert!(seen > 2, "{seen} laws were compared");
}

#[test]
fn sums_of_outputs_are_followed_back_from_sample_to_sample() {
    compared("discrete", SPEED, 1e-4);
}

#[test]
fn sums_of_outputs_are_followed_back_through_the_steps_of_an_integrator() {
    // what enters is held over a sample, which a law inside the steps is not
    compared("continuous", SPEED, 0.03);
}

#[test]
fn sums_of_an_accelerometer_are_followed_back() {
    compared("continuous", "u - k*x - 0.8*v - x^3", 0.03);
}

/// What a curve of several numbers does by simulation, against what the adjoint says of it.
#[test]
fn several_laws_explain_their_score_statistic() {
    let system = parse(&model("discrete", SPEED), "machine.toml", Format::Toml).unwrap();
    let prepared = Prepared::new(&system, &[record()], 0.7).unwrap();
    let (problem, nominal) = (&prepared.problem, &prepared.nominal);
    let start: &Model = &prepared.start;
    let residual = left(&prepared);
    let about = About { model: start, residual: &residual, basis: &[] };
    let adjoint = Adjoint::new(problem, &about, Extent { signs: 600, ..EXTENT }, &()).unwrap();
    let only = Allowed { only: vec!["cubic".into(), "linear".into()], ..Allowed::default() };
    let all = library(problem, nominal, start, vec![], &only, &());
    let here = all
        .iter()
        .filter(|cause| cause.into == "u" && matches!(cause.of.as_deref(), Some("x" | "v")));
    let (mut columns, mut terms): (Vec<Vec<f64>>, Vec<Vec<f64>>) = (vec![], vec![]);
    for cause in here {
        let Wire::Stage(route) = &cause.wire else { continue };
        let power = if cause.effect == "cubic" { 3 } else { 1 };
        columns.push(column(&prepared, cause, &residual));
        terms.push(adjoint.seen[route.source].iter().map(|z| z.powi(power)).collect());
    }
    let count = columns.len();
    assert_eq!(count, 4);
    let mut own = vec![];
    columns.into_iter().for_each(|column| add_to_basis(&mut own, column));
    let exact: f64 = own.iter().map(|q| dot(q, &residual).powi(2)).sum();
    let at = |k: usize| terms.iter().enumerate().map(|(j, term)| (j, term[k])).collect();
    let terms: Vec<Vec<(usize, f64)>> = (0..terms[0].len()).map(at).collect();
    let explained = adjoint.joint_score(Place::Force(2), count, &terms);
    // 600 signs: known within a twentieth
    assert!((explained / exact - 1.0).abs() < 0.2, "{explained} is not {exact}");
}
