//! Signals and residuals: in time, in frequency, against the inputs.

use super::analysis::{correlation, density};
use super::page::Page;
use super::svg::{Figure, Scale, thinned};
use crate::diagnose::{Finding, Series};

/// Stretches that a drawn series is thinned to.
const STRETCHES: usize = 900;
/// Samples of the close-up.
const CLOSE: usize = 400;
const LAGS: usize = 60;

/// All sections on the estimation data.
pub fn sections(page: &mut Page, series: &Series, finding: &Finding) {
    let found = !finding.causes.is_empty();
    for (o, (name, unit)) in series.outputs.iter().enumerate() {
        let (Some(measured), Some(before), Some(after)) =
            (series.measured.get(o), series.before.get(o), series.after.get(o))
        else {
            continue;
        };
        let of_unit = if unit.is_empty() { String::new() } else { format!(" [{unit}]") };
        page.heading(&format!("{name}: measured and simulated"));
        let dt = series.sampling_time;
        let n = measured.len();
        let timed = |values: &[f64]| -> Vec<(f64, f64)> {
            values.iter().enumerate().map(|(k, v)| (k as f64 * dt, *v)).collect()
        };
        let residual = |simulated: &[f64]| -> Vec<f64> {
            measured.iter().zip(simulated).map(|(a, b)| a - b).collect()
        };
        let (rb, ra) = (residual(before), residual(after));
        // a close-up where the model is most wrong, the whole below
        let centre = rb
            .iter()
            .enumerate()
            .filter(|(_, v)| v.is_finite())
            .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
            .map_or(0, |(k, _)| k);
        let from = centre.saturating_sub(CLOSE / 2).min(n.saturating_sub(CLOSE));
        let to = (from + CLOSE).min(n);
        let close = |values: &[f64]| -> Vec<(f64, f64)> {
            (from..to).map(|k| (k as f64 * dt, values[k])).collect()
        };
        let mut figure = Figure::new("time [s]", &format!("{name}{of_unit}"))
            .line("measured", "measured", close(measured))
            .line("before", "model", close(before));
        if found {
            figure = figure.line("after", "extended model", close(after));
        }
        page.raw(&figure.svg());
        page.element("p", "note", "Close-up where the model is most wrong.");
        let mut figure = Figure::new("time [s]", &format!("residual of {name}{of_unit}")).line(
            "before",
            "model",
            thinned(&timed(&rb), STRETCHES),
        );
        if found {
            figure = figure.line("after", "extended model", thinned(&timed(&ra), STRETCHES));
        }
        if series.split > 0 && series.split < n && series.segments.len() < 2 {
            figure = figure.upright("quiet", "what follows chose", series.split as f64 * dt);
        }
        if let Some(flagged) = series.flagged.get(o).filter(|f| !f.is_empty()) {
            let dots = flagged.iter().filter_map(|&k| Some((k as f64 * dt, *rb.get(k)?, 0.0)));
            figure = figure.dots("law", "flagged", dots.collect());
        }
        page.raw(&figure.svg());
        page.element("p", "note", "Measured minus simulated, the whole record.");
        spectrum(page, finding, name, &of_unit, (&rb, &ra), dt, found);
        against_inputs(page, series, name, (&rb, &ra), found);
    }
}

fn filled(values: &[f64]) -> Vec<f64> {
    values.iter().map(|v| if v.is_finite() { *v } else { 0.0 }).collect()
}

fn spectrum(
    page: &mut Page,
    finding: &Finding,
    name: &str,
    unit: &str,
    (before, after): (&[f64], &[f64]),
    dt: f64,
    found: bool,
) {
    let root = |x: &[f64]| -> Vec<(f64, f64)> {
        density(&filled(x), dt).into_iter().map(|(f, p)| (f, p.sqrt())).collect()
    };
    page.element("h3", "", &format!("Spectrum of the residual of {name}"));
    let mut figure = Figure::new("frequency [Hz]", &format!("density{unit} / \u{221a}Hz"))
        .scales(Scale::Log, Scale::Log)
        .line("before", "model", root(before));
    if found {
        figure = figure.line("after", "extended model", root(after));
    }
    if let Some(floor) = finding.noise_floor.get(name).filter(|f| f.std > 0.0) {
        let label = format!("noise floor ({})", floor.method);
        figure = figure.level("floor", &label, floor.std * (2.0 * dt).sqrt());
    }
    page.raw(&figure.svg());
    page.element(
        "p",
        "note",
        "What stands above the noise floor is not noise. The floor is drawn as white noise of the \
         estimated size.",
    );
}

fn against_inputs(
    page: &mut Page,
    series: &Series,
    name: &str,
    (before, after): (&[f64], &[f64]),
    found: bool,
) {
    for (input, _, u) in &series.inputs {
        let lagged = |c: Vec<f64>| -> Vec<(f64, f64)> {
            c.into_iter().enumerate().map(|(k, v)| (k as f64, v)).collect()
        };
        let u = filled(u);
        let (b, bound) = correlation(&filled(before), &u, LAGS);
        let (a, after_bound) = correlation(&filled(after), &u, LAGS);
        if b.is_empty() {
            continue;
        }
        page.element("h3", "", &format!("Residual of {name} against the past of {input}"));
        let bound = if found { after_bound } else { bound };
        let last = (b.len() - 1) as f64;
        let mut figure = Figure::new("delay [samples]", "correlation")
            .height(210.0)
            .band("floor", "99 % band", vec![(0.0, -bound, bound), (last, -bound, bound)])
            .line("before", "model", lagged(b));
        if found {
            figure = figure.line("after", "extended model", lagged(a));
        }
        page.raw(&figure.svg());
    }
}
