//! Noise inside the plant in words.

use crate::diagnose::{Disturbance, Disturbs};
use crate::digits::{percent, with_unit};

/// What disturbs the plant beside its causes, and what that means for simulations.
pub(super) fn inside(all: &[Disturbance]) -> String {
    let said: Vec<String> = all.iter().map(one).collect();
    format!(
        "The plant itself is disturbed: {}. Causes were judged by what a predictor does not foresee, \
         which such noise leaves white; a simulation drifts by it, whatever it is extended by.",
        said.join("; ")
    )
}

/// How probable it is that parameters are off which no cause names, and what that does to standard errors.
pub(super) fn doubted(doubt: f64, prior: f64) -> String {
    let probable = if doubt > 0.995 { "> 99 %".into() } else { percent(doubt) };
    format!(
        "Parameters that are not named may be wrong, too ({probable} probable), though none of them alone is sure: the \
         standard errors allow for it (prior: {}). Estimate them before, or hold with --fix those that you are sure of.",
        percent(prior)
    )
}

fn one(of: &Disturbance) -> String {
    let size = with_unit(of.size, &of.unit);
    let place = &of.place;
    match of.kind {
        Disturbs::White => format!("a random force of {size} on {place} that nothing explains"),
        Disturbs::Slow => {
            format!("a slow force on {place} that changes by {size} from sample to sample")
        }
        Disturbs::Cycle { period } => format!(
            "a force on {place} of a narrow band, as of waves, {size} (standard deviation) with a period of about {}",
            with_unit(period, "s")
        ),
        Disturbs::Wander => {
            format!("the reading of {place} wanders by {size} from sample to sample")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_disturbance_has_its_size_and_place() {
        let of = |kind, place: &str| Disturbance {
            place: place.into(),
            kind,
            size: 2.7,
            unit: "N".into(),
        };
        let said = inside(&[of(Disturbs::White, "carriage"), of(Disturbs::Wander, "encoder")]);
        assert!(said.contains(&format!("force of {} on carriage", with_unit(2.7, "N"))), "{said}");
        assert!(said.contains("reading of encoder wanders by"), "{said}");
        let said = inside(&[of(Disturbs::Cycle { period: 4.3 }, "buoy")]);
        assert!(said.contains(&format!("period of about {}", with_unit(4.3, "s"))), "{said}");
    }

    #[test]
    fn doubt_says_how_large_it_is() {
        assert!(doubted(0.42, 0.15).contains("(42 % probable)"));
        assert!(doubted(0.9999, 0.15).contains("(> 99 % probable)"));
    }
}
