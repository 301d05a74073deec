//! Runs of equal readings: what stands still, is cut off, or fell to one value.

/// A stretch of equal values.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stretch {
    pub from: usize,
    pub to: usize,
    pub value: f64,
}

/// All stretches of equal values of a series, one after the other.
pub(crate) fn stretches(y: &[f64]) -> Vec<Stretch> {
    let mut all: Vec<Stretch> = vec![];
    for (k, &value) in y.iter().enumerate() {
        match all.last_mut() {
            Some(last) if last.value == value && last.to == k => last.to = k + 1,
            _ if value.is_finite() => all.push(Stretch { from: k, to: k + 1, value }),
            _ => {}
        }
    }
    all
}
