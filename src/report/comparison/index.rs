//! The difference of two estimates, with an interval made of theirs.

use serde::{Deserialize, Serialize};

use crate::uncertainty::{Estimate, Interval};

/// Indices are shares of a variance: differences up to this are of the size of the rounding errors of its sums, which the
/// intervals do not hold.
const ROUNDING: f64 = 1e-12;

/// One index in both results.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ComparedIndex {
    /// In A; `null` if it does not exist there.
    pub a: Option<Estimate>,
    /// In B; `null` if it does not exist there.
    pub b: Option<Estimate>,
    /// B minus A; `null` if one of them does not exist.
    pub difference: Option<Estimate>,
    /// Whether the interval of the difference leaves out 0, and the difference is more than rounding (1e-12); `null`
    /// without an interval.
    pub differs: Option<bool>,
}

impl ComparedIndex {
    /// The index `a` in A beside the index `b` in B.
    pub fn new(a: Option<Estimate>, b: Option<Estimate>) -> Self {
        let difference = a.zip(b).map(|(a, b)| difference(a, b));
        let beyond = |d: Estimate| {
            d.interval.map(|Interval { low, high }| (low > 0.0 || high < 0.0) && d.estimate.abs() > ROUNDING)
        };
        let differs = difference.and_then(beyond);
        Self { a, b, difference, differs }
    }
}

/// `b` minus `a`, with an interval of the level of theirs, if both have one.
///
/// With the distances of the bounds from their estimates,
/// low = b - a - sqrt((b - b_low)² + (a_high - a)²) and high = b - a + sqrt((b_high - b)² + (a - a_low)²):
/// the method of Zou and Donner (2008), *Construction of confidence limits about effect measures: a general approach*,
/// Statistics in Medicine 27, 1693-1702, for two estimates whose errors are independent. For symmetric intervals that is
/// the root of the sum of squares of the half widths.
///
/// ```
/// use apportion::{Estimate, Interval};
/// use apportion::report::comparison::difference;
///
/// let a = Estimate { estimate: 0.5, interval: Some(Interval { low: 0.47, high: 0.53 }) };
/// let b = Estimate { estimate: 0.7, interval: Some(Interval { low: 0.66, high: 0.74 }) };
/// let d = difference(a, b);
/// assert!((d.estimate - 0.2).abs() < 1e-15);
/// let interval = d.interval.unwrap();
/// assert!((interval.low - 0.15).abs() < 1e-15 && (interval.high - 0.25).abs() < 1e-15);
/// ```
pub fn difference(a: Estimate, b: Estimate) -> Estimate {
    let estimate = b.estimate - a.estimate;
    let reach = |of_b: f64, of_a: f64| libm::hypot(of_b - b.estimate, of_a - a.estimate);
    let interval = a.interval.zip(b.interval).map(|(of_a, of_b)| Interval {
        low: estimate - reach(of_b.low, of_a.high),
        high: estimate + reach(of_b.high, of_a.low),
    });
    Estimate { estimate, interval }
}
