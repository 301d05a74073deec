//! Shapes of what a model may lack, and how they are written.
//!
//! An effect is a shape: w = law(z), a curve of one coordinate, perhaps with states of
//! its own. Placed at (into, of) it becomes a block of the continuous-time interconnection:
//! z is a row of S_zx, w enters by a column of S_xw.

mod card;
mod curve;
mod declare;
mod definition;
mod error;
mod law;
mod properties;
mod role;
mod search;
mod unit;
mod view;
mod written;

pub use card::{EffectCard, EffectParameter, Named, Needs, Places, SignRule};
pub use law::{Arguments, CandidateEffect, Effect};
pub use properties::{Begins, ShapeOf, Size};
pub use search::Search;
pub use unit::UnitRule;
pub use view::View;

// machinery that sibling crates and the program share; it may change at any time
#[doc(hidden)]
pub use self::{
    card::Mechanism,
    curve::curve,
    definition::{DefinedParameter, DefinedRole, Definition},
    error::{DefinitionError, DefinitionProblem},
    law::{EffectBlock, EffectCall, Shape},
    properties::Properties,
    role::Role,
    written::WrittenEffect,
};
