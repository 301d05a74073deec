//! A coordinate as the baseline sees it: what grids of shapes are made from.

/// The course of one coordinate along the baseline's simulation.
#[derive(Debug, Clone)]
pub struct View {
    sorted: Vec<f64>,
    /// Root mean square, in the coordinate's unit.
    pub rms: f64,
    /// Root mean square of its rate of change, per s.
    pub rate_rms: f64,
    /// Ratio of the output's spread to that of its rate, in s: how fast the plant moves.
    pub time_scale: f64,
    /// Angular frequencies worth trying, in rad/s.
    pub frequencies: Vec<f64>,
    /// Strongest lines of the present residual, in rad/s.
    pub lines: Vec<f64>,
    /// Sampling time in s.
    pub sampling_time: f64,
    /// First value of the coordinate; of time, when the record begins.
    pub first: f64,
    /// Length of the record in s.
    pub duration: f64,
    /// Whether the coordinate is time itself.
    pub is_time: bool,
    /// Whether the effect acts on its own path.
    pub own_path: bool,
}

impl View {
    /// A view of the values a coordinate took; values that are not finite are left out.
    pub fn new(values: &[f64], sampling_time: f64) -> Self {
        let mut sorted: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let count = sorted.len().max(1) as f64;
        let rms = (sorted.iter().map(|v| v * v).sum::<f64>() / count).sqrt();
        let steps = values.windows(2).map(|w| (w[1] - w[0]) / sampling_time);
        let (mut sum, mut n) = (0.0, 0.0);
        for rate in steps.filter(|r| r.is_finite()) {
            sum += rate * rate;
            n += 1.0;
        }
        let rate_rms = if n > 0.0 { (sum / n).sqrt() } else { 0.0 };
        Self {
            sorted,
            rms,
            rate_rms,
            time_scale: sampling_time,
            frequencies: vec![],
            lines: vec![],
            sampling_time,
            first: values.first().copied().filter(|v| v.is_finite()).unwrap_or(0.0),
            duration: values.len() as f64 * sampling_time,
            is_time: false,
            own_path: false,
        }
    }

    /// Where a coordinate may be counted from: its 0, and where it begins if that is elsewhere.
    pub fn origins(&self) -> Vec<f64> {
        if self.first == 0.0 { vec![0.0] } else { vec![0.0, self.first] }
    }

    /// The value below which a share `q` of all values lie.
    pub fn quantile(&self, q: f64) -> f64 {
        quantile(&self.sorted, q)
    }

    /// The magnitude below which a share `q` of all magnitudes lie.
    pub fn magnitude(&self, q: f64) -> f64 {
        let mut magnitudes: Vec<f64> = self.sorted.iter().map(|v| v.abs()).collect();
        magnitudes.sort_by(f64::total_cmp);
        quantile(&magnitudes, q)
    }

    /// Smallest value.
    pub fn min(&self) -> f64 {
        self.sorted.first().copied().unwrap_or(0.0)
    }

    /// Largest value.
    pub fn max(&self) -> f64 {
        self.sorted.last().copied().unwrap_or(0.0)
    }

    /// Spread between the 1 % and the 99 % quantile.
    pub fn range(&self) -> f64 {
        self.quantile(0.99) - self.quantile(0.01)
    }

    /// Smallest and largest width of a jump at zero, such as that of dry friction. What sticks creeps, at a speed in
    /// proportion to the width, for as long as it sticks: a record tells widths that are far below its motion.
    pub fn widths(&self) -> (f64, f64) {
        (1e-4 * self.rms, self.rms)
    }

    /// Whether the coordinate takes both signs.
    pub fn changes_sign(&self) -> bool {
        self.min() < 0.0 && self.max() > 0.0
    }
}

/// Linear interpolation between order statistics.
fn quantile(sorted: &[f64], q: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return 0.0 };
    let position = q.clamp(0.0, 1.0) * last as f64;
    let low = position.floor() as usize;
    let high = (low + 1).min(last);
    sorted[low] + (sorted[high] - sorted[low]) * (position - low as f64)
}
