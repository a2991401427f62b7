//! The result file: JSON that other programs can rely on.
//!
//! Format `apportion-result`, version 1, described key by key in `docs/result-format.md`. Later versions of the program
//! only add keys. Numbers are in the unit that stands beside them; a number that does not exist is `null`.

mod indices;
mod noise;
mod scatter;
mod series;
mod spending;
mod surrogate;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::distribution::OutputDistribution;
use crate::analysis::{FailureCount, LowRuns, RunMeasures, SurrogateTrial};
use crate::uncertainty::{EffectEstimates, Estimate, Interval};
pub use indices::*;
pub use noise::NoiseRecord;
pub use scatter::*;
pub use series::*;
pub use spending::{EffortRecord, RungRecord, SpendingRecord, StoppingRecord};
pub use surrogate::*;

/// The result of a run of apportion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(title = "apportion result")]
pub struct ResultFile {
    /// Always `apportion-result`.
    #[schemars(extend("const" = "apportion-result"))]
    pub format: String,
    /// Version of the format.
    #[schemars(extend("const" = 1))]
    pub version: u32,
    /// What was asked.
    pub study: StudyRecord,
    /// How it was answered.
    pub provenance: Provenance,
    /// The factors in the order of the study.
    pub factors: Vec<FactorRecord>,
    /// The outputs in the order of the study.
    pub outputs: Vec<OutputRecord>,
    /// Rows on which the model's assumptions do not hold; the rows count all the same.
    pub validity: Vec<ValidityRecord>,
    /// What a model with a ladder of fidelities spent; `null` for other models.
    #[serde(default)]
    pub effort: Option<EffortRecord>,
    /// Indices over all outputs together, if asked for.
    #[serde(default)]
    pub aggregate: Option<AggregateRecord>,
    /// The outputs that are series.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub series: Vec<SeriesRecord>,
    /// Why a growing run ended; `null` for one of fixed size.
    #[serde(default)]
    pub stopping: Option<StoppingRecord>,
    /// What a run that was asked for an accuracy chose, and why.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spending: Option<SpendingRecord>,
    /// Cheaper models that were run beside the model.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lows: Vec<LowRuns>,
}

/// What was asked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct StudyRecord {
    /// Name of the study.
    pub name: String,
    /// Title, if the study has one.
    pub title: Option<String>,
    /// Name of the model.
    pub model: String,
    /// The model's choices in force, such as `friction`.
    pub settings: serde_json::Map<String, serde_json::Value>,
    /// The model's inputs that are fixed in the study, with their units.
    pub constants: Vec<ConstantRecord>,
    /// Factors that depend on each other.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub dependences: Vec<CorrelationRecord>,
    /// Changes made on the command line, as given.
    pub overrides: Vec<String>,
    /// The study file, word for word.
    pub source: String,
}

/// Factors that depend on each other, by a Gaussian copula.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct CorrelationRecord {
    /// The factors.
    pub factors: Vec<String>,
    /// Their correlations.
    pub correlation: Vec<Vec<f64>>,
    /// What they are correlations of, by its name in study files.
    pub measure: String,
}

/// An input fixed in the study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct ConstantRecord {
    /// The input.
    pub name: String,
    /// Its value in `unit`.
    pub value: f64,
    /// The unit.
    pub unit: String,
}

/// How the answer came about. A result is cited by `apportion_version`, `seed` and `study_sha256`, and by the `overrides` of its
/// study if it has some: they give the same numbers again. `CITATION.cff` in the sources of the program says how to cite
/// the program itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct Provenance {
    /// Version of the program.
    pub apportion_version: String,
    /// Seed of the design.
    pub seed: u64,
    /// Sampler of the design.
    pub sampler: String,
    /// Base points in all.
    pub base_samples: u64,
    /// Independent randomisations that share them.
    pub replicates: u64,
    /// Runs of each base point at points of their own, for surrogates alone.
    #[serde(default)]
    pub plain_rows: u32,
    /// Runs of the model.
    pub model_runs: u64,
    /// Threads used.
    pub threads: usize,
    /// Seconds from the first run to the last.
    pub wall_seconds: f64,
    /// SHA-256 of the study file as it lies on disk, in hexadecimal.
    pub study_sha256: String,
    /// Formula of the first-order indices.
    pub first_order_estimator: String,
    /// Formula of the total indices.
    pub total_estimator: String,
    /// How Shapley effects were found, as in study files; absent where there are none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shapley_method: Option<String>,
    /// What the intervals are, in words; `null` if there are none.
    pub interval: Option<String>,
    /// The kind of interval by its name in study files.
    #[serde(default)]
    pub interval_method: String,
    /// The total index above which a factor counts as one that matters.
    #[serde(default)]
    pub threshold: f64,
    /// The files of the model that a journal knows: the runs of a journal are not used once one of them has changed.
    #[serde(default)]
    pub model_files: Vec<String>,
}

