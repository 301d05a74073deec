//! The library: numbers, contracts of plug-ins, records, estimation, encoders, training; and the house rules.
//!
//! One binary for all, because linking costs more than compiling.

mod contract;
mod encoder;
mod files;
mod fitted_model;
mod fuzz;
mod house;
mod learned_part;
mod linear;
mod optimise;
mod paper_msd;
mod real;
mod records;
mod theory;
mod trainer;
mod training;
mod whole_sample;
