//! What enters a balance of the outputs at once: entries of D around points of the record.
//!
//! A balance is an output equation of its own, see `system::balances`. Two places
//! whose columns of (G; D) are parallel are one for everything that is measured.

use crate::model::probe::{Along, Point, slope, unit};
use crate::model::{Ask, Sizes, StateSpaceModel};
use crate::system::{Base, Origin};

/// Per entry of the table of targets the slopes of all balances at every point; 0 for other outputs.
pub(crate) fn direct(model: &dyn StateSpaceModel, base: &Base, points: &[Point]) -> Vec<Vec<f64>> {
    let (sizes, is) = (base.sizes, &base.output_equations.balances);
    let own = |o: usize, slope: f64| if is[o] { slope } else { 0.0 };
    let at = |origin: Origin, point: &Point| -> Vec<f64> {
        match origin {
            Origin::Input(i) if is.contains(&true) => input(model, sizes, i, point)
                .into_iter()
                .enumerate()
                .map(|(o, d)| own(o, d))
                .collect(),
            Origin::Output(i) => (0..sizes.y).map(|o| own(o, f64::from(o == i))).collect(),
            _ => vec![0.0; sizes.y],
        }
    };
    let all = |origin: Origin| points.iter().flat_map(|point| at(origin, point)).collect();
    base.targets.entries.iter().map(|(_, origin)| all(*origin)).collect()
}

/// Slopes of the outputs by an input.
fn input(model: &dyn StateSpaceModel, sizes: Sizes, i: usize, point: &Point) -> Vec<f64> {
    slope(model, sizes, Ask::Output, point, Along::Input(&unit(sizes.u, i)))
}
