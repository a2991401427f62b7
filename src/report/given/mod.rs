//! Indices from given data: their record, their document and their chart.

mod chart;
mod document;
mod measures;
mod record;
mod sentences;
mod surrogate;

pub use super::result::measures::{GivenMeasuresRecord, MeasuredRecord};
pub use chart::given_chart;
pub use document::given_document;
pub(super) use measures::{agreement, table as measures_table};
pub use record::{
    BinnedRecord, ColumnLeftOut, DependenceRecord, GivenFacts, GivenFile, GivenIndexRecord, GivenInputRecord,
    GivenOutputRecord, GivenProvenance, TableRecord, build_given,
};
pub use surrogate::{GivenSurrogateIndex, GivenSurrogateOutput, GivenSurrogateRecord, SurrogateResult};
