//! Signals and residuals: in time, in frequency, against their own past and the inputs'.

use super::analysis::{correlation, density};
use super::figure::{Figure, Role, Scale};
use super::overlay::Overlay;
use super::page::Page;
use crate::diagnose::{Finding, Series};

const LAGS: usize = 60;
/// Half width of a 99 % interval in standard deviations.
const WIDE: f64 = 2.576;

/// All sections on the estimation data.
pub fn sections(page: &mut Page, series: &Series, finding: &Finding) {
    let found = !finding.causes.is_empty();
    for (o, (name, unit)) in series.outputs.iter().enumerate() {
        let (Some(measured), Some(before), Some(after)) =
            (series.measured.get(o), series.before.get(o), series.after.get(o))
        else {
            continue;
        };
        let mut overlay = Overlay {
            output: (name, unit),
            step: series.sampling_time,
            start: 0.0,
            data: "",
            measured,
            simulated: vec![(Role::Before, "model", before)],
            borders: series.segments.iter().skip(1).map(|segment| segment.start).collect(),
        };
        if found {
            overlay.simulated.push((Role::After, "extended model", after));
        }
        page.heading(&format!("{name}: measured and simulated"));
        let n = measured.len();
        page.figure(overlay.close_up());
        let (rb, ra) = (overlay.residual(before), overlay.residual(after));
        let mut figure = overlay.left();
        if series.split > 0 && series.split < n && series.segments.len() < 2 {
            let at = series.split as f64 * series.sampling_time;
            figure = figure.upright(Role::Quiet, "later samples chose the causes", at);
        }
        if let Some(flagged) = series.flagged.get(o).filter(|f| !f.is_empty()) {
            let at = |k: &usize| Some((*k as f64 * series.sampling_time, *rb.get(*k)?, 0.0));
            figure = figure.dots(Role::Law, "flagged", flagged.iter().filter_map(at).collect());
        }
        page.figure(figure);
        if o == 0 {
            for (name, unit, values) in &series.inputs {
                page.figure(overlay.input(name, unit, values));
            }
        }
        page.element(
            "p",
            "note",
            "Begins where the model is most wrong. Mark a range to zoom, double-click for the whole \
             record; with shift the mouse moves the range, with ctrl the wheel zooms. The names \
             above a figure switch its lines on and off.",
        );
        let residuals = (rb.as_slice(), ra.as_slice());
        spectrum(page, finding, (name, unit), residuals, series.sampling_time, found);
        against_itself(page, name, residuals, found);
        against_inputs(page, series, name, residuals, found);
    }
}

fn filled(values: &[f64]) -> Vec<f64> {
    values.iter().map(|v| if v.is_finite() { *v } else { 0.0 }).collect()
}

fn spectrum(
    page: &mut Page,
    finding: &Finding,
    (name, unit): (&str, &str),
    (before, after): (&[f64], &[f64]),
    dt: f64,
    found: bool,
) {
    let root = |x: &[f64]| -> Vec<(f64, f64)> {
        density(&filled(x), dt).into_iter().map(|(f, p)| (f, p.sqrt())).collect()
    };
    let unit = if unit.is_empty() { String::new() } else { format!(" [{unit}/\u{221a}Hz]") };
    let mut figure = Figure::new("frequency [Hz]", &format!("amplitude density{unit}"))
        .titled(&format!("Spectrum of the residual of {name}"))
        .scales(Scale::Log, Scale::Log)
        .line(Role::Before, "model", root(before));
    if found {
        figure = figure.line(Role::After, "extended model", root(after));
    }
    if let Some(floor) = finding.noise_floor.get(name).filter(|f| f.std > 0.0) {
        let label = format!("noise floor ({})", floor.method);
        figure = figure.level(Role::Floor, &label, floor.std * (2.0 * dt).sqrt());
    }
    page.figure(figure);
    page.element(
        "p",
        "note",
        "Root of the power spectral density (Welch, Hann window). The floor is drawn as white noise \
         of the estimated size: what stands above it over a band is not white noise of that size.",
    );
}

/// A correlation over delays with its 99 % band.
fn correlogram(
    title: &str,
    band: f64,
    before: Vec<f64>,
    after: Option<Vec<f64>>,
    first: usize,
) -> Figure {
    let lagged = |c: Vec<f64>| -> Vec<(f64, f64)> {
        c.into_iter().enumerate().skip(first).map(|(k, v)| (k as f64, v)).collect()
    };
    let last = (before.len().max(1) - 1) as f64;
    let band = vec![(first as f64, -band, band), (last, -band, band)];
    let figure = Figure::new("delay [samples]", "correlation")
        .titled(title)
        .height(190.0)
        .linked("delay")
        .band(Role::Floor, "99 % band", band)
        .line(Role::Before, "model", lagged(before));
    match after {
        Some(after) => figure.line(Role::After, "extended model", lagged(after)),
        None => figure,
    }
}

fn against_itself(page: &mut Page, name: &str, (before, after): (&[f64], &[f64]), found: bool) {
    let own = |x: &[f64]| correlation(&filled(x), &filled(x), LAGS).0;
    let b = own(before);
    if b.is_empty() {
        return;
    }
    // of white noise, whatever its distribution (Bartlett)
    let band = WIDE / (before.len() as f64).sqrt();
    let title = format!("Autocorrelation of the residual of {name}");
    page.figure(correlogram(&title, band, b, found.then(|| own(after)), 1));
}

fn against_inputs(
    page: &mut Page,
    series: &Series,
    name: &str,
    (before, after): (&[f64], &[f64]),
    found: bool,
) {
    for (input, _, u) in &series.inputs {
        let u = filled(u);
        let (b, bound) = correlation(&filled(before), &u, LAGS);
        let (a, after_bound) = correlation(&filled(after), &u, LAGS);
        if b.is_empty() {
            continue;
        }
        let title = format!("Residual of {name} against the past of {input}");
        let bound = if found { after_bound } else { bound };
        page.figure(correlogram(&title, bound, b, found.then_some(a), 0));
    }
}
