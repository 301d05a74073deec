//! Effects hidden in data that have to be found, and what a diagnosis says beside its causes.
//!
//! One binary for all, because linking costs more than compiling.

mod accelerometer;
mod arm;
mod clocks;
mod data_faults;
mod disturbed;
mod equation_noise;
mod exam;
mod first_use;
mod hard_plants;
mod hidden_effect;
mod inverse_dynamics;
mod load_friction;
mod network;
mod noise_levels;
mod nulls;
mod onset;
mod other_plants;
mod plan;
mod report;
mod said;
mod sensor_in_loop;
mod shapeless;
mod step_load;
mod vehicles;
mod written_effect;
