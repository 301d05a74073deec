//! The program as a user types it.
//!
//! One binary for all, because linking costs more than compiling.

mod cli;
mod interrupts;
mod pendulum;
mod several_causes;
mod training_cli;
