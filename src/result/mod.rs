//! The result of a run: one type for Rust, JSON and Python.
//!
//! As JSON it is the format `apportion-result`, version 1, described key by key in `docs/reference/result-format.md`. Later
//! versions of the program only add keys. Numbers are in the unit given with them; missing ones are `null`.

mod distribution;
mod indices;
mod output;
mod rare_level;
mod read;
#[cfg(feature = "schema")]
mod schema;
mod setup;
mod stopping;
mod warning;
mod with_text;

use std::ops::Range;

pub use distribution::{Histogram, OutputDistribution, QuantileRecord};
pub use indices::*;
use output::find;
pub use output::*;
pub(crate) use rare_level::PAIRS_OF_POINT;
pub use rare_level::RareLevel;
pub use read::{ReadError, ReadProblem, parse_result, read_result};
#[cfg(feature = "schema")]
pub use schema::result_schema;
use serde::{Deserialize, Serialize};
pub use setup::{RunFacts, StudySetup, json};
pub use stopping::{AccuracyReason, StopReason, StoppingRecord};
pub use warning::{IndexKind, Irreproducible, Warning};
#[cfg(feature = "schema")]
use with_text::WithText;
use with_text::{with_text, with_texts};

use crate::design::Sampler;
use crate::effect::IndexPair;
use crate::estimate::{Scaling, Undefined};
use crate::space::{CorrelationMeasure, IndicesOf};
use crate::surrogate::SurrogateChoice;
use crate::uncertainty::{Estimate, IntervalMethod};

/// The result of a run of a [`Study`](crate::Study).
///
/// ```
/// use apportion::function_model;
/// use apportion::Distribution;
/// use apportion::Study;
///
/// let study = Study::builder("product", function_model("y", |x| x[0] * x[1]))
///     .factor("a", Distribution::uniform(1.0, 2.0)?)
///     .factor("b", Distribution::uniform(1.0, 5.0)?)
///     .base_samples(1024)
///     .build()?;
/// let result = study.run()?;
/// let total = result.output("y")?.factor("a")?.total;
/// assert!(total.interval.is_some_and(|interval| interval.low < total.estimate));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "schema", schemars(title = "apportion result"))]
pub struct StudyResult {
    /// Always `apportion-result`.
    #[cfg_attr(feature = "schema", schemars(extend("const" = "apportion-result")))]
    pub format: String,
    /// Version of the format.
    #[cfg_attr(feature = "schema", schemars(extend("const" = 1)))]
    pub version: u32,
    /// The question.
    pub study: StudyRecord,
    /// How the result was computed.
    pub provenance: Provenance,
    /// What has indices in the outputs: the factors, or the groups in place of their factors.
    pub indices_of: IndicesOf,
    /// The factors in the order of the study.
    pub factors: Vec<FactorRecord>,
    /// The outputs in the order of the study.
    pub outputs: Vec<OutputResult>,
    /// Rows on which the model's assumptions do not hold; these rows still count.
    pub validity: Vec<ValidityRecord>,
    /// The effort of a model with a ladder of fidelities; `null` for other models.
    pub effort: Option<EffortRecord>,
    /// Indices over all outputs together, if requested.
    pub aggregate: Option<AggregateRecord>,
    /// The outputs that are series.
    pub series: Vec<SeriesRecord>,
    /// Why a growing run ended; `null` for one of fixed size.
    pub stopping: Option<StoppingRecord>,
    /// The choices of a run with a target accuracy, and their reasons.
    pub spending: Option<AccuracyRecord>,
    /// Low-fidelity models that were run in addition to the model.
    pub low_fidelity: Vec<LowFidelityRuns>,
}

impl StudyResult {
    /// Minimum number of outputs that have indices over all together, and an overview instead of pages for each.
    pub const MIN_OUTPUTS_TOGETHER: usize = 12;

