//! Indices from given data: their record, their document and their chart.

mod document;
mod measures;
mod record;
mod sentences;

pub use document::given_document;
pub(super) use measures::{agreement, table as measures_table};
pub use record::{
    GivenFacts, GivenFile, GivenInputRecord, GivenOutputRecord, GivenProvenance, GivenSurrogateRecord, SurrogateResult,
    TableRecord, build_given,
};
