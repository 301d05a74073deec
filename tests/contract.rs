//! What every plug-in promises, tested for all that are registered.

mod drifting;
mod extended;
mod files;
mod learned;
mod neutral;
mod numbers;
mod refusals;
mod shelf;
mod slopes;