    /// Returns the names of what has indices, in their order: the factors, or the groups in place of their factors.
    pub fn indexed_names(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for factor in &self.factors {
            let group = factor.group.as_ref().filter(|_| self.indices_of == IndicesOf::Groups);
            let name = group.unwrap_or(&factor.name);
            if group.is_none() || !names.contains(&name.as_str()) {
                names.push(name);
            }
        }
        names
    }

    /// Returns the output called `name`.
    ///
    /// # Errors
    /// [`LookupError`] with the existing names.
    pub fn output(&self, name: &str) -> Result<&OutputResult, LookupError> {
        find("output", name, &self.outputs, |output| &output.name)
    }

    /// Returns the series called `name`.
    ///
    /// # Errors
    /// [`LookupError`] with the existing names.
    pub fn series(&self, name: &str) -> Result<&SeriesRecord, LookupError> {
        find("series", name, &self.series, |series| &series.name)
    }

    /// Returns the result as JSON text, ending in a newline.
    pub fn json(&self) -> String {
        json(self)
    }
}

/// The question.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct StudyRecord {
    /// Name of the study.
    pub name: String,
    /// Title, if the study has one.
    pub title: Option<String>,
    /// Name of the model.
    pub model: String,
    /// The model's current choices, such as `friction`.
    pub settings: serde_json::Map<String, serde_json::Value>,
    /// The model's inputs that are fixed in the study, with their units.
    pub constants: Vec<ConstantRecord>,
    /// Factors that depend on each other.
    pub dependences: Vec<CorrelationRecord>,
    /// Changes made on the command line, as given.
    pub overrides: Vec<String>,
    /// The text of the study file.
    pub source: String,
}

/// Factors that depend on each other, by a Gaussian copula.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CorrelationRecord {
    /// The factors.
    pub factors: Vec<String>,
    /// Their correlations.
    pub correlation: Vec<Vec<f64>>,
    /// The kind of correlation.
    pub measure: CorrelationMeasure,
}

/// An input fixed in the study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ConstantRecord {
    /// The input.
    pub name: String,
    /// Its value in `unit`.
    pub value: f64,
    /// The unit.
    pub unit: String,
}

/// How the result was computed. A result is cited by `apportion_version`, `seed` and `study_sha256`, and by the
/// `overrides` of its study if there are any: they give the same numbers again. `CITATION.cff` in the sources of the
/// program describes how to cite the program itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Provenance {
    /// Version of the program.
    pub apportion_version: String,
    /// Seed of the design.
    pub seed: u64,
    /// Sampler of the design.
    pub sampler: Sampler,
    /// Total number of base points.
    pub base_samples: u64,
    /// Independent randomisations that share them.
    pub replicates: u64,
    /// Whether each run is at a point of its own: base points have no swaps, and a surrogate gives the indices.
    pub plain: bool,
    /// Runs of the model.
    pub model_runs: u64,
    /// Threads used.
    pub threads: usize,
    /// Seconds from the first run to the last.
    pub wall_seconds: f64,
    /// SHA-256 of the study file on disk, in hexadecimal.
    pub study_sha256: String,
    /// Formula of the first-order indices.
    pub first_order_estimator: String,
    /// Formula of the total indices.
    pub total_estimator: String,
    /// The kind of interval; `null` if there are none, and for plain rows, whose intervals are those of the surrogate.
    pub interval_method: Option<IntervalMethod>,
    /// Resamples of bootstrap intervals; `null` for other kinds.
    pub resamples: Option<usize>,
    /// The total index above which a factor counts as important.
    pub threshold: f64,
    /// The files of the model recorded in a journal: its runs are not used once one of these files has changed.
    pub model_files: Vec<String>,
}

impl Provenance {
    /// Describes the intervals in a sentence; `None` if there are none.
    pub fn interval(&self) -> Option<String> {
        if self.plain {
            let words = "95 % interval from rows that were left out of fits: what the surrogate leaves of them, and how much the \
                         fits differ";
            return Some(words.to_owned());
        }
        self.interval_method.map(|method| method.words(self.replicates, self.resamples.unwrap_or_default()))
    }
}

