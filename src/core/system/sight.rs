//! What effects look at in one instant, and where it is found.

use crate::model::LaneNumber;

use super::plan::Plan;
use super::tables::Origin;

/// Where an entry of the source table is found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Found {
    State(usize),
    Own(usize),
    Input(usize),
    Output(usize),
    Time,
}

/// Everything that effects look at in one instant: this group's share.
pub struct Sight<'b, R> {
    pub x: &'b [R],
    pub u: &'b [R],
    pub coordinates: &'b [R],
    pub outputs: &'b [R],
    pub time: R,
    /// Values per pack of the four above.
    pub sizes: [usize; 4],
}

impl<R: LaneNumber> Sight<'_, R> {
    /// The value at a place, for one pack.
    #[inline(always)]
    pub fn at(&self, pack: usize, found: Found) -> &R {
        let [nx, nu, nz, ny] = self.sizes;
        match found {
            Found::State(i) => &self.x[pack * nx + i],
            Found::Input(i) => &self.u[pack * nu + i],
            Found::Own(i) => &self.coordinates[pack * nz + i],
            Found::Output(i) => &self.outputs[pack * ny + i],
            Found::Time => &self.time,
        }
    }
}

/// Where an entry of the source table is found in a plan: own coordinates that are states
/// are read where they are.
pub fn find(plan: &Plan, entry: usize) -> Found {
    match plan.sources.entries[entry].1 {
        Origin::Own(i) => plan.own_state[i].map_or(Found::Own(i), Found::State),
        Origin::Input(i) => Found::Input(i),
        Origin::Output(i) => Found::Output(i),
        Origin::Time => Found::Time,
        Origin::State(i) => Found::State(i),
    }
}
