//! Sobol' global sensitivity analysis.

pub mod afm;
mod analysis;
pub mod design;
pub mod estimate;
pub mod exchange;
pub mod model;
pub mod quantity;
pub mod report;
pub mod reproduce;
pub mod run;
pub mod space;
pub mod study;
pub mod sum;
pub mod uncertainty;

pub use analysis::analyse;
