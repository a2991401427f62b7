//! Tables of runs that exist.

mod coverage;
mod given_data;
mod given_surrogate;
mod run_measures;
mod tables;
