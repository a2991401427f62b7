//! Why factors cannot depend on each other as stated.

use thiserror::Error;

/// Why factors cannot depend on each other as stated.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum DependenceError {
    /// A name that is no factor.
    #[error("dependence of `{0}`, which is no factor of the study")]
    UnknownFactor(String),
    /// A factor twice, or fewer than two.
    #[error("a dependence is one of two factors or more, each named once")]
    Factors,
    /// Joint measurements of a factor that are all the same.
    #[error(
        "the joint measurements of `{0}` are all the same, so that they say of no other factor how it goes with this one: leave it out \
         of the dependence"
    )]
    ConstantMeasurements(String),
    /// Joint measurements of which one column is a function of another.
    #[error(
        "the joint measurements of `{a}` and `{b}` have the {order} order, so that each is a function of the other: no factors that vary \
         by themselves. Leave one of them out of the study, and let the model compute it from the other"
    )]
    EqualRanks {
        /// One factor.
        a: String,
        /// The other one.
        b: String,
        /// `same` or `opposite`.
        order: &'static str,
    },
    /// Two factors in more than one dependence.
    #[error("the correlation of `{0}` and `{1}` is stated twice")]
    Repeated(String, String),
    /// Rows and columns of another number than the factors.
    #[error("the correlations of {factors} factors are a matrix of {factors} rows with {factors} numbers each")]
    Shape {
        /// Factors of the dependence.
        factors: usize,
    },
    /// Not what a correlation matrix looks like.
    #[error("the correlation of `{a}` and `{b}` is {found}: expected {expected}")]
    Entry {
        /// The factor of the row.
        a: String,
        /// The factor of the column.
        b: String,
        /// The number there.
        found: f64,
        /// What would be right.
        expected: &'static str,
    },
    /// A factor that has no correlation.
    #[error("`{factor}` is {kind}, which has no correlation with another factor")]
    Uncorrelated {
        /// The factor.
        factor: String,
        /// What it is.
        kind: &'static str,
    },
    /// A Pearson correlation that the distributions do not allow.
    #[error(
        "`{a}` and `{b}` cannot have a Pearson correlation of {found}: their distributions allow {low:.4} to {high:.4}"
    )]
    Unattainable {
        /// One factor.
        a: String,
        /// The other one.
        b: String,
        /// The correlation that was stated.
        found: f64,
        /// The least correlation of any joint distribution of these two.
        low: f64,
        /// The largest one.
        high: f64,
    },
    /// Correlations that cannot all be.
    #[error(
        "the correlations are not positive definite, so that no factors can have them all. The nearest that can be, of normal \
         scores (measure = \"normal\"): factors = {factors:?}, correlation = {nearest:?}"
    )]
    NotPositiveDefinite {
        /// The factors that depend on others.
        factors: Vec<String>,
        /// The nearest valid matrix, of their normal scores.
        nearest: Vec<Vec<f64>>,
    },
}
