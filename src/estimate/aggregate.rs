//! One set of indices for several outputs.

use super::Undefined;

/// How outputs are weighed against each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scaling {
    /// As they are: for outputs of one unit, such as the values of a curve. An output counts by its variance.
    Plain,
    /// Each divided by its own standard deviation: for outputs of different units. All count the same.
    Standardised,
}

/// Aggregated indices of several outputs of one design, each with its variance and a list of its indices:
/// sum_k V_j^k/sum_k V^k, which is the mean of the outputs' indices weighted by their variances.
///
/// Gamboa, Janon, Klein and Lagnoux (2014), Electron. J. Stat. 8, 575-603; Lamboni, Monod and Makowski (2011), Reliab.
/// Eng. Syst. Saf. 96, 450-459. An output that is constant has no part in it.
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
    // Relative to the largest, so that variances near the ends of the doubles can be added.
    let largest = varying.iter().map(|(variance, _)| *variance).fold(0.0, f64::max);
    let weight = |variance: f64| match scaling {
        Scaling::Plain => variance / largest,
        Scaling::Standardised => 1.0,
    };
    let sum: f64 = varying.iter().map(|(variance, _)| weight(*variance)).sum();
    let count = varying.first().ok_or(Undefined::ZeroVariance)?.1.len();
    let mean = |place: usize| varying.iter().map(|(v, indices)| weight(*v) * indices[place]).sum::<f64>() / sum;
    Ok((0..count).map(mean).collect())
}
