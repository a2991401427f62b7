//! Intervals from the outputs of every base point of a random design.

use super::bootstrap::resampled;
use super::delta::delta_errors;
use super::method::IntervalMethod;
use super::points::KeptPoints;
use super::standard_error::StandardError;
use super::{Interval, t_interval};
use crate::estimate::{Moments, Products};

/// Maximum share of resamples in which a quantity may be undefined and still have an interval.
const UNDEFINED: f64 = 0.01;

/// The method, and for a bootstrap its random numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ByPoints<'a> {
    pub method: IntervalMethod,
    pub points: KeptPoints<'a>,
    pub seed: u64,
    pub resamples: usize,
}

/// A standard error, and an interval if there is one.
pub(crate) type Bounds = (StandardError, Option<Interval>);

impl ByPoints<'_> {
    /// Computes the bounds of `estimates`, the results of `quantities` on `all`, the moments of all points.
    pub fn bounds(
        self,
        all: Moments,
        estimates: &[f64],
        quantities: &(dyn Fn(&Moments) -> Option<Vec<f64>> + Sync),
    ) -> Vec<Bounds> {
        let products = Products::new(all);
        let none = (StandardError { error: f64::NAN, freedom: 0.0 }, None);
        if self.method == IntervalMethod::Delta {
            let Some(errors) = delta_errors(self.points, &products, quantities) else {
                return vec![none; estimates.len()];
            };
            let both = estimates.iter().zip(errors);
            return both.map(|(estimate, error)| (error, t_interval(*estimate, error))).collect();
        }
        let values = resampled(self.points, &products, self.seed, self.resamples, quantities);
        let freedom = self.points.count() as f64 - 1.0;
        let mut bounds = Vec::with_capacity(estimates.len());
        for (q, estimate) in estimates.iter().enumerate() {
            let mut sorted: Vec<f64> =
                values.iter().flatten().map(|values| values[q]).filter(|x| x.is_finite()).collect();
            let undefined = self.resamples - sorted.len();
            if undefined as f64 > UNDEFINED * self.resamples as f64 || !estimate.is_finite() || freedom < 1.0 {
                bounds.push(none);
                continue;
            }
            sorted.sort_by(f64::total_cmp);
            let error = StandardError { error: deviation(&sorted, *estimate), freedom };
            let [low, high] =
                [(1.0 - Interval::LEVEL) / 2.0, (1.0 + Interval::LEVEL) / 2.0].map(|p| quantile(&sorted, p));
            bounds.push((error, Some(Interval { low, high })));
        }
        bounds
    }
}

/// Returns the standard deviation of the resampled values, from their deviations from the estimate.
fn deviation(values: &[f64], estimate: f64) -> f64 {
    let size = values.iter().fold(0.0, |largest: f64, x| largest.max((x - estimate).abs()));
    if size == 0.0 {
        return 0.0;
    }
    let n = values.len() as f64;
    let mean = values.iter().map(|x| (x - estimate) / size).sum::<f64>() / n;
    let squares: f64 = values.iter().map(|x| ((x - estimate) / size - mean).powi(2)).sum();
    size * (squares / (n - 1.0)).sqrt()
}

/// Returns the quantile at `p` of R sorted values, the (R + 1) p-th of them (Davison and Hinkley 1997, Bootstrap
/// Methods and their Application, section 5.2), interpolated linearly.
pub(crate) fn quantile(sorted: &[f64], p: f64) -> f64 {
    let place = ((sorted.len() + 1) as f64 * p - 1.0).clamp(0.0, (sorted.len() - 1) as f64);
    let below = place as usize;
    let above = (below + 1).min(sorted.len() - 1);
    sorted[below] + (sorted[above] - sorted[below]) * (place - below as f64)
}

#[cfg(test)]
#[path = "tests/by_points.rs"]
mod tests;
