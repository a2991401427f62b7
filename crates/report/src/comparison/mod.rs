//! Comparison of two results: the differences of their indices, and whether these exceed the errors of both.

mod document;
mod record;

pub use document::comparison_document;
pub use record::SettingDifference;
pub use record::{
    CompareError, ComparedFactor, ComparedIndex, ComparedOutput, ComparedSide, ComparisonFile, NamedResult, OneSided,
    compare_results, shared_points,
};
