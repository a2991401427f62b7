//! Indices from given data as JSON, CSV, text and charts.

mod chart;
mod record;
mod text;
mod words;

pub use chart::given_chart;
pub use record::{
    BinnedRecord, DependenceRecord, GivenFacts, GivenFile, GivenIndexRecord, GivenInputRecord, GivenOutputRecord,
    GivenProvenance, TableRecord, build_given, given_json,
};
pub use text::{given_csv, given_summary};
