//! The values that a factor takes over its range.

use super::SweepError;
use crate::space::Distribution;

/// End of a sweep on a side on which the factor's distribution is unbounded: this quantile, or 1 minus it.
const TAIL: f64 = 1e-3;
/// Maximum number of values of one factor.
pub const MAX_POINTS: usize = 100_000;

/// Returns `points` values of a factor from end to end, in its unit: at equal ratios if it is log-uniform or
/// log-normal, otherwise at equal distances. A discrete factor takes each of its values, or some of many whole numbers.
///
/// # Errors
/// [`SweepError::Points`] if there are fewer than 2 or more than 100,000 points.
pub fn values_over_range(distribution: &Distribution, points: usize) -> Result<Vec<f64>, SweepError> {
    if !(2..=MAX_POINTS).contains(&points) {
        return Err(SweepError::Points(points));
    }
    let (low, high) = range(distribution);
    let last = points - 1;
    let between = |i: usize| match i {
        0 => low,
        // Exactly the end, despite rounding on the way.
        _ if i == last => high,
        _ => {
            let part = i as f64 / last as f64;
            if is_logarithmic(distribution) {
                libm::exp(libm::log(low) * (1.0 - part) + libm::log(high) * part)
            } else {
                low * (1.0 - part) + high * part
            }
        }
    };
    Ok(match distribution {
        Distribution::Constant(_) => vec![low],
        whole if whole.is_whole() && high - low >= points as f64 => (0..points).map(|i| between(i).round()).collect(),
        _ => match distribution.levels() {
            Some(levels) => levels.into_iter().map(|(value, _)| value).collect(),
            None => (0..points).map(between).collect(),
        },
    })
}

/// Returns whether its axis should be logarithmic.
pub(super) fn is_logarithmic(distribution: &Distribution) -> bool {
    matches!(distribution, Distribution::LogUniform(_) | Distribution::LogNormal(_))
}

/// Returns the ends of the range.
fn range(distribution: &Distribution) -> (f64, f64) {
    let (low, high) = distribution.support();
    let is_open = matches!(distribution, Distribution::LogNormal(_));
    // The logarithm of a log-normal factor is unbounded below: its lower bound, 0, cannot be used.
    let low = if low.is_finite() && !is_open { low } else { distribution.quantile(TAIL) };
    (low, if high.is_finite() { high } else { distribution.quantile(1.0 - TAIL) })
}
