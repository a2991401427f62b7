//! Confidence intervals of estimates, and quantities derived from them.
//!
//! An estimate depends on all runs. Influences are those of each part of them; an [`IntervalMethod`] turns
//! these into a standard error: for Sobol' points by the decay of the error in a net, for random points by their batches, or from the
//! outputs of every point by the delta method or a bootstrap.

mod bootstrap;
mod by_points;
mod concentration;
mod delta;
mod effects;
mod influence;
mod jackknife;
mod judgement;
mod method;
mod net_decay;
mod points;
mod ranks;
mod special;
mod standard_error;
mod unseen;

pub(crate) use by_points::ByPoints;
pub use effects::{DependentEstimates, EffectEstimates};
pub(crate) use effects::{EffectChecks, OutputMoments, agreeing, differs_clearly};
pub(crate) use influence::{Influences, LeftOut};
pub(crate) use jackknife::jackknife;
pub(crate) use judgement::Judgement;
pub use method::IntervalMethod;
pub(crate) use points::KeptPoints;
pub(crate) use ranks::probability_first;
use serde::{Deserialize, Serialize};
pub(crate) use standard_error::{ErrorKind, PartInfluences, Side, StandardError};
use std::cell::Cell;
pub(crate) use unseen::{RULE_OF_THREE, half_seen, unseen};

use apportion_base::special::t_quantile_outside;

/// Quantile of the normal distribution for [`Interval::LEVEL`].
pub(crate) const NORMAL_QUANTILE: f64 = 1.959_963_984_540_054;

/// A two-sided confidence interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "IntervalRecord"))]
pub struct Interval {
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

impl Interval {
    /// Returns the two-sided t-interval about `estimate` with a standard error of `freedom` degrees of freedom; `None`
    /// if one of them is unknown.
    pub fn students_t(estimate: f64, error: f64, freedom: f64) -> Option<Self> {
        t_interval(estimate, StandardError { error, freedom })
    }

    /// Confidence level of every interval.
    pub const LEVEL: f64 = 0.95;

    /// Returns the interval with `middle` at its centre.
    pub fn about(middle: f64, half_width: f64) -> Self {
        Self { low: middle - half_width, high: middle + half_width }
    }

    /// Returns the distance of its bounds.
    pub fn width(self) -> f64 {
        self.high - self.low
    }

    /// Returns the interval with `change` applied to its bounds; `None` if one of them overflows.
    pub fn map(self, change: impl Fn(f64) -> f64) -> Option<Self> {
        Self { low: change(self.low), high: change(self.high) }.finite()
    }

    /// Returns the interval, or `None` if a bound has overflowed.
    pub(crate) fn finite(self) -> Option<Self> {
        (self.low.is_finite() && self.high.is_finite()).then_some(self)
    }
}

/// A number with its interval, if there is one. Files contain `estimate`, `low` and `high`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "EstimateRecord", into = "EstimateRecord")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Estimate {
    /// The estimate.
    pub estimate: f64,
    /// Its interval; `None` if its error is unknown.
    pub interval: Option<Interval>,
}

impl Estimate {
    /// Returns `b` minus `a`, with an interval of the level of theirs, if both have one.
    ///
    /// With the distances of the bounds from their estimates,
    /// low = b - a - sqrt((b - b_low)² + (a_high - a)²) and high = b - a + sqrt((b_high - b)² + (a - a_low)²):
    /// the method of Zou and Donner (2008), *Construction of confidence limits about effect measures: a general approach*,
    /// Statistics in Medicine 27, 1693-1702, for two estimates whose errors are independent. For symmetric intervals this
    /// is the root of the sum of squares of the half widths.
    ///
    /// ```
    /// use apportion::{Estimate, Interval};
    ///
    /// let a = Estimate { estimate: 0.5, interval: Some(Interval { low: 0.47, high: 0.53 }) };
    /// let b = Estimate { estimate: 0.7, interval: Some(Interval { low: 0.66, high: 0.74 }) };
    /// let d = Estimate::difference(a, b);
    /// assert!((d.estimate - 0.2).abs() < 1e-15);
    /// let interval = d.interval.unwrap();
    /// assert!((interval.low - 0.15).abs() < 1e-15 && (interval.high - 0.25).abs() < 1e-15);
    /// ```
    pub fn difference(a: Estimate, b: Estimate) -> Estimate {
        let estimate = b.estimate - a.estimate;
        let interval = a.interval.zip(b.interval).map(|(of_a, of_b)| Interval {
            low: estimate - libm::hypot(of_b.low - b.estimate, of_a.high - a.estimate),
            high: estimate + libm::hypot(of_b.high - b.estimate, of_a.low - a.estimate),
        });
        Estimate { estimate, interval }
    }

