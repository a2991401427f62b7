//! Warnings about results: their kinds, codes and words.

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use thiserror::Error;

use super::RareLevel;

/// Why numbers of an output may be wrong, or less accurate than they look.
#[derive(Debug, Clone, Error)]
#[non_exhaustive]
pub enum Warning {
    /// No run has a value.
    #[error("all {runs} runs failed")]
    AllRunsFailed {
        /// The runs.
        runs: u64,
    },
    /// Some runs have no value.
    #[error(
        "{failed} of {runs} runs failed: every index leaves out the base points at which one of its own runs failed (at \
         most {left_out} of {base_samples}), and describes the part of the factor space where runs succeed"
    )]
    RunsFailed {
        /// Runs without a value.
        failed: u64,
        /// All runs.
        runs: u64,
        /// Maximum number of base points that an index leaves out.
        left_out: u64,
        /// All base points.
        base_samples: u64,
    },
    /// Runs fail because of several factors together.
    #[error(
        "{points} of {base_samples} base points have a run that failed although it takes each factor from one of two runs that \
         succeeded: several factors together (or chance) decide what fails, so the factors depend on each other where runs succeed, \
         and more runs cannot define these indices there; narrow the ranges until no run fails, study an output \
         that is 1 where a run fails and 0 elsewhere, or pass the rows that succeed (--save-outputs) to given-data"
    )]
    JointFailures {
        /// Base points whose rows A and B succeeded, and another row did not.
        points: u64,
        /// All base points.
        base_samples: u64,
    },
    /// The points of a replicate are not a power of two.
    #[error(
        "{points} base points in each replicate are not a power of two: Sobol' points lose much of their accuracy; \
         base_samples = {fewer} or {more} would be better"
    )]
    Unbalanced {
        /// Base points of a replicate.
        points: u64,
        /// The next smaller good number of base samples.
        fewer: u64,
        /// The next larger one.
        more: u64,
    },
    /// One replicate, and intervals from the spread of replicates.
    #[error("one replicate gives no estimate of its error: no intervals")]
    SingleReplicate,
    /// One net, and intervals from its parts.
    #[error(
        "one replicate gives no independent estimate of the error: intervals rest on how its parts differ (4 replicates are \
         safer)"
    )]
    SingleNet,
    /// The model raised a flag that warns.
    #[error("{flag} ({}): {description}", if *runs == 1 { "1 run".to_owned() } else { format!("{runs} runs") })]
    ModelFlag {
        /// The flag.
        flag: String,
        /// What it means.
        description: String,
        /// Runs that raised it.
        runs: u64,
    },
    /// A few rows dominate the variance.
    #[error(
        "few rows determine the variance, as if {rows:.0} of the {values} of A and B did (excess kurtosis {kurtosis:.0}): rows \
         with values as large may be missing from the sample, so intervals are longer above the estimates than below and may still \
         be too short; use more base samples, or the logarithm of the output"
    )]
    FewRows {
        /// Number of rows that would have this variance if all others had no effect.
        rows: f64,
        /// Rows A and B.
        values: u64,
        /// Excess kurtosis of the values.
        kurtosis: f64,
    },
    /// The output is large compared with its variation.
    #[error(
        "the output is so much larger than its variation that doubles keep few digits of the variation: indices may be off by about \
         {error:.1e}; subtract a constant from it before it is rounded"
    )]
    FewDigits {
        /// Error of the indices.
        error: f64,
    },
    /// Intervals do not exist.
    #[error(
        "no intervals: without the rows of one part of the sample the output does not vary (or too few rows are left), so \
         the error of the indices is unknown: use more base samples"
    )]
    NoIntervals,
    /// A few runs dominate the residual of the surrogate.
    #[error(
        "a few runs determine the variance that the surrogate does not explain, and similar runs may be missing: the intervals of the \
         corrected indices contain those of the plain ones"
    )]
    HeavyTailedSurrogate,
    /// Corrected and plain indices differ, within the range of the intervals.
    #[error(
        "the indices corrected by surrogates and the plain ones of the same rows differ by more than their errors make \
         likely: the intervals contain both"
    )]
    DoubtedSurrogate,
    /// Corrected indices contradict plain ones, which are reported.
    #[error(
        "the indices corrected by surrogates contradict the plain ones of the same rows by {times:.1} times what their errors \
         allow: the rows do not represent a factor, so the plain ones are reported"
    )]
    ContradictedSurrogate {
        /// The distance relative to both errors.
        times: f64,
    },
    /// Surrogates claim more variance than the rows show; the plain indices are reported.
    #[error(
        "the surrogates give a factor {times:.1} times the variance that the rows show: the rows do not represent it, so \
         the plain indices are reported"
    )]
    InflatedSurrogate {
        /// The variance claimed over that of the rows.
        times: f64,
    },
    /// A level of a factor is rare among the rows.
    #[error("{0}")]
    RareLevel(RareLevel),
    /// Rows for surrogates that explain little.
    #[error(
        "the surrogates explain {:.0} % of the variance of runs that they were not fitted to, so plain rows, which only \
         surrogates use, help little: use all runs as base samples for this output; errors and intervals may \
         be too small here",
        (100.0 * explained).max(0.0)
    )]
    PoorSurrogate {
        /// Share of the variance that they explain.
        explained: f64,
    },
    /// Discrete factors depend on others.
    #[error(
        "{}: discrete values that depend on other factors: fixing the factor means fixing the normal score behind its value, \
         which determines the others more closely than the value does; its own indices are therefore too large, and those of its \
         partners too small",
        factors.join(", ")
    )]
    DependentSteps {
        /// The factors.
        factors: Vec<String>,
    },
    /// The noise has no effect.
    #[error("{factor}: no run changed with its seed: the model is not stochastic, or does not use the seed")]
    NoNoise {
        /// The seed.
        factor: String,
    },
    /// The noise may have the whole effect.
    #[error(
        "{factor}: all variance may be noise, so the indices of the mean over it may be far off: use more base samples, \
         or several runs of each row (repetitions in [noise])"
    )]
    AllNoise {
        /// The seed.
        factor: String,
    },
    /// A first-order index exceeds its total index.
    #[error(
        "{name}: the first-order index {} exceeds the total index {} beyond the error of their difference: too few samples",
        decimals(*first_order),
        decimals(*total)
    )]
    AboveTotal {
        /// Factor, group or subset.
        name: String,
        /// Its first-order index.
        first_order: f64,
        /// Its total index.
        total: f64,
    },
    /// The same by the intervals of both.
    #[error(
        "{name}: the interval of the first-order index {} was above that of the total index {}, and both were extended until \
         they met: too few samples",
        decimals(*first_order),
        decimals(*total)
    )]
    Contradictory {
        /// Factor, group or subset.
        name: String,
        /// Its first-order index.
        first_order: f64,
        /// Its total index.
        total: f64,
    },
    /// Two formulas disagree.
    #[error(
        "{name}: two formulas for the first-order index differ by {gap:.2e}, beyond the error of their difference: too few \
         samples, or a heavy-tailed output (its logarithm may work better)"
    )]
    FormulasDiffer {
        /// Factor, group or subset.
        name: String,
        /// The difference.
        gap: f64,
    },
    /// A requested estimator disagrees with the default one.
    #[error(
        "{name}: the {index} index by `{estimator}` differs from the default one by {gap:.2e}, beyond the error of their \
         difference: one of the two is wrong for this output"
    )]
    EstimatorsDiffer {
        /// Factor, group or subset.
        name: String,
        /// `first-order` or `total`.
        index: &'static str,
        /// The estimator.
        estimator: &'static str,
        /// The difference.
        gap: f64,
    },
    /// First-order indices that may sum to 0.
    #[error(
        "the sum of the first-order indices may be 0: the output comes from interactions, or the samples are too few; shares \
         of the first-order indices are meaningless"
    )]
    NoFirstOrder,
    /// First-order indices sum to more than 1.
    #[error("the first-order indices sum to {sum:.4}, beyond 1 by more than their error: too few samples")]
    FirstOrderAboveOne {
        /// Their sum.
        sum: f64,
    },
    /// Total indices below 1.
    #[error("the total indices sum to {sum:.4}, below 1 by more than their error: too few samples")]
    TotalsBelowOne {
        /// Their sum.
        sum: f64,
    },
    /// A total index above 1.
    #[error(
        "{name}: the total index {total:.4} is above 1 by more than its error: too few samples, or rows in the wrong \
         order"
    )]
    TotalAboveOne {
        /// Factor, group or subset.
        name: String,
        /// Its total index.
        total: f64,
    },
    /// Rows of a table that may be in the wrong order.
    #[error(
        "every total index is near 1 and every first-order index near 0, as if the rows were not in the order of the \
         design; if the order is right, the output is interaction only"
    )]
    Shuffled,
    /// A value that may be a code for a missing one.
    #[error("{text}")]
    Unlikely {
        /// The value and its place.
        text: String,
    },
    /// Repeated rows gave different outputs.
    #[error("{text}")]
    Irreproducible {
        /// How many, and why.
        text: String,
    },
    /// A warning of a result that was read from a file.
    #[error("{text}")]
    Recorded {
        /// Its code.
        code: String,
        /// Its sentence.
        text: String,
    },
}

