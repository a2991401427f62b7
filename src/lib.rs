//! Sobol' global sensitivity analysis.

pub mod afm;
pub mod quantity;
pub mod report;
pub mod space;
