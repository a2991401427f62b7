//! Warnings about results: their kinds, numbers and words.

use serde::{Deserialize, Deserializer, Serialize};
use thiserror::Error;

use super::RareLevel;
use apportion_base::names::named;
use apportion_base::quantity::Unlikely;

/// Why numbers of an output may be wrong, or less accurate than they look. In JSON the kind is the key `code`, a name that
/// does not change, followed by the fields and the sentence as `text`.
#[derive(Debug, Clone, PartialEq, Error, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "code", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Warning {
    /// No run has a value.
    #[error("all {runs} runs failed")]
    AllRunsFailed { runs: u64 },
    /// Some runs have no value; an index leaves out at most `left_out` base points.
    #[error(
        "{failed} of {runs} runs failed: every index leaves out the base points at which one of its own runs failed (at \
         most {left_out} of {base_samples}), and describes the part of the factor space where runs succeed"
    )]
    RunsFailed { failed: u64, runs: u64, left_out: u64, base_samples: u64 },
    /// Runs fail because of several factors together: at some base points rows A and B succeed and another row does not.
    #[error(
        "{points} of {base_samples} base points have a run that failed although it takes each factor from one of two runs that \
         succeeded: several factors together (or chance) decide what fails, so the factors depend on each other where runs succeed, \
         and more runs cannot define these indices there; narrow the ranges until no run fails, study an output \
         that is 1 where a run fails and 0 elsewhere, or analyse the rows that succeed as given data"
    )]
    JointFailures { points: u64, base_samples: u64 },
    /// The points of a replicate are not a power of two; `fewer` or `more` base samples would be.
    #[error(
        "{points} base points in each replicate are not a power of two: Sobol' points lose much of their accuracy; \
         {fewer} or {more} base samples would be better"
    )]
    Unbalanced { points: u64, fewer: u64, more: u64 },
    /// One replicate, and intervals from the spread of replicates.
    #[error("one replicate gives no estimate of its error: no intervals")]
    SingleReplicate,
    /// One net, and intervals from its parts.
    #[error(
        "one replicate gives no independent estimate of the error: intervals rest on how its parts differ (4 replicates are \
         safer)"
    )]
    SingleNet,
    /// The model raised a flag that warns, in `runs` runs.
    #[error("{flag} ({}): {description}", if *runs == 1 { "1 run".to_owned() } else { format!("{runs} runs") })]
    ModelFlag { flag: String, description: String, runs: u64 },
    /// A few rows dominate the variance: `rows` would have it if all other values of A and B had no effect.
    #[error(
        "few rows determine the variance, as if {rows:.0} of the {values} of A and B did (excess kurtosis {kurtosis:.0}): rows \
         with values as large may be missing from the sample, so intervals are longer above the estimates than below and may still \
         be too short; use more base samples, or the logarithm of the output"
    )]
    FewRows { rows: f64, values: u64, kurtosis: f64 },
    /// The output is large compared with its variation; `error` is that of the indices.
    #[error(
        "the output is so much larger than its variation that doubles keep few digits of the variation: indices may be off by about \
         {error:.1e}; subtract a constant from it before it is rounded"
    )]
    FewDigits { error: f64 },
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
    /// Corrected indices contradict plain ones, which are reported; `times` is their distance relative to both errors.
    #[error(
        "the indices corrected by surrogates contradict the plain ones of the same rows by {times:.1} times what their errors \
         allow: the rows do not represent a factor, so the plain ones are reported"
    )]
    ContradictedSurrogate { times: f64 },
    /// Surrogates claim more variance than the rows show; the plain indices are reported.
    #[error(
        "the surrogates give a factor {times:.1} times the variance that the rows show: the rows do not represent it, so \
         the plain indices are reported"
    )]
    InflatedSurrogate {
        /// The variance claimed over that of the rows; `null` for infinity.
        #[serde(deserialize_with = "or_infinity")]
        #[cfg_attr(feature = "schema", schemars(with = "Option<f64>"))]
        times: f64,
    },
    /// A low-fidelity model is not used: values that no shared row has carry this `share` of its variance.
    #[error(
        "the cheaper model {name} is not used: {:.1} % of its variance is due to values far outside of those at the rows of the \
         model, where nothing is known of its error; use more base samples, or mend it there",
        100.0 * share
    )]
    UnmetLowFidelity { name: String, share: f64 },
    /// A level of a factor is rare among the rows.
    #[error("{0}")]
    RareLevel(RareLevel),
    /// A surrogate of plain rows explains little of the variance; `explained` is its share.
    #[error(
        "the surrogate explains {:.0} % of the variance of runs that it was not fitted to: total indices may be too small by \
         the rest, and their intervals are as wide; `base_samples` instead of `runs` measures it",
        (100.0 * explained).max(0.0)
    )]
    PoorSurrogate { explained: f64 },
    /// Discrete factors depend on others.
    #[error(
        "{}: discrete values that depend on other factors: fixing the factor means fixing the normal score behind its value, \
         which determines the others more closely than the value does; its own indices are therefore too large, and those of its \
         partners too small",
        factors.join(", ")
    )]
    DependentSteps { factors: Vec<String> },
    /// The noise, whose seed is `factor`, has no effect.
    #[error("{factor}: no run changed with its seed: the model is not stochastic, or does not use the seed")]
    NoNoise { factor: String },
    /// The noise may have the whole effect.
    #[error(
        "{factor}: all variance may be noise, so the indices of the mean over it may be far off: use more base samples, \
         or several runs of each row (repetitions)"
    )]
    AllNoise { factor: String },
    /// The first-order index of a factor, group or subset exceeds its total index.
    #[error(
        "{name}: the first-order index {} exceeds the total index {} beyond the error of their difference: too few samples",
        decimals(*first_order),
        decimals(*total)
    )]
    AboveTotal { name: String, first_order: f64, total: f64 },
    /// The same by the intervals of both.
    #[error(
        "{name}: the interval of the first-order index {} was above that of the total index {}, and both were extended until \
         they met: too few samples",
        decimals(*first_order),
        decimals(*total)
    )]
    Contradictory { name: String, first_order: f64, total: f64 },
    /// Two formulas for the first-order index disagree.
    #[error(
        "{name}: two formulas for the first-order index differ by {gap:.2e}, beyond the error of their difference: too few \
         samples, or a heavy-tailed output (its logarithm may work better)"
    )]
    FormulasDiffer { name: String, gap: f64 },
    /// A requested estimator disagrees with the default one.
    #[error(
        "{name}: the {} index by `{estimator}` differs from the default one by {gap:.2e}, beyond the error of their \
         difference: one of the two is wrong for this output",
        index.name()
    )]
    EstimatorsDiffer { name: String, index: IndexKind, estimator: String, gap: f64 },
    /// First-order indices that may sum to 0.
    #[error(
        "the sum of the first-order indices may be 0: the output comes from interactions, or the samples are too few; shares \
         of the first-order indices are meaningless"
    )]
    NoFirstOrder,
    /// First-order indices sum to more than 1.
    #[error("the first-order indices sum to {sum:.4}, beyond 1 by more than their error: too few samples")]
    FirstOrderAboveOne { sum: f64 },
    /// Total indices below 1.
    #[error("the total indices sum to {sum:.4}, below 1 by more than their error: too few samples")]
    TotalsBelowOne { sum: f64 },
    /// A total index above 1.
    #[error(
        "{name}: the total index {total:.4} is above 1 by more than its error: too few samples, or rows in the wrong \
         order"
    )]
    TotalAboveOne { name: String, total: f64 },
    /// Rows of a table that may be in the wrong order.
    #[error(
        "every total index is near 1 and every first-order index near 0, as if the rows were not in the order of the \
         design; if the order is right, the output is interaction only"
    )]
    Shuffled,
    /// An output of the runs that may be a code for a missing one; `first` is the index of the run.
    #[error("{}", .0.in_runs(.0.first + 1))]
    UnlikelyValue(Unlikely),
    /// The same in a table of outputs; `first` is the index of the row.
    #[error("{}", .0.in_table(.0.first + 1))]
    UnlikelyInTable(Unlikely),
    /// Repeated rows gave different outputs; `has_noise` is whether the model gets a seed with every row.
    #[error(
        "{differing} of {rows} {} run again gave other outputs: {} (docs/guide/stochastic-models.md)",
        if *rows == 1 { "row that was" } else { "rows that were" },
        cause.explanation(*has_noise)
    )]
    Irreproducible { differing: u64, rows: u64, cause: Irreproducible, has_noise: bool },
}