/// Warnings are equal if their texts are: those read from a file are equal to those that were written.
impl PartialEq for Warning {
    fn eq(&self, other: &Self) -> bool {
        self.code() == other.code() && self.to_string() == other.to_string()
    }
}

/// The keys of the warnings of an output in JSON.
#[derive(Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(super) struct WarningKeys {
    /// The warnings in sentences.
    warnings: Vec<String>,
    /// The kind of each warning, a stable name.
    #[serde(default)]
    warning_codes: Vec<String>,
}

/// Writes warnings as [`WarningKeys`].
pub(super) fn serialize<S: Serializer>(all: &[Warning], serializer: S) -> Result<S::Ok, S::Error> {
    let warnings = all.iter().map(Warning::to_string).collect();
    let warning_codes = all.iter().map(|warning| warning.code().to_owned()).collect();
    WarningKeys { warnings, warning_codes }.serialize(serializer)
}

/// Reads warnings from [`WarningKeys`]; those of the first versions have no codes.
pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Warning>, D::Error> {
    let WarningKeys { warnings, warning_codes } = WarningKeys::deserialize(deserializer)?;
    let codes = warning_codes.into_iter().chain(std::iter::repeat(String::new()));
    Ok(warnings.into_iter().zip(codes).map(|(text, code)| Warning::Recorded { code, text }).collect())
}

