//! What a run has found about one output: its indices, or why it has none, and how to find them by name.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use thiserror::Error;

use super::measures::RunMeasures;
use super::warning::Warning;
use crate::estimate::{CentralMoments, Undefined};
use crate::quantity::Unit;
use crate::uncertainty::{EffectEstimates, Estimate, OutputIndices, Stage};

/// What a run has found about one output. Values are in SI units.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct OutputAnalysis {
    /// The output's name.
    pub name: String,
    /// The unit in which it is reported.
    pub unit: Unit,
    /// Mean over all successful rows A and B; `None` if there is none.
    pub mean: Option<Estimate>,
    /// Variance over the same rows.
    pub variance: Option<Estimate>,
    /// Runs with a value.
    pub runs_ok: u64,
    /// Runs without one.
    pub runs_failed: u64,
    /// Base points that every index rests on at least: each uses those where its own runs have a value.
    pub base_points_used: u64,
    /// Why runs failed.
    pub failures: Vec<FailureCount>,
    /// The indices, or why there are none.
    pub indices: Result<OutputIndices, NoIndices>,
    /// The indices as they were at each half of the runs after it, the whole last.
    pub convergence: Vec<Stage>,
    /// What surrogates gained in a trial, where one decided on them.
    pub trial: Option<SurrogateTrial>,
    /// Moments and range of all successful rows A and B.
    pub values: CentralMoments,
    /// Of every replicate the outputs of its first rows A and B: A, B, A, B, ...; NaN where a run failed.
    pub samples: Vec<Vec<f64>>,
    /// Other measures of the influence of the factors, where the study asks for some; `None` too where the output does not vary, or too
    /// few runs have succeeded.
    pub measures: Option<RunMeasures>,
    /// What a careful reader should know.
    pub warnings: Vec<Warning>,
    /// Names of the factors and of the groups, in the order of their indices.
    pub(super) names: [Vec<String>; 2],
}

/// A trial of surrogates on the first runs of a quick model: all runs are corrected if it gains enough.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "study", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SurrogateTrial {
    /// Model runs in it.
    pub runs: u64,
    /// How many times smaller errors were with surrogates, of the first-order or the total indices, where it gains less.
    pub gain: f64,
    /// How many times smaller they must be.
    pub needed: f64,
}

/// A reason for which runs failed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "study", derive(schemars::JsonSchema), schemars(rename = "FailureRecord"))]
#[non_exhaustive]
pub struct FailureCount {
    /// The reason.
    pub reason: String,
    /// Number of runs.
    pub runs: u64,
    /// Row number of the first of them in the design.
    pub first_row: u64,
    /// The factor values of that row, in the units of the factors; nothing at points of SALib, whose inputs are not known.
    pub first_inputs: Map<String, Value>,
}

/// Why an output has no indices.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum NoIndices {
    /// More runs failed than the study allows.
    #[error(
        "{percent:.3} % of the runs failed, more than max_failed = {allowed} allows: what is left would not stand for the whole",
        percent = 100.0 * share
    )]
    TooManyFailed {
        /// The share of the runs that failed, from 0 to 1.
        share: f64,
        /// The share that may fail.
        allowed: f64,
    },
    /// The estimates do not exist.
    #[error(transparent)]
    Undefined(#[from] Undefined),
}

/// A name that a result does not have, or indices that an output does not have.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum LookupError {
    /// There is nothing of that name.
    #[error("there is no {what} `{name}`; there are: {known}", known = known.join(", "))]
    UnknownName {
        /// What the name should be of.
        what: &'static str,
        /// The name.
        name: String,
        /// The names that there are.
        known: Vec<String>,
    },
    /// The output has no indices.
    #[error("output `{output}` has no indices: {reason}")]
    NoIndices {
        /// The output.
        output: String,
        /// Why.
        reason: NoIndices,
    },
}

impl OutputAnalysis {
    /// The indices of the factor called `name`.
    ///
    /// # Errors
    /// [`LookupError`] if there is no such factor, or if the output has no indices.
    pub fn factor(&self, name: &str) -> Result<&EffectEstimates, LookupError> {
        self.effect("factor", name, &self.names[0], |indices| &indices.factors)
    }

    /// The indices of the group called `name`: the first-order one is closed, so it includes interactions in the group.
    ///
    /// # Errors
    /// As for [`factor`](Self::factor).
    pub fn group(&self, name: &str) -> Result<&EffectEstimates, LookupError> {
        self.effect("group", name, &self.names[1], |indices| &indices.groups)
    }

    fn effect(
        &self,
        what: &'static str,
        name: &str,
        known: &[String],
        of: fn(&OutputIndices) -> &Vec<EffectEstimates>,
    ) -> Result<&EffectEstimates, LookupError> {
        let unknown = || LookupError::UnknownName { what, name: name.to_owned(), known: known.to_vec() };
        let place = known.iter().position(|known| known == name).ok_or_else(unknown)?;
        let indices = self.indices.as_ref();
        let indices = indices.map_err(|&reason| LookupError::NoIndices { output: self.name.clone(), reason })?;
        of(indices).get(place).ok_or_else(unknown)
    }
}

/// Error of indices by rounding of the outputs beyond which a result warns of it.
pub(crate) const LOST: f64 = 1e-3;

/// Largest error of an index by the rounding of outputs with these moments; infinite of outputs that do not vary.
pub(super) fn error_of_rounding(values: &CentralMoments) -> f64 {
    let Some(((low, high), variance)) = values.range().zip(values.variance()) else { return f64::INFINITY };
    let largest = low.abs().max(high.abs());
    4.0 * (largest.next_up() - largest) / variance.sqrt()
}
