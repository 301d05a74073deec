//! The search: which causes, with what probability.
//!
//! ```text
//! model <- nothing                                       fitted with its disturbance as a nuisance
//! repeat  dictionary <- tangents and secants of every candidate about model
//!         moves <- take out 0 to 3 causes, put in the best one or two (one matrix of products)
//!         fit the leading moves, racing; model <- the most probable of all that were fitted
//! until nothing is promising
//! fit the neighbours of the model: same place, same law (with the shape it has), same coordinate; repeat if one is better
//! where a place needs several laws: a free curve in their place, every law by regression on it; repeat
//! the same with parameters free, where that is near; laws without a name, where something is left
//! ```
//!
//! Everything is judged by the posterior alone (`evidence`); the thresholds stand in `criteria`.

pub(crate) mod starts;

mod beam;
mod begin;
mod carried;
mod chain;
mod contribution;
mod dictionary;
mod fits;
#[cfg(test)]
pub(crate) mod fixture;
mod instead;
mod item;
mod laws;
mod leading;
mod metric;
mod moments;
mod moves;
mod nameless;
mod neighbours;
mod open_loop;
mod put_back;
mod ranked;
mod run;
mod selected;
mod study;
mod veto;

pub(crate) use run::{BreaksOff, Searched, search};
