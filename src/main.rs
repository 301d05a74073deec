//! The program; see `lacuna --help`.

fn main() -> std::process::ExitCode {
    lacuna::cli::main()
}