    /// Returns a number without error.
    pub(crate) fn exact(estimate: f64) -> Self {
        Self { estimate, interval: Some(Interval::about(estimate, 0.0)) }
    }

    /// Returns a number of unknown error.
    pub fn alone(estimate: f64) -> Self {
        Self { estimate, interval: None }
    }
}

/// An estimate with its interval.
#[derive(Clone, Copy, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
struct EstimateRecord {
    /// The estimate.
    estimate: f64,
    /// Lower bound; `null` with a single replicate.
    low: Option<f64>,
    /// Upper bound; `null` with a single replicate.
    high: Option<f64>,
}

impl From<Estimate> for EstimateRecord {
    fn from(Estimate { estimate, interval }: Estimate) -> Self {
        Self { estimate, low: interval.map(|i| i.low), high: interval.map(|i| i.high) }
    }
}

impl From<EstimateRecord> for Estimate {
    fn from(EstimateRecord { estimate, low, high }: EstimateRecord) -> Self {
        Self { estimate, interval: low.zip(high).map(|(low, high)| Interval { low, high }) }
    }
}

/// Returns the two-sided t-interval at [`Interval::LEVEL`] about `estimate`; `None` if the estimate or its error is unknown.
pub(crate) fn t_interval(estimate: f64, error: StandardError) -> Option<Interval> {
    if error.error == 0.0 {
        return Interval::about(estimate, 0.0).finite();
    }
    let half_width = t_quantile(error.freedom)? * error.error;
    Interval::about(estimate, half_width).finite()
}

/// Returns the quantile of Student's t for a two-sided interval at [`Interval::LEVEL`]; `None` without degrees of freedom.
pub(crate) fn t_quantile(freedom: f64) -> Option<f64> {
    // Above this the quantile is the normal one with its first correction (Abramowitz and Stegun 1964, 26.7.5), to
    // 1e-8.
    const LARGE_FREEDOM: f64 = 1e4;
    if freedom > LARGE_FREEDOM {
        let z = NORMAL_QUANTILE;
        return Some(z + (z.powi(3) + z) / (4.0 * freedom)).filter(|_| freedom.is_finite());
    }
    // Most intervals of an output have the same degrees of freedom.
    thread_local! { static LAST: Cell<(f64, f64)> = const { Cell::new((f64::NAN, f64::NAN)) }; }
    if freedom > 0.0 && LAST.get().0 != freedom {
        LAST.set((freedom, t_quantile_outside(1.0 - Interval::LEVEL, freedom)));
    }
    (freedom > 0.0).then(|| LAST.get().1).filter(|quantile| quantile.is_finite())
}

/// Returns half the width of the widest interval; `None` if an estimate has none.
pub(crate) fn largest_half_width(estimates: impl IntoIterator<Item = Estimate>) -> Option<f64> {
    let half_widths = estimates.into_iter().map(|estimate| estimate.interval.map(|interval| interval.width() / 2.0));
    half_widths.into_iter().try_fold(0.0, |largest: f64, half_width| Some(largest.max(half_width?)))
}

#[cfg(test)]
mod tests;
