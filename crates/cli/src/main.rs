//! The command-line program, a call of the library.

fn main() -> std::process::ExitCode {
    apportion_cli::main()
}
