//! The results for one output, and access to its indices by name.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use thiserror::Error;

use super::warning::Warning;
#[cfg(feature = "schema")]
use super::with_text::WithText;
use super::with_text::{with_text, with_texts};
use super::{EstimatorRecord, Named, NoiseRecord, OutputDistribution, PairRecord, SurrogateRecord};
use crate::effect::IndexPair;
use crate::estimate::Undefined;
use crate::given::InputMeasures;
use crate::uncertainty::{EffectEstimates, Estimate, Interval, largest_half_width};

/// All results for one output.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OutputResult {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Mean over the rows A and B, in `unit`.
    pub mean: Option<f64>,
    /// Variance over the rows A and B, in the square of `unit`.
    pub variance: Option<f64>,
    /// Interval of the mean.
    pub mean_interval: Option<Interval>,
    /// Interval of the variance.
    pub variance_interval: Option<Interval>,
    /// Runs with a value.
    pub runs_ok: u64,
    /// Runs without a value.
    pub runs_failed: u64,
    /// Minimum number of base points of any estimate: each uses those at which its runs have a value.
    pub base_points_used: u64,
    /// Why runs failed.
    pub failures: Vec<FailureCount>,
    /// Sum of the first-order indices.
    pub sum_first_order: Option<Estimate>,
    /// Sum of the total indices.
    pub sum_total: Option<Estimate>,
    /// One entry per factor, or per group and factor without one (`indices_of`); `null` if indices are undefined.
    pub indices: Option<Vec<Named<EffectEstimates>>>,
    /// One entry per group; `null` if indices are undefined.
    pub groups: Option<Vec<Named<EffectEstimates>>>,
    /// One entry per subset that the study lists; `null` if indices are undefined.
    pub subsets: Option<Vec<Named<EffectEstimates>>>,
    /// Indices of a factor without effect, if one was added: the noise of the model.
    pub dummy: Option<EffectEstimates>,
    /// The noise of a stochastic model, which is not a factor, and the indices of the mean over it.
    pub noise: Option<NoiseRecord>,
    /// Other measures of influence, if requested; `null` if the output does not vary, or too few runs succeeded.
    pub measures: Option<RunMeasures>,
    /// Second-order indices of all pairs of factors, if requested.
    pub second_order: Option<Vec<PairRecord>>,
    /// Indices by the other estimators that the study lists.
    pub estimators: Vec<EstimatorRecord>,
    /// The use of surrogates; `null` without any.
    pub surrogate: Option<SurrogateRecord>,
    /// The indices and their intervals at stages of the run, without surrogates.
    pub convergence: Vec<StageRecord>,
    /// The distribution of its values in the rows A and B; `null` if no run succeeded, or if a number exceeds double precision.
    pub distribution: Option<OutputDistribution>,
    /// Its relation to its most influential factors; `null` without indices, or if a number exceeds double precision.
    pub scatter: Option<ScatterRecord>,
    /// Why there are no indices, if there are none.
    #[serde(serialize_with = "with_text")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<WithText<Undefined>>"))]
    pub reason: Option<Undefined>,
    /// Why its numbers may be wrong, or less accurate than they look.
    #[serde(serialize_with = "with_texts")]
    #[cfg_attr(feature = "schema", schemars(with = "Vec<WithText<Warning>>"))]
    pub warnings: Vec<Warning>,
}

impl OutputResult {
    /// Returns the indices of the factor called `name`.
    ///
    /// # Errors
    /// [`LookupError`] if there is no such factor, or if the output has no indices.
    pub fn factor(&self, name: &str) -> Result<&EffectEstimates, LookupError> {
        let indices = self.existing(self.indices.as_deref())?;
        Ok(&find("factor", name, indices, |index| &index.name)?.effect)
    }

    /// Returns the indices of the group called `name`: the first-order one is closed, with the group's interactions.
    ///
    /// # Errors
    /// As for [`factor`](Self::factor).
    pub fn group(&self, name: &str) -> Result<&EffectEstimates, LookupError> {
        let groups = self.existing(self.groups.as_deref())?;
        Ok(&find("group", name, groups, |group| &group.name)?.effect)
    }

