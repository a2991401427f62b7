//! One set of indices for several outputs.

use serde::{Deserialize, Serialize};

use super::Undefined;

/// How outputs are weighted against each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Scaling {
    /// Unscaled: for outputs of one unit, such as the values of a curve. The weight of an output is its variance.
    Plain,
    /// Each divided by its own standard deviation: for outputs of different units. All weigh the same.
    Standardised,
}

/// Returns aggregated indices of several outputs of one design, each with its variance and a list of its indices: sum_k
/// V_j^k/sum_k V^k, the mean of the outputs' indices weighted by their variances.
///
/// Gamboa, Janon, Klein and Lagnoux (2014), Electron. J. Stat. 8, 575-603; Lamboni, Monod and Makowski (2011), Reliab.
/// Eng. Syst. Saf. 96, 450-459. Constant outputs are ignored.
///
/// # Errors
/// [`Undefined`] if all outputs are constant, or one has no indices for another reason.
pub fn aggregated<'a>(
    outputs: impl Iterator<Item = &'a Result<(f64, Vec<f64>), Undefined>>,
    scaling: Scaling,
) -> Result<Vec<f64>, Undefined> {
    let mut varying: Vec<(f64, &[f64])> = Vec::new();
    for output in outputs {
        match output {
            Ok((variance, indices)) => varying.push((*variance, indices)),
            Err(Undefined::ZeroVariance) => (),
            Err(undefined) => return Err(*undefined),
        }
    }
    // Relative to the largest, so that variances near the limits of `f64` can be added.
    let largest = varying.iter().map(|(variance, _)| *variance).fold(0.0, f64::max);
    for (weight, _) in &mut varying {
        *weight = match scaling {
            Scaling::Plain => *weight / largest,
            Scaling::Standardised => 1.0,
        };
    }
    let sum: f64 = varying.iter().map(|(weight, _)| *weight).sum();
    let mut means = vec![0.0; varying.first().ok_or(Undefined::ZeroVariance)?.1.len()];
    for (at, mean) in means.iter_mut().enumerate() {
        *mean = varying.iter().map(|(weight, indices)| weight * indices[at]).sum::<f64>() / sum;
    }
    Ok(means)
}