/// A factor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct FactorRecord {
    /// Its name.
    pub name: String,
    /// The unit of its values.
    pub unit: String,
    /// Its group, if any.
    pub group: Option<String>,
    /// Its distribution by name, with the parameters in `unit`.
    pub distribution: serde_json::Value,
    /// Its nominal value in `unit`.
    pub nominal: f64,
}

/// Everything about one output.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct OutputRecord {
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
    /// Runs without one.
    pub runs_failed: u64,
    /// Base points that every estimate rests on at least: each uses those where its own runs have a value.
    pub base_points_used: u64,
    /// Why runs failed.
    pub failures: Vec<FailureCount>,
    /// Sum of the first-order indices.
    pub sum_first_order: Option<Estimate>,
    /// Sum of the total indices.
    pub sum_total: Option<Estimate>,
    /// One entry per factor; `null` where indices are undefined.
    pub indices: Option<Vec<IndexRecord>>,
    /// One entry per group; `null` where indices are undefined.
    pub groups: Option<Vec<GroupRecord>>,
    /// One entry per subset that the study lists; `null` where indices are undefined.
    #[serde(default)]
    pub subsets: Option<Vec<SubsetRecord>>,
    /// Indices of a factor that does nothing, if one was run along: the noise of the model.
    #[serde(default)]
    pub dummy: Option<EffectEstimates>,
    /// The noise of a stochastic model, which is none of the factors, and what is known of the mean over it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise: Option<NoiseRecord>,
    /// Shapley effects of the groups and of the factors that have none, where these are the players: they sum to 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shapley_groups: Option<Vec<PlayerRecord>>,
    /// Other measures of the influence of the factors, if asked for; absent too where the output does not vary, or too few runs have
    /// succeeded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub measures: Option<RunMeasures>,
    /// Second-order indices of all pairs of factors, if asked for.
    #[serde(default)]
    pub second_order: Option<Vec<PairRecord>>,
    /// Indices by the other estimators that the study lists.
    #[serde(default)]
    pub estimators: Vec<EstimatorRecord>,
    /// What surrogates did to the indices; `null` without any.
    #[serde(default)]
    pub surrogate: Option<SurrogateRecord>,
    /// What surrogates gained in a trial, where one decided on them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub surrogate_trial: Option<SurrogateTrial>,
    /// How the indices and their intervals changed as the run grew, without surrogates.
    #[serde(default)]
    pub convergence: Vec<StageRecord>,
    /// How its values are distributed; `null` if no run succeeded, or if a number is beyond double precision.
    #[serde(default)]
    pub distribution: Option<DistributionRecord>,
    /// How it goes with its most influential factors; `null` without indices, or if a number is beyond double precision.
    #[serde(default)]
    pub scatter: Option<ScatterRecord>,
    /// Why there are no indices, where there are none.
    pub reason: Option<String>,
    /// What a careful reader should know.
    pub warnings: Vec<String>,
    /// The kind of each warning, a name that stays the same.
    #[serde(default)]
    pub warning_codes: Vec<String>,
}

/// How the values of an output are distributed, as far as the rows A and B tell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct DistributionRecord {
    /// Values that mean, standard deviation, skewness, kurtosis and range rest on: those of all rows A and B.
    pub values: u64,
    /// The rest; quantiles, histogram and density rest on the `count` values that were kept, the first of every replicate.
    #[serde(flatten)]
    pub sample: OutputDistribution,
}

/// The indices as they were when the run had so many base points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct StageRecord {
    /// Base points in all.
    pub base_samples: u64,
    /// Model runs in all.
    pub model_runs: u64,
    /// Largest half width of the first-order and total indices of the factors and groups; `null` without intervals.
    pub largest_half_width: Option<f64>,
    /// First-order and total index of every factor.
    pub indices: Vec<PlainIndexRecord>,
}

/// Indices over several outputs together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct AggregateRecord {
    /// The outputs.
    pub outputs: Vec<String>,
    /// How outputs are weighed against each other, in words.
    pub weighting: String,
    /// One entry per factor; `null` where an output has no indices.
    pub indices: Option<Vec<PlainIndexRecord>>,
    /// The noise of a stochastic model, which is none of the factors.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise: Option<PlainIndexRecord>,
    /// Why there are none.
    pub reason: Option<String>,
}

/// A validity flag.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct ValidityRecord {
    /// Its name.
    pub flag: String,
    /// What it means.
    pub description: String,
    /// Runs that raised it.
    pub runs: u64,
    /// Those runs as a share of all runs, 0 to 1.
    pub share: f64,
}
