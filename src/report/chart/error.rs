//! What is wrong with a chart's data.

use thiserror::Error;

/// Data that do not make a chart.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ChartError {
    /// A figure without panels.
    #[error("the chart {chart:?} has no panel, it needs at least one")]
    NoPanels {
        /// Title of the chart.
        chart: String,
    },
    /// A series of the wrong length.
    #[error("series {series:?} of panel {panel:?} has {found} {what}, but needs {expected}")]
    Length {
        /// Title of the panel.
        panel: String,
        /// Name of the series.
        series: String,
        /// What the series holds.
        what: &'static str,
        /// The length that it needs.
        expected: usize,
        /// Length of the list.
        found: usize,
    },
}
