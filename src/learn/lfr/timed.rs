//! Whether a law depends on the time itself.

use crate::model::probe::value;
use crate::model::{Ask, Law, Sizes};

/// Whether a law gives other answers at other times, tried at times from a millisecond to a
/// year and a handful of points.
pub(super) fn looks_at_time(law: &dyn Law) -> bool {
    let sizes = Sizes::of(&law.signals());
    crate::system::points(law, 3).into_iter().any(|mut point| {
        [Ask::Derivative, Ask::Output].into_iter().any(|ask| {
            point.time = 0.0;
            let first = value(law, sizes, ask, &point);
            (0..35).any(|power| {
                point.time = 1e-3 * 2.0_f64.powi(power);
                let other = value(law, sizes, ask, &point);
                first.iter().zip(&other).any(|(a, b)| a.to_bits() != b.to_bits())
            })
        })
    })
}
