//! The coordinate z of a law w = f(z): where it is found, and its values along the record.

use crate::candidates::candidate::{Candidate, Wire};
use crate::effect::Mechanism;
use crate::fit::problem::{Grain, Model, Part, Problem};
use crate::prepare::operating_range::Nominal;

/// The source entry of a cause that is a curve of one coordinate.
pub(crate) fn source_of(problem: &Problem<'_>, cause: &Candidate) -> Option<usize> {
    let is_curve = cause.card.mechanism == Mechanism::Law
        && cause.card.states == 0
        && cause.also_of.is_empty();
    let of = cause.of.as_deref().filter(|of| is_curve && *of != "time")?;
    match cause.wire {
        Wire::Stage(_) | Wire::Path => problem.base.sources.find(of),
        _ => None,
    }
}

/// A law's coordinate along the record, where samples count; `None` where it is no curve of one.
pub(crate) fn along(
    problem: &Problem<'_>,
    nominal: &Nominal,
    model: &Model,
    cause: &Candidate,
    grain: Grain,
) -> Option<Vec<f64>> {
    let source = source_of(problem, cause)?;
    let z: Vec<f64> = match cause.wire {
        // on a path, the coordinate is what goes into it
        Wire::Path => nominal.series(source).to_vec(),
        _ => {
            let job = problem.job(model, grain)?;
            let run = problem.system.run_seen(&job.plan, &problem.drive, &job.lane);
            run.seen.into_iter().nth(source)?
        }
    };
    let counted = problem.samples(Part::All).filter_map(|k| z.get(k).copied());
    Some(counted.filter(|v| v.is_finite()).collect())
}
