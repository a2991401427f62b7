//! Intervals from the outputs of every base point of a random design.

use super::bootstrap::resampled;
use super::delta::{InfluenceSums, influence_sums};
use super::method::IntervalMethod;
use super::net_decay::StandardError;
use super::points::KeptPoints;
use super::{Interval, LEVEL, t_interval};
use crate::estimate::{Moments, Products};
use crate::special::{normal_below, normal_quantile};

/// Share of resamples in which a quantity may be undefined before it has no interval.
const UNDEFINED: f64 = 0.01;

/// Asked for: how, and for a bootstrap from which random numbers.
#[derive(Debug, Clone, Copy)]
pub(super) struct ByPoints<'a> {
    pub method: IntervalMethod,
    pub points: KeptPoints<'a>,
    pub seed: u64,
    pub resamples: usize,
}

/// A standard error and an interval, where there is one.
pub(super) type Bounds = (StandardError, Option<Interval>);

impl ByPoints<'_> {
    /// The bounds of `estimates`, which `quantities` gives on `whole`, the moments of all points.
    pub fn bounds(
        self,
        whole: Moments,
        estimates: &[f64],
        quantities: &(dyn Fn(&Moments) -> Option<Vec<f64>> + Sync),
    ) -> Vec<Bounds> {
        let products = Products::of(whole);
        let none = (StandardError { error: f64::NAN, freedom: 0.0 }, None);
        let influences = match self.method {
            IntervalMethod::Percentile => None,
            _ => influence_sums(self.points, &products, quantities),
        };
        if self.method == IntervalMethod::Delta {
            let bounds = |(estimate, sums): (&f64, &InfluenceSums)| (sums.error(), t_interval(*estimate, sums.error()));
            let influences = influences.iter().flatten();
            let mut all: Vec<Bounds> = estimates.iter().zip(influences).map(bounds).collect();
            all.resize(estimates.len(), none);
            return all;
        }
        let values = resampled(self.points, &products, self.seed, self.resamples, quantities);
        let freedom = self.points.count() as f64 - 1.0;
        let of_quantity = |(q, estimate): (usize, &f64)| {
            let mut sorted: Vec<f64> =
                values.iter().flatten().map(|values| values[q]).filter(|x| x.is_finite()).collect();
            let undefined = self.resamples - sorted.len();
            if undefined as f64 > UNDEFINED * self.resamples as f64 || !estimate.is_finite() || freedom < 1.0 {
                return none;
            }
            sorted.sort_by(f64::total_cmp);
            let error = StandardError { error: deviation(&sorted, *estimate), freedom };
            let tails = match self.method {
                IntervalMethod::Bca => {
                    let acceleration = influences.as_ref().map_or(f64::NAN, |sums| sums[q].acceleration());
                    bca_tails(&sorted, *estimate, acceleration)
                }
                _ => Some([(1.0 - LEVEL) / 2.0, (1.0 + LEVEL) / 2.0]),
            };
            let interval =
                tails.map(|[low, high]| Interval { low: quantile(&sorted, low), high: quantile(&sorted, high) });
            (error, interval)
        };
        estimates.iter().enumerate().map(of_quantity).collect()
    }
}

/// Standard deviation of the resampled values, from their deviations from the estimate.
fn deviation(values: &[f64], estimate: f64) -> f64 {
    let size = values.iter().fold(0.0, |largest: f64, x| largest.max((x - estimate).abs()));
    if size == 0.0 {
        return 0.0;
    }
    let n = values.len() as f64;
    let deviations = || values.iter().map(|x| (x - estimate) / size);
    let mean = deviations().sum::<f64>() / n;
    size * (deviations().map(|d| (d - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt()
}

/// The quantile at `p` of R sorted values, the (R + 1) p-th of them (Davison and Hinkley 1997, Bootstrap Methods and
/// their Application, section 5.2), on the line between neighbours.
pub(crate) fn quantile(sorted: &[f64], p: f64) -> f64 {
    let place = ((sorted.len() + 1) as f64 * p - 1.0).clamp(0.0, (sorted.len() - 1) as f64);
    let below = place as usize;
    let above = (below + 1).min(sorted.len() - 1);
    sorted[below] + (sorted[above] - sorted[below]) * (place - below as f64)
}

/// The two probabilities at which the BCa interval reads the resampled values (Efron 1987): the bias correction is the
/// normal quantile of the share of them below the estimate, where equal ones count half and at least half a value is on
/// either side. `None` if the acceleration is unknown.
fn bca_tails(sorted: &[f64], estimate: f64, acceleration: f64) -> Option<[f64; 2]> {
    let below = sorted.partition_point(|x| *x < estimate);
    let equal = sorted.partition_point(|x| *x <= estimate) - below;
    let n = sorted.len() as f64;
    let share = (below as f64 + equal as f64 / 2.0).clamp(0.5, n - 0.5) / n;
    let bias = normal_quantile(share);
    let tail = |p: f64| {
        let z = bias + normal_quantile(p);
        let left = 1.0 - acceleration * z;
        // Beyond its pole the transformation has run off to the end.
        if left > 0.0 { normal_below(bias + z / left) } else { f64::from(u8::from(z > 0.0)) }
    };
    acceleration.is_finite().then(|| [tail((1.0 - LEVEL) / 2.0), tail((1.0 + LEVEL) / 2.0)])
}

#[cfg(test)]
mod tests;
