//! A screening: its record, its document and its charts.

mod document;
mod record;

pub use document::screening_document;
pub use record::{ScreeningFile, ScreeningProvenance, build_screening};
