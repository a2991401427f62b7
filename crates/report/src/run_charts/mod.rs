//! Charts of a run in addition to that of the shares, all from the result alone: the indices, also of pairs, the output
//! against its factors, its distribution, the convergence of the indices, and an overview of many outputs or a series.

mod map;
mod pairs;
mod scatter;

pub(super) use map::{along_chart, map_chart, overall_order, together_chart};
pub use pairs::convergence_chart;
pub use pairs::indices_chart;
pub use pairs::pairs_chart;
pub use scatter::distribution_chart;
pub use scatter::scatter_chart;
