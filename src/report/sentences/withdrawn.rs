//! What was found and taken back.

use crate::diagnose::Withdrawn;
use crate::digits::number;

/// Causes that the part of the records which was not fitted speaks against, beyond which they are told in one
/// sentence, and how many of them it names.
const MANY: usize = 4;

/// All causes that data refute.
pub(super) fn all_withdrawn(all: &[Withdrawn]) -> Vec<String> {
    let (by_test, by_part): (Vec<_>, Vec<_>) = all.iter().partition(|w| w.by_test);
    let mut lines: Vec<String> = by_test.into_iter().map(withdrawn).collect();
    if by_part.len() <= MANY {
        lines.extend(by_part.into_iter().map(withdrawn));
        return lines;
    }
    let places: Vec<String> = by_part.iter().map(|w| super::place_of(&w.cause)).collect();
    lines.push(format!(
        "Withdrawn: {}. The part of the records that was not fitted speaks against each of them; the \
         extended model has none.",
        super::names(&places, MANY)
    ));
    lines
}

/// A cause that data refute which were not fitted, and what the test data say to that.
pub fn withdrawn(withdrawn: &Withdrawn) -> String {
    let ratio = withdrawn.test_rmse_ratio;
    let (place, ratio_said) = (super::place_of(&withdrawn.cause), number(ratio, None));
    if withdrawn.by_test {
        let how = match ratio.is_finite() {
            true => format!("RMSE times {ratio_said} with it"),
            false => "with it the simulation leaves all bounds".into(),
        };
        return format!(
            "Withdrawn: {place}. The test data refute it: the extended model with it predicts them worse \
             than the model that was handed in ({how}), and does not have it."
        );
    }
    let test = if ratio > 1.0 { "and so do the test data" } else { "though the test data do not" };
    format!(
        "Withdrawn: {place}. The part of the records that was not fitted speaks against it, {test} (RMSE \
         times {ratio_said} with it); the extended model does not have it."
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::Cause;

    #[test]
    fn many_are_listed_in_one_sentence() {
        let named = |into: &str| Cause { into: into.into(), ..Cause::default() };
        let one = |i: usize| Withdrawn {
            cause: named(&format!("f{i}")),
            test_rmse_ratio: 1.1,
            by_test: i == 0,
        };
        let of = |count: usize| all_withdrawn(&(0..count).map(one).collect::<Vec<_>>());
        assert_eq!(of(5).len(), 5);
        let many = of(9);
        assert!(many[0].contains("The test data refute it"), "{many:?}");
        assert!(many[1].contains("f1") && many[1].contains("; and 4 more. The part"), "{many:?}");
        assert_eq!(many.len(), 2);
    }
}
