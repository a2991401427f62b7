//! The result file: JSON that other programs can rely on.
//!
//! Format `apportion-result`, version 1, described key by key in `docs/result-format.md`. Later versions of the program
//! only add keys. Numbers are in the unit that stands beside them; a number that does not exist is `null`.

mod indices;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::distribution::OutputDistribution;
use crate::analysis::{FailureCount, LowRuns, RunMeasures, SurrogateTrial};
use crate::uncertainty::{EffectEstimates, Estimate, Interval};
pub use indices::*;

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
pub struct DistributionRecord {
    /// Values that mean, standard deviation, skewness, kurtosis and range rest on: those of all rows A and B.
    pub values: u64,
    /// The rest; quantiles, histogram and density rest on the `count` values that were kept, the first of every replicate.
    #[serde(flatten)]
    pub sample: OutputDistribution,
}

/// The indices as they were when the run had so many base points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
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

/// How an output goes with the factors of the largest total indices.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
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

/// Consecutive outputs that are the values of one quantity along an axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SeriesRecord {
    /// Its name.
    pub name: String,
    /// The unit of its values.
    pub unit: String,
    /// What its axis is called.
    pub axis: String,
    /// The unit of the positions; empty for none.
    pub axis_unit: String,
    /// Place of its first value in `outputs`, from 0; the others follow.
    pub first_output: usize,
    /// Where every value stands on the axis, in rising order.
    pub positions: Vec<f64>,
    /// Indices over all values together, each counted by its variance, one entry per factor; `null` where a value has none.
    pub indices: Option<Vec<PlainIndexRecord>>,
    /// Why there are none.
    pub reason: Option<String>,
}

impl SeriesRecord {
    /// Places of its values in `outputs`.
    pub fn places(&self) -> std::ops::Range<usize> {
        self.first_output..self.first_output + self.positions.len()
    }
}

/// What a run that was asked for an accuracy chose, and why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SpendingRecord {
    /// The half width that was asked for.
    pub accuracy: f64,
    /// Runs of the model in all, those of trials included.
    pub runs: u64,
    /// Runs that the same half width would take at least without surrogates and cheaper models, by the intervals of the plain
    /// indices of this run; `null` if they are unknown.
    pub plain_runs: Option<u64>,
    /// Why it was chosen, in sentences.
    pub reasons: Vec<String>,
    /// Lines of a study that make the same run again, to the bit, in the place of `accuracy`.
    pub lines: String,
}

/// Why a growing run ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StoppingRecord {
    /// In words.
    pub reason: String,
    /// Whether every index met the target; `null` if there was none.
    pub target_met: Option<bool>,
    /// The half width that was asked for.
    pub target_half_width: Option<f64>,
    /// The time that it might take, in seconds.
    pub budget_seconds: Option<f64>,
    /// The model runs that it might take.
    pub max_runs: Option<u64>,
}

/// What a model with a ladder of fidelities spent.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EffortRecord {
    /// The rungs that answered, and how many runs each.
    pub rungs: Vec<RungRecord>,
    /// Evaluations of the right-hand side (of the closed form, on the rung that has one), in all.
    pub evaluations: u64,
    /// Largest relative error of any run, as its rung estimates it from what it leaves out.
    pub largest_error_estimate: f64,
}

/// How many runs a rung answered.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RungRecord {
    /// The rung.
    pub rung: String,
    /// Number of runs.
    pub runs: u64,
}
