//! Intervals from independent randomised replicates.

mod net_decay;
mod replicated;
mod special;

pub use net_decay::{PartInfluences, StandardError, net_errors};
pub use replicated::{EffectEstimates, ReplicatedIndices, ReplicatedMoments, replicated_indices, replicated_moments};

use statrs::distribution::{ContinuousCDF, StudentsT};

/// Confidence level of every interval.
pub const LEVEL: f64 = 0.95;

/// A two-sided confidence interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

/// A number with its interval, where there is one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The estimate.
    pub estimate: f64,
    /// Its interval; `None` with one replicate, which says nothing about its error.
    pub interval: Option<Interval>,
}

/// Estimates of several quantities with t-intervals from `R` independent replicates, by the delete-one jackknife.
///
/// `whole` holds the quantities estimated from all replicates together, `without[r]` the same from all but replicate
/// r. The standard error is sqrt((R - 1)/R sum_r (without_r - mean)^2) (Quenouille 1956, Tukey 1958; Efron and Stein
/// 1981), and the interval is `whole` +- t_{R-1} times it. Replicates are independent randomisations of a whole net,
/// so this is honest for quasi-random points, where a bootstrap over the points is not.
///
/// All lists have one entry per quantity, in the same order.
pub fn jackknife(whole: &[f64], without: &[Vec<f64>]) -> Vec<Estimate> {
    let quantile = t_quantile(without.len());
    let interval = |k: usize, estimate: f64| {
        let r = without.len() as f64;
        // Relative to the estimate, so that nothing large is subtracted.
        let deviations = || without.iter().map(move |values| values[k] - estimate);
        let mean = deviations().sum::<f64>() / r;
        let spread: f64 = deviations().map(|d| (d - mean).powi(2)).sum();
        let half_width = quantile? * ((r - 1.0) / r * spread).sqrt();
        Some(Interval { low: estimate - half_width, high: estimate + half_width })
    };
    whole.iter().enumerate().map(|(k, &estimate)| Estimate { estimate, interval: interval(k, estimate) }).collect()
}

/// The quantile of Student's t distribution with `replicates - 1` degrees of freedom for a two-sided interval at
/// [`LEVEL`]; `None` for fewer than two replicates.
fn t_quantile(replicates: usize) -> Option<f64> {
    let freedom = replicates.checked_sub(1).filter(|&f| f > 0)?;
    let t = StudentsT::new(0.0, 1.0, freedom as f64).ok()?;
    Some(t.inverse_cdf((1.0 + LEVEL) / 2.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn t_quantiles_are_those_of_the_tables() {
        for (replicates, expected) in [(2, 12.7062), (3, 4.3027), (5, 2.7764), (16, 2.1314), (101, 1.9840)] {
            assert!((t_quantile(replicates).unwrap() - expected).abs() < 5e-5);
        }
        assert_eq!(t_quantile(1), None);
        assert_eq!(t_quantile(0), None);
    }

    #[test]
    fn for_a_mean_it_is_the_classical_t_interval() {
        let x = [1.0, 4.0, 2.0, 7.0, 6.0];
        let sum: f64 = x.iter().sum();
        let without: Vec<Vec<f64>> = x.iter().map(|xi| vec![(sum - xi) / 4.0]).collect();
        let got = jackknife(&[4.0], &without)[0].interval.unwrap();
        let sd = (x.iter().map(|x| (x - 4.0f64).powi(2)).sum::<f64>() / 4.0).sqrt();
        let half_width = t_quantile(5).unwrap() * sd / 5f64.sqrt();
        assert!((got.high - 4.0 - half_width).abs() < 1e-14);
        assert!((4.0 - got.low - half_width).abs() < 1e-14);
    }

    #[test]
    fn one_replicate_carries_no_interval() {
        assert_eq!(jackknife(&[0.5], &[vec![f64::NAN]])[0], Estimate { estimate: 0.5, interval: None });
    }
}
