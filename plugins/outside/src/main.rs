//! A program of one's own: every verb of `lacuna`, with the plug-ins of this crate in it.

use lacuna_outside as _;

fn main() -> std::process::ExitCode {
    lacuna_cli::main()
}
