//! The kinds of interval.

use super::net_decay::net_errors;
use super::standard_error::{ErrorKind, PartInfluences, StandardError};
use crate::design::Sampler;
use apportion_base::names::named;
use serde::{Deserialize, Serialize};

named! {
/// How the error of an estimate is computed.
#[derive(Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum IntervalMethod {
    /// From few long scrambled nets: their spread, and the decay of the error inside them.
    Nets = "nets",
    /// Student's t on independent replicates.
    Replicates = "replicates",
    /// Student's t on parts of a random design, which are nearly independent.
    Batches = "batches",
    /// The delta method: the variance of the influence of every point of a random design.
    Delta = "delta",
    /// The percentile bootstrap over the points of a random design.
    Percentile = "percentile",
}
}

impl IntervalMethod {
    /// Returns the best method for points of `sampler`.
    pub fn default_for(sampler: Sampler) -> Self {
        match sampler {
            Sampler::Sobol => Self::Nets,
            Sampler::Random => Self::Batches,
            Sampler::LatinHypercube => Self::Replicates,
        }
    }

    /// Returns whether it is valid for points of `sampler`; a bootstrap over Sobol' points is 3 to 30 times too wide.
    pub fn serves(self, sampler: Sampler) -> bool {
        match self {
            Self::Nets => sampler.is_digital(),
            Self::Replicates => true,
            Self::Batches | Self::Delta | Self::Percentile => sampler == Sampler::Random,
        }
    }

    /// Returns the recommended number of replicates.
    pub fn default_replicates(self) -> u64 {
        match self {
            Self::Nets => 4,
            Self::Replicates => 16,
            Self::Batches | Self::Delta | Self::Percentile => 1,
        }
    }

    /// Returns whether it needs the outputs of every run, so that memory grows with their number.
    pub fn keeps_outputs(self) -> bool {
        matches!(self, Self::Delta | Self::Percentile)
    }

    /// Describes an interval of this kind in a sentence.
    pub fn words(self, replicates: u64, resamples: usize) -> String {
        match self {
            Self::Nets if replicates == 1 => {
                "95 % t-interval around the estimate from one scrambled net; its standard error is extrapolated from \
                 how nested parts of the net differ, and rests on that trend alone"
                    .to_owned()
            }
            Self::Nets => format!(
                "95 % t-interval around the estimate from {replicates} independently scrambled nets together, longer \
                 above it where few rows carry it; its standard error combines the spread of the nets with how nested \
                 parts of each differ (moderated t)"
            ),
            Self::Replicates => format!(
                "95 % t-interval (delete-one jackknife) from {replicates} independent randomisations of the design; the estimate \
                 rests on all of them together"
            ),
            Self::Batches => "95 % t-interval from the spread of batches of independent random points".to_owned(),
            Self::Delta => {
                "95 % t-interval around the estimate by the delta method, from the influence of every random point; \
                            indices over all outputs together by batches of them"
                    .to_owned()
            }
            Self::Percentile => {
                format!(
                    "95 % percentile bootstrap interval, {resamples} resamples of the random points; indices over all outputs \
                     together by batches of them"
                )
            }
        }
    }

    /// Computes standard errors from the parts of every replicate; methods on kept outputs are approximated by batches.
    pub(super) fn errors(self, quantities: &[PartInfluences], kinds: &[ErrorKind]) -> Vec<StandardError> {
        let errors = match self {
            Self::Nets => net_errors(quantities, kinds),
            Self::Replicates => quantities.iter().map(|parts| spread(&means(parts))).collect(),
            Self::Batches | Self::Delta | Self::Percentile => {
                quantities.iter().map(|parts| spread(&complete(parts))).collect()
            }
        };
        let none = StandardError { error: f64::NAN, freedom: 0.0 };
        let both = errors.into_iter().zip(quantities);
        both.map(|(error, parts)| if parts.iter().flatten().all(|x| x.is_finite()) { error } else { none }).collect()
    }
}

/// Returns the mean influence of each replicate.
fn means(parts: &PartInfluences) -> Vec<f64> {
    parts.iter().map(|replicate| replicate.iter().sum::<f64>() / replicate.len().max(1) as f64).collect()
}

/// Returns the parts of all replicates except those that may be incomplete, or all if there are no others.
fn complete(parts: &PartInfluences) -> Vec<f64> {
    let complete = parts.iter().flat_map(|replicate| &replicate[..replicate.len().saturating_sub(1).max(1)]);
    complete.copied().collect()
}

/// Returns the standard error of the mean of independent values of one distribution.
fn spread(values: &[f64]) -> StandardError {
    let n = values.len() as f64;
    if values.len() < 2 {
        return StandardError { error: f64::NAN, freedom: 0.0 };
    }
    let size = values.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    if size == 0.0 {
        return StandardError { error: 0.0, freedom: n - 1.0 };
    }
    let mean = values.iter().map(|x| x / size).sum::<f64>() / n;
    let squares: f64 = values.iter().map(|x| (x / size - mean).powi(2)).sum();
    StandardError { error: size * (squares / (n - 1.0) / n).sqrt(), freedom: n - 1.0 }
}
