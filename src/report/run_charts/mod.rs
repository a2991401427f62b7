//! Charts of a run besides that of the shares, all from the result alone: the indices, what acts together, also two by two, the output
//! over its factors, how it is distributed, how the indices settled, and many outputs or a series at a glance.

mod categories;
mod convergence;
mod distribution;
mod indices;
mod map;
mod pairs;
mod scatter;
mod series;
mod slice_means;

pub use convergence::convergence_chart;
pub use distribution::distribution_chart;
pub use indices::{indices_chart, interactions_chart};
pub(super) use map::{map_chart, overall_order, together_chart};
pub use pairs::pairs_chart;
pub use scatter::scatter_chart;
pub(super) use series::{SeriesOf, along_chart, layers_chart};

use super::format::name;
use super::result::{OutputRecord, ResultFile};

fn headline(result: &ResultFile) -> &str {
    result.study.title.as_deref().unwrap_or(&result.study.name)
}

/// The caption of a chart that has nothing to show.
fn no_indices(output: &OutputRecord) -> String {
    let reason = output.reason.as_deref().unwrap_or("the result holds none");
    format!("No indices of {}: {reason}.", name(&output.name))
}

#[cfg(test)]
mod tests;
