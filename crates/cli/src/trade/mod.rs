//! Accuracy against time, and the behaviour of models at the extremes of their inputs.

pub mod extremes;
pub mod settings;
