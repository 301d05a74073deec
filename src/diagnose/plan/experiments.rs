//! Other experiments with the same machine: the inputs of a record, changed.

use crate::fourier;
use crate::statistics::{deviation, mean};
use crate::system::Drive;

/// An experiment that differs by its inputs.
pub(super) struct Other {
    pub name: String,
    pub description: String,
    pub drive: Drive,
}

/// Level, offset and band of the inputs, one at a time.
pub(super) fn others(drive: &Drive) -> Vec<Other> {
    let changed = |how: &dyn Fn(&[f64]) -> Option<Vec<f64>>| -> Option<Drive> {
        let mut other = drive.clone();
        let mut moved = false;
        for input in &mut other.inputs {
            for segment in &drive.segments {
                let Some(now) = how(&input[segment.clone()]) else { continue };
                input[segment.clone()].copy_from_slice(&now);
                moved = true;
            }
        }
        moved.then_some(other)
    };
    let level = |by: f64| {
        changed(&|u| {
            let centre = mean(u);
            (deviation(u) > 0.0).then(|| u.iter().map(|v| centre + by * (v - centre)).collect())
        })
    };
    let offset = changed(&|u| {
        let by = deviation(u);
        (by > 0.0).then(|| u.iter().map(|v| v + by).collect())
    });
    let all = [
        ("level x0.5", "the same inputs at half their level", level(0.5)),
        ("level x2", "the same inputs at twice their level", level(2.0)),
        ("offset", "the same inputs about a point one standard deviation higher", offset),
        (
            "lower band",
            "inputs of the same size with the lower half of their frequencies only",
            changed(&|u| band(u, true)),
        ),
        (
            "upper band",
            "inputs of the same size with the upper half of their frequencies only",
            changed(&|u| band(u, false)),
        ),
    ];
    all.into_iter()
        .filter_map(|(name, description, drive)| {
            Some(Other { name: name.into(), description: description.into(), drive: drive? })
        })
        .collect()
}

/// The lines of a signal below (or above) the one that halves its power, at the same size.
fn band(u: &[f64], lower: bool) -> Option<Vec<f64>> {
    let (n, size, centre) = (u.len(), deviation(u), mean(u));
    if n < 16 || !(size > 0.0) {
        return None;
    }
    let (forward, back) = (fourier::forward(n), fourier::inverse(n));
    let mut time: Vec<f64> = u.iter().map(|v| v - centre).collect();
    let mut lines = forward.make_output_vec();
    forward.process(&mut time, &mut lines).ok()?;
    let total: f64 = lines.iter().map(|c| c.norm_sqr()).sum();
    let mut sum = 0.0;
    let half = lines.iter().position(|c| {
        sum += c.norm_sqr();
        sum >= 0.5 * total
    })?;
    for (i, line) in lines.iter_mut().enumerate() {
        if (i <= half) != lower {
            *line *= 0.0;
        }
    }
    let mut time = back.make_output_vec();
    back.process(&mut lines, &mut time).ok()?;
    let left = deviation(&time);
    // a single line has no other half
    let enough = left > 1e-9 * size * n as f64;
    enough.then(|| time.iter().map(|v| centre + v * size / left).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_of_a_band_keep_the_size_and_a_single_line_has_none() {
        let wave = |f: f64| move |k: usize| (std::f64::consts::TAU * f * k as f64 / 400.0).sin();
        let two: Vec<f64> = (0..400).map(|k| 3.0 + wave(5.0)(k) + wave(40.0)(k)).collect();
        for (lower, f) in [(true, 5.0), (false, 40.0)] {
            let half = band(&two, lower).unwrap();
            let size = deviation(&two);
            assert!((deviation(&half) - size).abs() < 1e-9 && (mean(&half) - 3.0).abs() < 1e-9);
            for (k, v) in half.iter().enumerate() {
                assert!((v - 3.0 - size * 2f64.sqrt() * wave(f)(k)).abs() < 1e-6, "{lower} {k}");
            }
        }
        let one: Vec<f64> = (0..400).map(wave(7.0)).collect();
        assert!(band(&one, true).is_some() && band(&one, false).is_none());
    }
}
