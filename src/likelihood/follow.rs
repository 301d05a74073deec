//! The extended Kalman filter of a system along records: its predictor, and the path that it takes.
//!
//! e = y - h(x-) - d, S = C P- C' + R, K = P- C' / S, x+ = x- + K e, x-[k+1] = F(x+, u, m), with exact
//! Jacobians along the filter's own path. Missing outputs carry no weight. With a gate, an isolated
//! innovation beyond it moves nothing and is scored by the tail of Student's distribution.
//! Sources: Jazwinski, "Stochastic Processes and Filtering Theory", 1970, ch. 8; Ljung, section 3.2.

use super::earlier::Earlier;
use super::kalman::Kalman;
use super::layout::Layout;
use super::noise::Noise;
use super::parametrised::Model;
use super::path::Path;
use crate::system::{Drive, Origin, System, Transition};

/// Degrees of freedom of the tail that scores a gated innovation: heavy, with a finite mean and variance.
const TAIL: f64 = 3.0;

/// Innovations gated one after the other at most: what lasts longer is no spike, and must move the
/// filter or it would lose the plant.
const IN_A_ROW: usize = 2;

/// Magnitude beyond which a state counts as diverged.
const BEYOND: f64 = 1e100;

/// What is wanted beside the path.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Wanted {
    /// Derivatives along parameters.
    pub theta: bool,
    /// The table of sources.
    pub seen: bool,
    /// Standardised innovation beyond which a sample is gated.
    pub gate: Option<f64>,
}

/// Start of every segment: states and their variances.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Start {
    /// States of each segment; a missing segment starts like the last one given.
    pub x: Vec<Vec<f64>>,
    /// Variances of the states.
    pub p0: Vec<f64>,
}

/// A run of the filter.
#[derive(Debug, Clone)]
pub(crate) struct Followed {
    pub log_likelihood: f64,
    pub path: Path,
    /// Output and sample of every innovation that was gated.
    pub outliers: Vec<(usize, usize)>,
    /// Log density of every output at every sample, given all before; 0 where nothing was measured.
    pub densities: Vec<f64>,
    /// Sample at which it left the finite numbers.
    pub diverged_at: Option<usize>,
}

