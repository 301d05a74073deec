//! The program as a user types it.
//!
//! One binary for all, because linking costs more than compiling.

mod cli;
#[path = "../src/cli/command_line.rs"]
mod command_line;
mod exam_cli;
mod exam_machines;
mod interrupts;
mod pendulum;
mod rehearse;
mod several_causes;
mod training_cli;
