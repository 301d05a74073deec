//! Where the results of a call are from.

use std::path::Path;

use lacuna::report::Provenance;

use super::command_line::command;
use super::failure::Failure;

/// Program, command and seed of this call; files are to be added.
pub fn of_this_call(seed: u64) -> Provenance {
    let program = concat!("lacuna ", env!("CARGO_PKG_VERSION"));
    let words = std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned());
    Provenance::new(program, &command(words), seed)
}

/// The same with a file; what is no file, a pipe, has no checksum.
pub fn with(from: Provenance, role: &str, path: &Path) -> Result<Provenance, Failure> {
    if !path.is_file() {
        return Ok(from);
    }
    from.file(role, path)
        .map_err(|error| Failure::work(format!("{}: cannot be read ({error})", path.display())))
}