impl Warning {
    /// Returns a stable name of the kind of warning, as in the result file.
    pub fn code(&self) -> &str {
        match self {
            Self::AllRunsFailed { .. } => "all-runs-failed",
            Self::RunsFailed { .. } => "runs-failed",
            Self::JointFailures { .. } => "joint-failures",
            Self::Unbalanced { .. } => "unbalanced",
            Self::SingleReplicate => "single-replicate",
            Self::SingleNet => "single-net",
            Self::ModelFlag { .. } => "model-flag",
            Self::FewRows { .. } => "few-rows",
            Self::FewDigits { .. } => "few-digits",
            Self::NoIntervals => "no-intervals",
            Self::HeavyTailedSurrogate => "heavy-tailed-surrogate",
            Self::DoubtedSurrogate => "doubted-surrogate",
            Self::ContradictedSurrogate { .. } => "contradicted-surrogate",
            Self::InflatedSurrogate { .. } => "inflated-surrogate",
            Self::RareLevel(_) => "rare-level",
            Self::PoorSurrogate { .. } => "poor-surrogate",
            Self::DependentSteps { .. } => "dependent-steps",
            Self::NoNoise { .. } => "no-noise",
            Self::AllNoise { .. } => "all-noise",
            Self::AboveTotal { .. } => "above-total",
            Self::Contradictory { .. } => "contradictory",
            Self::FormulasDiffer { .. } => "formulas-differ",
            Self::EstimatorsDiffer { .. } => "estimators-differ",
            Self::NoFirstOrder => "no-first-order",
            Self::FirstOrderAboveOne { .. } => "first-order-above-one",
            Self::TotalsBelowOne { .. } => "totals-below-one",
            Self::TotalAboveOne { .. } => "total-above-one",
            Self::Shuffled => "shuffled",
            Self::Unlikely { .. } => "unlikely-value",
            Self::Irreproducible { .. } => "irreproducible",
            Self::Recorded { code, .. } => code,
        }
    }
}

/// Formats an index in a warning: four decimals, or three digits if it is smaller.
fn decimals(index: f64) -> String {
    if index == 0.0 || index.abs() >= 0.01 { format!("{index:.4}") } else { format!("{index:.2e}") }
}

#[cfg(test)]
mod tests;
