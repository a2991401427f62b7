//! Factor spaces.

pub mod distribution;
