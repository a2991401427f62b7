//! The command-line program `apportion`: its commands, the reproduction of the papers, scenes in time, the trade-off of
//! accuracy and time, and live pages.

#![deny(clippy::disallowed_methods)]

mod commands;
mod failure;
mod reproduce;
mod scene;
pub mod trade;

pub use commands::main;
