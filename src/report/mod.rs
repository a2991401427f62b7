//! Exporters.

pub mod chart;
