//! Measured and simulated over time, and under it what simulations leave of it: e = y - y_hat.

use super::figure::{Figure, Role};

/// Samples of the close-up.
const CLOSE: usize = 400;
/// Records after which no more borders between records are drawn.
const BORDERS: usize = 50;

/// One output with its simulations.
pub(super) struct Overlay<'a> {
    /// Name and unit.
    pub output: (&'a str, &'a str),
    /// Sampling time in s, and time of the first sample.
    pub step: f64,
    pub start: f64,
    /// Measured values; NaN where there is none.
    pub measured: &'a [f64],
    /// Simulations, of the same length.
    pub simulated: Vec<(Role, &'static str, &'a [f64])>,
    /// First samples of records that follow others.
    pub borders: Vec<usize>,
    /// What data these are, where there are others on the page: ` on the test record`, or nothing.
    pub data: &'static str,
}

/// A quantity with its unit in brackets.
pub(super) fn with_unit(name: &str, unit: &str) -> String {
    if unit.is_empty() { name.into() } else { format!("{name} [{unit}]") }
}

impl Overlay<'_> {
    /// What a simulation leaves, sample by sample.
    pub fn residual(&self, simulated: &[f64]) -> Vec<f64> {
        self.measured.iter().zip(simulated).map(|(a, b)| a - b).collect()
    }

    /// Times of values.
    pub fn timed(&self, values: &[f64]) -> Vec<(f64, f64)> {
        values.iter().enumerate().map(|(k, v)| (self.at(k), *v)).collect()
    }

    /// Time of a sample.
    fn at(&self, k: usize) -> f64 {
        self.start + k as f64 * self.step
    }

    /// Figures of the same data share their time axis.
    pub fn link(&self) -> String {
        format!("time{}", self.data)
    }

    /// The signal, of which the samples about the worst one are shown at first.
    pub fn close_up(&self) -> Figure {
        let from = self.worst().saturating_sub(CLOSE / 2);
        self.signal(from.min(self.measured.len().saturating_sub(CLOSE)), CLOSE)
    }

    /// An input of the same data.
    pub fn input(&self, name: &str, unit: &str, values: &[f64]) -> Figure {
        Figure::new("time [s]", &with_unit(name, unit))
            .titled(&format!("Input {name}{}", self.data))
            .height(130.0)
            .linked(&self.link())
            .line(Role::Free, name, self.timed(values))
    }

    /// The sample around which the first simulation is most wrong.
    pub fn worst(&self) -> usize {
        let Some((_, _, first)) = self.simulated.first() else { return 0 };
        let residual = self.residual(first);
        let finite = residual.iter().enumerate().filter(|(_, v)| v.is_finite());
        finite.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).map_or(0, |(k, _)| k)
    }

    /// The signal, of which so many samples from `from` on are shown at first.
    pub fn signal(&self, from: usize, samples: usize) -> Figure {
        let (name, unit) = self.output;
        let last = self.measured.len().saturating_sub(1);
        let mut figure = Figure::new("time [s]", &with_unit(name, unit))
            .titled(&format!("{name} over time{}", self.data))
            .linked(&self.link())
            .line(Role::Measured, "measured", self.timed(self.measured));
        if last > samples {
            let to = (from + samples).min(last);
            figure = figure.view(self.at(from), self.at(to));
        }
        for (role, label, values) in &self.simulated {
            let residual = self.residual(values);
            // where nothing was measured, the simulation is all there is to store
            let holed = residual.iter().zip(*values).any(|(r, v)| !r.is_finite() && v.is_finite());
            figure = match holed {
                true => figure.line(*role, label, self.timed(values)),
                false => figure.difference(*role, label, self.timed(self.measured), residual),
            };
        }
        figure
    }

    /// What the simulations leave, the whole record.
    pub fn left(&self) -> Figure {
        let (name, unit) = self.output;
        let mut figure = Figure::new("time [s]", &with_unit(&format!("residual of {name}"), unit))
            .titled(&format!("Residual of {name}{}: measured minus simulated", self.data))
            .linked(&self.link())
            .overview()
            .height(200.0);
        for (role, label, values) in &self.simulated {
            figure = figure.line(*role, label, self.timed(&self.residual(values)));
        }
        if self.borders.len() <= BORDERS {
            for &k in &self.borders {
                figure = figure.upright(Role::Quiet, "", self.at(k));
            }
        }
        figure
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn residuals_lie_under_signals_and_gaps_hide_no_simulation() {
        let measured = [1.0, f64::NAN, 3.0, 9.0];
        let model = [1.5, 2.0, 3.0, 4.0];
        let overlay = Overlay {
            output: ("y", "m"),
            step: 0.5,
            start: 0.0,
            measured: &measured,
            simulated: vec![(Role::Before, "model", &model)],
            borders: vec![],
            data: "",
        };
        assert_eq!(overlay.worst(), 3);
        let drawn = overlay.signal(0, 400).items[1].shape.points().unwrap().into_owned();
        assert_eq!(drawn, [(0.0, 1.5), (0.5, 2.0), (1.0, 3.0), (1.5, 4.0)]);
        let left = overlay.left().items[0].shape.points().unwrap().into_owned();
        assert!(left[0] == (0.0, -0.5) && left[1].1.is_nan() && left[3] == (1.5, 5.0));
    }
}