/// A factor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FactorRecord {
    /// Its name.
    pub name: String,
    /// What it is, if the model says so.
    pub description: Option<String>,
    /// The unit of its values.
    pub unit: String,
    /// Its group, if any.
    pub group: Option<String>,
    /// Its distribution.
    pub distribution: FactorDistribution,
    /// Its nominal value in `unit`.
    pub nominal: f64,
}

/// The distribution of a factor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FactorDistribution {
    /// The name of its family in study files.
    pub name: String,
    /// The parameters in the unit of the factor, by their names in study files.
    #[serde(flatten)]
    pub parameters: serde_json::Map<String, serde_json::Value>,
}

/// Indices over several outputs together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AggregateRecord {
    /// The outputs.
    pub outputs: Vec<String>,
    /// How outputs are weighted against each other.
    pub weighting: Scaling,
    /// One entry per factor; `null` if an output has no indices.
    pub indices: Option<Vec<Named<IndexPair<Estimate>>>>,
    /// The noise of a stochastic model, which is not a factor.
    pub noise: Option<Named<IndexPair<Estimate>>>,
    /// Why there are no indices.
    #[serde(serialize_with = "with_text")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<WithText<Undefined>>"))]
    pub reason: Option<Undefined>,
}

/// A validity flag.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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

/// Consecutive outputs that are the values of one quantity along an axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SeriesRecord {
    /// Its name.
    pub name: String,
    /// The unit of its values.
    pub unit: String,
    /// The name of its axis.
    pub axis: String,
    /// The unit of the positions; empty for none.
    pub axis_unit: String,
    /// Index of its first value in `outputs`, from 0; the others follow.
    pub first_output: usize,
    /// The position of every value on the axis, in rising order.
    pub positions: Vec<f64>,
    /// Indices over all values, each weighted by its variance, one entry per factor; `null` if a value has none.
    pub indices: Option<Vec<Named<IndexPair<Estimate>>>>,
    /// Why there are no indices.
    #[serde(serialize_with = "with_text")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<WithText<Undefined>>"))]
    pub reason: Option<Undefined>,
}

impl SeriesRecord {
    /// Returns the indices of its values in `outputs`.
    pub fn places(&self) -> Range<usize> {
        self.first_output..self.first_output + self.positions.len()
    }
}

/// The choices of a run with a target accuracy, and their reasons.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AccuracyRecord {
    /// The requested half width.
    pub accuracy: f64,
    /// Part of the range of a factor, from 0 to 1: with 95 % probability no larger part escaped all of its values.
    pub excluded_region: f64,
    /// Total runs of the model, including those of trials.
    pub runs: u64,
    /// The reasons.
    #[serde(serialize_with = "with_texts")]
    #[cfg_attr(feature = "schema", schemars(with = "Vec<WithText<AccuracyReason>>"))]
    pub reasons: Vec<AccuracyReason>,
    /// The choice of surrogates with which a study of the same design repeats the run.
    pub surrogate: SurrogateChoice,
    /// Number of low-fidelity models that the study states.
    pub stated_low_fidelity: usize,
}

/// The effort of a model with a ladder of fidelities.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct EffortRecord {
    /// The rungs used, and the number of runs of each.
    pub rungs: Vec<RungRecord>,
    /// Total evaluations of the right-hand side (of the closed form, on the rung that has one).
    pub evaluations: u64,
    /// Largest relative error of any run, as estimated by its rung from what it neglects.
    pub largest_error_estimate: f64,
}

/// The number of runs evaluated by a rung.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RungRecord {
    /// The rung.
    pub rung: String,
    /// Number of runs.
    pub runs: u64,
}

/// The runs of a low-fidelity model in addition to those of the model.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "LowRecord"))]
#[non_exhaustive]
pub struct LowFidelityRuns {
    /// Its name.
    pub name: String,
    /// Runs at the rows of the model.
    pub shared_runs: u64,
    /// Base samples of its own design.
    pub own_base_samples: u64,
    /// Runs of its own design.
    pub own_runs: u64,
}
