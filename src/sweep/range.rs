//! The values that a factor takes over its range.

use super::SweepError;
use crate::space::Distribution;
use crate::sweep::Sweeps;

/// End of a sweep on a side on which the factor's distribution is unbounded: this quantile, or 1 minus it.
const TAIL: f64 = 1e-3;

impl Distribution {
    /// Returns `points` values of a factor from end to end of its range, in its unit: at equal ratios if it is
    /// log-uniform or log-normal, otherwise at equal distances. A discrete factor takes each of its values, or some of
    /// many whole numbers.
    ///
    /// # Errors
    /// [`SweepError::Points`] if there are fewer than 2 or more than 100,000 points.
    pub fn values_over_range(&self, points: usize) -> Result<Vec<f64>, SweepError> {
        if !(2..=Sweeps::MAX_POINTS).contains(&points) {
            return Err(SweepError::Points(points));
        }
        let (low, high) = range(self);
        if matches!(self, Distribution::Constant(_)) {
            return Ok(vec![low]);
        }
        let are_rounded = self.is_whole() && high - low >= points as f64;
        if !are_rounded && let Some(levels) = self.levels() {
            return Ok(levels.into_iter().map(|(value, _)| value).collect());
        }
        let mut values = Vec::with_capacity(points);
        for i in 0..points {
            let part = i as f64 / (points - 1) as f64;
            let value = match i {
                0 => low,
                // Exactly the end, despite rounding on the way.
                _ if i == points - 1 => high,
                _ if is_logarithmic(self) => libm::exp(libm::log(low) * (1.0 - part) + libm::log(high) * part),
                _ => low * (1.0 - part) + high * part,
            };
            values.push(if are_rounded { value.round() } else { value });
        }
        Ok(values)
    }
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
