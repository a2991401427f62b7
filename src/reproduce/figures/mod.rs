//! Every figure that the papers draw from computation, drawn from ours.

use crate::report::chart::Chart;

/// One figure of the papers, from our computation.
#[derive(Clone, Debug, PartialEq)]
pub struct PaperFigure {
    /// Name of its files without extension, and its anchor on the page, such as `chk-6`.
    pub stem: &'static str,
    /// What it is called, such as `CHK fig. 6`.
    pub label: &'static str,
    /// What the paper's figure shows, in a short statement.
    pub theirs: &'static str,
    /// Ours.
    pub chart: Chart,
    /// Our data.
    pub csv: String,
}
