//! `-h` is short and `--help` long: of what stands below the options, the first keeps the examples.

use clap::{Command, CommandFactory};

use super::Args;

/// The program's commands, each with a short and a long help.
pub fn command() -> Command {
    Args::command().mut_subcommands(two_lengths)
}

/// A command whose help has two lengths, where anything stands below its examples.
fn two_lengths(command: Command) -> Command {
    let command = command.mut_subcommands(two_lengths);
    let Some(whole) = command.get_after_help().cloned() else { return command };
    let text = whole.to_string();
    match text.split_once("\n\n") {
        Some((examples, _)) => command.after_help(examples.to_string()).after_long_help(whole),
        None => command,
    }
}