impl Warning {
    /// Returns a warning if few of `values` values dominate their variance: n/(g2 + 3) of n rows with the excess kurtosis
    /// g2 are their number if all others had no effect.
    pub fn few_rows(values: u64, kurtosis: f64) -> Option<Self> {
        /// Effective number of rows of a variance below which it counts as dominated by few.
        const MIN_EFFECTIVE_ROWS: f64 = 40.0;
        /// Excess kurtosis (that of an exponential distribution) up to which few rows only mean a small sample.
        const MAX_KURTOSIS: f64 = 6.0;
        let rows = values as f64 / (kurtosis + 3.0);
        (kurtosis > MAX_KURTOSIS && rows < MIN_EFFECTIVE_ROWS).then_some(Self::FewRows { rows, values, kurtosis })
    }
}

named! {
/// The first-order or the total index.
#[derive(Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum IndexKind {
    /// The first-order index.
    FirstOrder = "first-order",
    /// The total index.
    Total = "total",
}
}

/// Why a model does not return the same output for the same row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Irreproducible {
    /// New workers that evaluate the same rows in the same order differ: the model draws random numbers.
    Random,
    /// New workers agree with each other but not with the run: the model depends on earlier rows.
    Remembers,
}

impl Irreproducible {
    /// Returns what it means for the indices, and what to do.
    fn explanation(self, has_noise: bool) -> &'static str {
        match (self, has_noise) {
            (Self::Random, false) => {
                "the model draws random numbers, and the indices of the factors include their noise, the total indices most of \
                 all; give the model a seed with every row, so that the noise gets its own indices"
            }
            (Self::Random, true) => {
                "the model draws random numbers without its seed, and the indices of the factors include their noise"
            }
            (Self::Remembers, _) => {
                "the outputs depend on earlier rows (through variables or files that the model keeps, or random numbers from \
                 one seed at its start), and the indices of the factors include this as noise; compute each row from its own \
                 values only, with random numbers from a seed of its row"
            }
        }
    }
}

/// Reads a number that is `null` if it is infinite.
fn or_infinity<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(deserializer)?.unwrap_or(f64::INFINITY))
}

/// Formats an index in a warning: four decimals, or three digits if it is smaller.
fn decimals(index: f64) -> String {
    if index == 0.0 || index.abs() >= 0.01 { format!("{index:.4}") } else { format!("{index:.2e}") }
}

#[cfg(test)]
#[path = "tests/warning.rs"]
mod tests;
