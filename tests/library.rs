//! The library: numbers, contracts of plug-ins, records, estimation; and the house rules.
//!
//! One binary for all, because linking costs more than compiling.

mod contract;
mod estimated;
mod files;
mod fitted_model;
mod fuzz;
mod house;
mod initial_state;
mod linear;
mod optimise;
mod real;
mod records;
mod results;
mod theory;
