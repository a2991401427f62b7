//! The command-line program: parse, call, exit code.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod cli;
mod live;
mod reproduce;
mod scene;

fn main() -> std::process::ExitCode {
    cli::main()
}
