//! The delete-one jackknife.

use super::{Estimate, Interval, t_quantile};

/// Returns estimates of quantities with t-intervals from `R` independent replicates, by the delete-one jackknife.
///
/// `all` is the quantities estimated from all replicates together, `without[r]` the same from all but replicate r.
/// The standard error is sqrt((R - 1)/R sum_r (without_r - mean)^2) (Quenouille 1956, Tukey 1958; Efron and Stein
/// 1981), and the interval is `all` +- t_{R-1} times it. Replicates are independent randomisations of one net, so
/// this is valid for quasi-random points, where a bootstrap over the points is not.
///
/// All lists have one entry per quantity, in the same order.
pub fn jackknife(all: &[f64], without: &[Vec<f64>]) -> Vec<Estimate> {
    let r = without.len() as f64;
    let quantile = t_quantile((r - 1.0).max(0.0));
    let mut estimates = Vec::with_capacity(all.len());
    for (k, &estimate) in all.iter().enumerate() {
        // Relative to the estimate, so that nothing large is subtracted.
        let mean = without.iter().map(|values| values[k] - estimate).sum::<f64>() / r;
        let spread: f64 = without.iter().map(|values| (values[k] - estimate - mean).powi(2)).sum();
        let half_width = quantile.map(|quantile| quantile * ((r - 1.0) / r * spread).sqrt());
        let interval = half_width.and_then(|half_width| Interval::about(estimate, half_width).finite());
        estimates.push(Estimate { estimate, interval });
    }
    estimates
}

#[cfg(test)]
#[path = "tests/jackknife.rs"]
mod tests;
