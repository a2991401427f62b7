//! Charts of a run in addition to that of the shares, all from the result alone: the indices, also of pairs, the output
//! against its factors, its distribution, the convergence of the indices, and an overview of many outputs or a series.

mod categories;
mod convergence;
mod distribution;
mod indices;
mod map;
mod pairs;
mod scatter;
mod series;

pub use convergence::convergence_chart;
pub use distribution::distribution_chart;
pub use indices::indices_chart;
pub(super) use map::{map_chart, overall_order, together, together_chart};
pub use pairs::pairs_chart;
pub use scatter::scatter_chart;
pub(super) use series::{SeriesOf, along_chart};
