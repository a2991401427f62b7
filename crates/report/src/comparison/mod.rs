//! Comparison of two results: the differences of their indices, and whether these exceed the errors of both.

mod charts;
mod document;
mod record;
mod settings;

pub use document::comparison_document;
pub use record::{
    CompareError, ComparedFactor, ComparedIndex, ComparedOutput, ComparedSide, ComparisonFile, NamedResult, OneSided,
    compare_results, shared_points,
};
pub use settings::SettingDifference;
