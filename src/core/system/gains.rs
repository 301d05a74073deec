//! The instantaneous gain from what enters a model to what an effect can see: D = (dc/dx) G.
//!
//! One unit of w in a channel changes the derivatives by its column of G(x, u; theta), and a coordinate
//! c(x, u; theta) at the rate D = (dc/dx) G (the first Markov parameter of that pair: Kailath, "Linear
//! Systems", 1980).

use super::plan::Base;
use super::tables::Origin;
use crate::model::probe::{Along, Point, slope, unit};
use crate::model::{Ask, StateSpaceModel};

/// Change of the derivatives by one unit into a target of a model, at a point.
pub fn entering(
    model: &dyn StateSpaceModel,
    base: &Base,
    target: usize,
    point: &Point,
) -> Vec<f64> {
    let n = base.sizes;
    match base.targets.entries[target].1 {
        Origin::Own(i) if base.declared_channels => {
            slope(model, n, Ask::Derivative, point, Along::Channel(&unit(n.w, i)))
        }
        Origin::Own(i) => unit(n.x, i),
        Origin::Input(i) => slope(model, n, Ask::Derivative, point, Along::Input(&unit(n.u, i))),
        _ => vec![0.0; n.x],
    }
}

/// The rate at which a source changes along a change of the derivatives, at a point.
pub fn rate_along(
    model: &dyn StateSpaceModel,
    base: &Base,
    source: usize,
    point: &Point,
    column: &[f64],
) -> f64 {
    let n = base.sizes;
    match base.sources.entries[source].1 {
        Origin::State(i) => column[i],
        Origin::Own(i) if !base.declared_coordinates => column[i],
        Origin::Own(i) => slope(model, n, Ask::Coordinates, point, Along::State(column))[i],
        Origin::Output(o) => slope(model, n, Ask::Output, point, Along::State(column))[o],
        _ => 0.0,
    }
}
