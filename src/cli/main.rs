//! The program; see `lacuna --help`.

fn main() -> std::process::ExitCode {
    lacuna_cli::main()
}
