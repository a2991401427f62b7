//! The command-line program: parse, call, exit code.

mod cli;
mod reproduce;
mod scene;

fn main() -> std::process::ExitCode {
    cli::main()
}
