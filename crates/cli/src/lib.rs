//! The command-line program `apportion`: its commands, the trade-off of accuracy and time, and live pages.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod commands;
mod failure;
pub mod trade;

pub use commands::main;
