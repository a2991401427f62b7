//! The command-line program `apportion`: its commands, the reproduction of the papers, scenes in time, the trade of accuracy
//! against time, and pages that compute.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod commands;
mod live;
mod reproduce;
mod scene;
pub mod trade;

pub use commands::main;
