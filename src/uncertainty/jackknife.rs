//! The delete-one jackknife.

use super::{Estimate, Interval, t_quantile};

/// Returns estimates of quantities with t-intervals from `R` independent replicates, by the delete-one jackknife.
///
/// `whole` is the quantities estimated from all replicates together, `without[r]` the same from all but replicate r.
/// The standard error is sqrt((R - 1)/R sum_r (without_r - mean)^2) (Quenouille 1956, Tukey 1958; Efron and Stein
/// 1981), and the interval is `whole` +- t_{R-1} times it. Replicates are independent randomisations of a whole net, so
/// this is valid for quasi-random points, where a bootstrap over the points is not.
///
/// All lists have one entry per quantity, in the same order.
pub fn jackknife(whole: &[f64], without: &[Vec<f64>]) -> Vec<Estimate> {
    let quantile = t_quantile((without.len() as f64 - 1.0).max(0.0));
    let interval = |k: usize, estimate: f64| {
        let r = without.len() as f64;
        // Relative to the estimate, so that nothing large is subtracted.
        let deviations = || without.iter().map(move |values| values[k] - estimate);
        let mean = deviations().sum::<f64>() / r;
        let spread: f64 = deviations().map(|d| (d - mean).powi(2)).sum();
        let half_width = quantile? * ((r - 1.0) / r * spread).sqrt();
        Interval::about(estimate, half_width).finite()
    };
    whole.iter().enumerate().map(|(k, &estimate)| Estimate { estimate, interval: interval(k, estimate) }).collect()
}

#[cfg(test)]
mod tests;
