//! Errors of a design.

use thiserror::Error;

use super::{Design, MAX_DIMENSIONS, MAX_PAIRED_FACTORS, MAX_REPLICATES};

/// Why a design cannot be created.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum DesignError {
    /// There are no factors.
    #[error("a design needs at least one factor")]
    NoFactors,
    /// More factors than the maximum of any design.
    #[error(
        "{factors} factors are too many: at most {} are possible; leave out or group factors with little effect",
        Design::MAX_FACTORS
    )]
    FarTooManyFactors {
        /// The number requested.
        factors: usize,
    },
    /// More factors than there are direction numbers for.
    #[error(
        "{factors} factors need {} dimensions of the Sobol' sequence (2 for each), which has {MAX_DIMENSIONS}: at most {} factors, or another sampler",
        2 * factors,
        MAX_DIMENSIONS / 2
    )]
    TooManyFactors {
        /// The number requested.
        factors: usize,
    },
    /// There are no replicates.
    #[error("no replicates: at least 1 is needed, and at least 2 for intervals")]
    NoReplicates,
    /// A replicate would have fewer than two base points, which have no variance.
    #[error(
        "{base_samples} base samples are too few for {replicates} replicate{}: at least {} base samples are needed (2 in each replicate)",
        if *replicates == 1 { "" } else { "s" },
        u128::from(*replicates) * 2
    )]
    TooFewSamples {
        /// The number requested.
        base_samples: u64,
        /// The number of replicates that share them.
        replicates: u64,
    },
    /// Too many replicates: each costs memory and a pass over the others.
    #[error("{replicates} replicates: at most {MAX_REPLICATES} are possible, and 4 to 32 are usual")]
    TooManyReplicates {
        /// The number requested.
        replicates: u64,
    },
    /// More model runs than can be counted.
    #[error("{base_samples} base samples of {rows_per_point} runs each are more runs than can be counted")]
    TooManyRuns {
        /// The number requested, rounded up to a multiple of the replicates.
        base_samples: u128,
        /// Model runs of each base sample.
        rows_per_point: u64,
    },
    /// A swap names a column that does not exist.
    #[error("a swap takes column {column}, but there are {factors} factors, counted from 0")]
    NoSuchColumn {
        /// The column.
        column: usize,
        /// Number of factors.
        factors: usize,
    },
    /// A replicate would be longer than the sequence.
    #[error(
        "{base_samples} base samples in {replicates} replicates exceed {} (2^32) points per replicate, the length of the sequence",
        Design::MAX_POINTS
    )]
    TooManySamples {
        /// The number requested.
        base_samples: u64,
        /// The number of replicates that share them.
        replicates: u64,
    },
    /// Second-order indices without the rows that they need.
    #[error(
        "second-order indices need the rows BA (B with the columns of one factor from A) in addition to the rows AB"
    )]
    SecondOrderWithoutBa,
    /// Too many pairs of factors for their sums to be kept.
    #[error(
        "second-order indices of {factors} factors are {} pairs: at most {MAX_PAIRED_FACTORS} factors are possible; select factors by their total indices first",
        *factors as u128 * (*factors as u128 - 1) / 2
    )]
    TooManyPairs {
        /// Number of factors with a swap.
        factors: usize,
    },
    /// Second-order indices of dependent factors.
    #[error(
        "second-order indices need independent factors, and these factors depend on each other: use Shapley effects \
         instead"
    )]
    PairsOfDependentFactors,
    /// A copula with a different number of factors.
    #[error("the copula has {copula} factors, but the design has {factors}")]
    OtherFactors {
        /// Factors of the copula.
        copula: usize,
        /// Factors of the design.
        factors: usize,
    },
}