/// Runs the filter; `measured` holds all outputs sample by sample.
pub(crate) fn follow(
    system: &System,
    model: &Model,
    (drive, measured): (&Drive, &[f64]),
    start: &Start,
    noise: &Noise,
    wanted: Wanted,
) -> Option<Followed> {
    let effect_values = model.plan.effect_values();
    let given = (&model.theta[..], &effect_values[..]);
    let mut plant = Transition::new(system, &model.plan, drive, given, wanted.theta)?;
    let (n, nf, ny) = (plant.states(), plant.forces(), noise.measurement.len());
    let direct = model.plan.output_equations.reads_rates();
    let layout = Layout::new(n, direct, noise);
    let len = drive.len();
    let nt = if wanted.theta { model.theta.len() } else { 0 };
    let sources = if wanted.seen { model.plan.sources.entries.len() } else { 0 };
    let mut path = blank((n, nf, ny), (nt, sources), len, drive, start);
    path.earlier = Earlier::of(model, drive, measured);
    path.d.resize(if direct { len * ny * nf } else { 0 }, 0.0);
    path.unread.resize(if wanted.seen { len * ny } else { 0 }, 0.0);
    let entries: Vec<Option<usize>> =
        (0..ny).map(|o| model.plan.sources.at(Origin::Output(o))).collect();
    let mut seen = vec![0.0; sources];
    let mut kalman = Kalman::new(&layout);
    let mut to = plant.jacobian();
    path.read.resize(len * to.read.len(), 0.0);
    let (mut x, mut slow) = (vec![0.0; n], vec![0.0; layout.len()]);
    let mut carried = slow.clone();
    let (mut next, mut force) = (vec![0.0; n], vec![0.0; nf]);
    let mut row = vec![0; ny];
    let mut found = Followed {
        log_likelihood: 0.0,
        path: Path::default(),
        outliers: vec![],
        densities: vec![0.0; len * ny],
        diverged_at: None,
    };
    for (number, segment) in drive.segments.iter().enumerate() {
        plant.start(number);
        kalman.start(&path.p0, &layout, noise);
        let given = start.x.get(number).or(start.x.last())?;
        x.fill(0.0);
        x[..given.len().min(n)].copy_from_slice(&given[..given.len().min(n)]);
        slow.fill(0.0);
        row.fill(0);
        for k in segment.clone() {
            plant.place(&x);
            let (y, c) = (&mut path.predicted[k * ny..][..ny], &mut path.c[k * ny * n..][..ny * n]);
            plant.observe(k, y, c, &mut path.c_theta[k * ny * nt..][..ny * nt]);
            if wanted.seen {
                plant.see(&mut seen);
                let unread = path.unread[k * ny..][..ny].iter_mut();
                unread.zip(&entries).for_each(|(to, e)| *to = e.map_or(f64::NAN, |e| seen[e]));
            }
            if direct {
                plant.direct(&mut path.d[k * ny * nf..][..ny * nf]);
            }
            // the update is a deviation from the predicted state, then added to it
            slow[..n].fill(0.0);
            for o in 0..ny {
                let at = k * ny + o;
                let e = measured[at] - path.predicted[at];
                if !measured[at].is_finite() {
                    continue;
                }
                layout.row(path.rows(k, o), o, kalman.c_mut());
                let expected: f64 = kalman.c().iter().zip(&slow).map(|(c, x)| c * x).sum();
                let own = e - expected;
                let variance = noise.measurement[o] + path.earlier.reading(o, k - segment.start);
                let gate = wanted.gate.filter(|_| row[o] < IN_A_ROW);
                if let Some(gate) = gate {
                    let s = kalman.gain(variance);
                    let over = own.abs() / s.sqrt() / gate;
                    if over > 1.0 {
                        let normal = 0.5 * ((std::f64::consts::TAU * s).ln() + gate * gate);
                        found.densities[at] = -normal - (TAIL + 1.0) * over.ln();
                        found.log_likelihood += found.densities[at];
                        found.outliers.push((o, k));
                        row[o] += 1;
                        continue;
                    }
                }
                row[o] = 0;
                path.e[at] = e;
                let s = kalman.update(variance);
                slow.iter_mut().zip(kalman.k()).for_each(|(x, k)| *x += k * own);
                found.densities[at] = -0.5 * ((std::f64::consts::TAU * s).ln() + own * own / s);
                found.log_likelihood += found.densities[at];
            }
            path.jump[k * n..][..n].copy_from_slice(&slow[..n]);
            x.iter_mut().zip(&slow[..n]).for_each(|(x, jump)| *x += jump);
            path.states[k * n..][..n].copy_from_slice(&x);
            plant.place(&x);
            if wanted.seen {
                plant.see(&mut path.seen[k * sources..][..sources]);
            }
            force.fill(0.0);
            for (l, &c) in layout.forces.iter().enumerate() {
                force[c] += slow[n + l];
            }
            path.force[k * nf..][..nf].copy_from_slice(&force);
            plant.advance(k, &force, &mut next, &mut to);
            path.a[k * n * n..][..n * n].copy_from_slice(&to.a);
            path.g[k * n * nf..][..n * nf].copy_from_slice(&to.g);
            path.read[k * to.read.len()..][..to.read.len()].copy_from_slice(&to.read);
            path.theta[k * n * nt..][..n * nt].copy_from_slice(&to.theta);
            std::mem::swap(&mut x, &mut next);
            layout.carry(noise, &slow, &mut carried);
            slow[n..].copy_from_slice(&carried[n..]);
            kalman.predict(&to.a, &to.g, &layout, noise);
            path.earlier.spread(k - segment.start, &to.g, (n, nf), &mut kalman.p);
            let size: f64 = x.iter().chain(&slow[n..]).map(|v| v.abs()).sum();
            if !(size < BEYOND && found.log_likelihood.is_finite()) {
                found.diverged_at = Some(k);
                found.log_likelihood = f64::NEG_INFINITY;
                found.path = path;
                return Some(found);
            }
        }
    }
    path.mark_equal();
    found.path = path;
    Some(found)
}

/// A path with nothing in it.
fn blank(
    (n, nf, ny): (usize, usize, usize),
    (nt, sources): (usize, usize),
    len: usize,
    drive: &Drive,
    start: &Start,
) -> Path {
    let zeros = |count: usize| vec![0.0; count * len];
    let mut p0 = start.p0.clone();
    p0.resize(n, 0.0); // states of effects start at rest
    Path {
        n,
        forces: nf,
        outputs: ny,
        len,
        segments: drive.segments.clone(),
        a: zeros(n * n),
        g: zeros(n * nf),
        read: vec![],
        d: vec![],
        c: zeros(ny * n),
        e: vec![f64::NAN; ny * len],
        jump: zeros(n),
        force: zeros(nf),
        states: zeros(n),
        predicted: zeros(ny),
        p0,
        earlier: Earlier::default(),
        theta: zeros(n * nt),
        c_theta: zeros(ny * nt),
        seen: zeros(sources),
        unread: vec![],
        as_before: vec![],
    }
}
