//! Indices at the points of SALib: their record, their document and their chart.

mod chart;
mod document;
mod record;

pub use chart::salib_chart;
pub use document::{file_names, salib_document};
pub use record::{
    SalibFacts, SalibFile, SalibIndexRecord, SalibOutputRecord, SalibPairRecord, SalibProvenance, SalibTableRecord,
    build_salib,
};
