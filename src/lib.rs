//! Sobol' global sensitivity analysis.

pub mod afm;
pub mod design;
pub mod quantity;
pub mod report;
pub mod space;
pub mod sum;
