//! Accuracy against time, and where accuracy ends.

pub mod extremes;
pub mod settings;
