//! Finds what a simulation gets wrong, names it and measures the gain.

mod candidate;
mod dependence;
mod library;
mod nominal;
mod nuisance;
mod problem;
mod screen;
mod search;
mod spectrum;
mod spikes;
mod stage;
mod statistics;

pub use search::Watch;
