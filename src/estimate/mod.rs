//! Sobol' indices from centred sums.
//!
//! [`Moments`] accumulate during the run; [`FirstOrder`], [`Total`] and [`second_order`] are the
//! formulas on these sums. Indices are the results of the
//! formulas, never clamped: a first-order index of -0.001 means that 0 is within its error.

mod aggregate;
mod base_moments;
mod central;
mod estimator;
mod formula;
mod indices;
mod moments;
mod of_one_index;
mod pair_moments;
mod parts;
mod point_outputs;
mod products;
mod quantities;
mod second_order;
mod shapley;
mod swap_moments;
mod workspace;

pub use aggregate::Scaling;
pub(crate) use aggregate::aggregated;
pub(crate) use base_moments::BaseMoments;
pub(crate) use central::CentralMoments;
pub use estimator::Estimator;
pub(crate) use indices::Indices;
pub use moments::{BlockOutputs, Moments};
pub use of_one_index::{FirstOrder, Total};
pub(crate) use parts::{MomentParts, PartShape, merged};
pub(crate) use point_outputs::PointOutputs;
pub(crate) use products::{ProductWork, Products};
pub(crate) use quantities::quantities;
pub use second_order::second_order;
use serde::{Deserialize, Serialize};
pub(crate) use shapley::{MAX_SHAPLEY_FACTORS, proper_subsets, shapley_effects};
pub(crate) use swap_moments::{BaMoments, SwapMoments};
use thiserror::Error;
pub use workspace::Workspace;

/// Why an output has no indices.
#[derive(Debug, Clone, Copy, PartialEq, Error, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "code", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Undefined {
    /// A `share` of the runs failed, more than the share that the study allows, both from 0 to 1.
    #[error(
        "{:.3} % of the runs failed, more than the {} % that are allowed: the other runs would not represent the factor space",
        100.0 * share,
        100.0 * allowed
    )]
    TooManyFailed { share: f64, allowed: f64 },
    /// Every base point lost at least one of its runs.
    #[error("fewer than two base points have all of their runs: no index can be estimated")]
    NoRuns,
    /// The output does not vary.
    #[error("the output has zero variance over the sample: no factor changes it, and indices are undefined")]
    ZeroVariance,
    /// The output varies by no more than its own rounding.
    #[error(
        "the output varies by no more than the rounding of its own size: subtract a constant from it before it is rounded"
    )]
    BelowRounding,
    /// The variance is too large or too small for a double.
    #[error("the variance of the output over- or underflows double precision: give the output in another unit")]
    Unrepresentable,
}

/// Returns the papers' percentages, 100 x_i / sum x; `None` if the sum is not positive: they have no meaning then.
pub(crate) fn shares(indices: &[f64]) -> Option<Vec<f64>> {
    let sum: f64 = indices.iter().sum();
    (sum > 0.0).then(|| indices.iter().map(|x| 100.0 * x / sum).collect())
}

#[cfg(test)]
mod tests;