    /// Returns half the width of the widest interval of a first-order or total index, or of a Shapley effect, of
    /// factors, the noise, groups and subsets; `None` without indices, or if one of them has no interval.
    pub fn largest_half_width(&self) -> Option<f64> {
        let named =
            self.indices.as_ref()?.iter().chain(self.groups.iter().flatten()).chain(self.subsets.iter().flatten());
        let effects = named.map(|named| &named.effect).chain(self.noise.iter().map(|noise| &noise.effect));
        largest_half_width(effects.flat_map(EffectEstimates::indices))
    }

    fn existing<'a, T>(&self, indices: Option<&'a [T]>) -> Result<&'a [T], LookupError> {
        indices.ok_or_else(|| LookupError::NoIndices { output: self.name.clone(), reason: self.reason })
    }
}

/// Returns the one of `all` called `name`.
pub(super) fn find<'a, T>(
    what: &'static str,
    name: &str,
    all: &'a [T],
    name_of: impl Fn(&T) -> &String,
) -> Result<&'a T, LookupError> {
    all.iter().find(|one| name_of(one) == name).ok_or_else(|| LookupError::UnknownName {
        what,
        name: name.to_owned(),
        existing: all.iter().map(|one| name_of(one).clone()).collect(),
    })
}

/// The indices at a stage of the run, with the given number of base points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct StageRecord {
    /// Total number of base points.
    pub base_samples: u64,
    /// Total number of model runs.
    pub model_runs: u64,
    /// Largest half width of the first-order and total indices of the factors and groups; `null` without intervals.
    pub largest_half_width: Option<f64>,
    /// First-order and total index of every factor.
    pub indices: Vec<Named<IndexPair<Estimate>>>,
}

/// The relation of an output to the factors with the largest total indices.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ScatterRecord {
    /// At most six factors, the largest total index first.
    pub factors: Vec<String>,
    /// At most 400 rows A, the first of every replicate: the values of `factors` in their units, then the output's in its
    /// own. Runs without a value are left out.
    pub points: Vec<Vec<f64>>,
    /// One entry for each of `factors`.
    pub conditional_means: Vec<ConditionalMeansRecord>,
}

/// Means of the output over slices of a factor: an estimate of E[Y | X_i], whose variance is the numerator of the
/// first-order index. They describe the scatter of the kept rows A and B; no index is computed from them.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ConditionalMeansRecord {
    /// The factor.
    pub factor: String,
    /// The median of each slice in the factor's unit, rising: 20 slices of equal probability, or each of the values of a
    /// discrete factor (of at most 50).
    pub x: Vec<f64>,
    /// Mean of the output over the slice in its unit; `null` without values there.
    pub mean: Vec<Option<f64>>,
    /// Mean minus 1.96 standard errors; `null` for fewer than two values.
    pub low: Vec<Option<f64>>,
    /// Mean plus 1.96 standard errors.
    pub high: Vec<Option<f64>>,
}

/// A reason for which runs failed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "FailureRecord"))]
#[non_exhaustive]
pub struct FailureCount {
    /// The reason.
    pub reason: String,
    /// Number of runs.
    pub runs: u64,
    /// Row number of the first of them in the design; none in a screening.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub first_row: Option<u64>,
    /// The factor values of that row, in the units of the factors.
    pub first_inputs: Map<String, Value>,
}

/// Other measures of one output.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "MeasuresRecord"))]
#[non_exhaustive]
pub struct RunMeasures {
    /// Number of rows A and B with a value: at most 4096.
    pub rows: usize,
    /// The measures of every factor but a noise.
    pub factors: Vec<InputMeasures>,
}

/// The error for a name that a result does not have, or indices that an output does not have.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum LookupError {
    /// The name of an output, factor or other part (`what`) is unknown.
    #[error("there is no {what} `{name}`; there are: {}", existing.join(", "))]
    UnknownName { what: &'static str, name: String, existing: Vec<String> },
    /// The output has no indices.
    #[error("output `{output}` has no indices: {}", reason.map_or("they were not estimated".to_owned(), |reason| reason.to_string()))]
    NoIndices { output: String, reason: Option<Undefined> },
}
