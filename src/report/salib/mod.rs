//! Indices at the points of SALib as JSON, CSV, text and a chart.

mod record;
mod text;

pub use record::{
    SalibFacts, SalibFile, SalibIndexRecord, SalibOutputRecord, SalibPairRecord, SalibProvenance, SalibTableRecord,
    build_salib, salib_json,
};
pub use text::{salib_chart, salib_csv, salib_summary};
