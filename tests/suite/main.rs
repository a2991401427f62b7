//! Tests of the whole: one program, so that it is linked once.

mod afm;
mod cli;
mod common;
mod engine;
mod files;
mod given;
mod messages;
mod report;
