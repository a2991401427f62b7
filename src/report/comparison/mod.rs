//! Two results side by side: by how much their indices differ, and whether that is more than the errors of both.

mod charts;
mod document;
mod error;
mod index;
mod record;
mod settings;
#[cfg(test)]
mod tests;

pub use document::comparison_document;
pub use error::CompareError;
pub use index::ComparedIndex;
pub use record::{
    ComparedFactor, ComparedOutput, ComparedSide, ComparisonFile, NamedResult, OneSided, compare_results, shared_points,
};
pub use settings::SettingDifference;
