//! The difference of two estimates, with an interval made of theirs.

use serde::{Deserialize, Serialize};

use crate::report::result::EstimateRecord;

/// Indices are shares of a variance: differences up to this are of the size of the rounding errors of its sums, which the
/// intervals do not hold.
const ROUNDING: f64 = 1e-12;

/// One index in both results.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ComparedIndex {
    /// In A; `null` if it does not exist there.
    pub a: Option<EstimateRecord>,
    /// In B; `null` if it does not exist there.
    pub b: Option<EstimateRecord>,
    /// B minus A; `null` if one of them does not exist.
    pub difference: Option<EstimateRecord>,
    /// Whether the interval of the difference leaves out 0, and the difference is more than rounding (1e-12); `null`
    /// without an interval.
    pub differs: Option<bool>,
}

impl ComparedIndex {
    /// The index `a` in A beside the index `b` in B.
    pub fn new(a: Option<EstimateRecord>, b: Option<EstimateRecord>) -> Self {
        let difference = a.zip(b).map(|(a, b)| difference(a, b));
        let beyond = |d: EstimateRecord| Some((d.low? > 0.0 || d.high? < 0.0) && d.estimate.abs() > ROUNDING);
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
/// use apportion::report::EstimateRecord;
/// use apportion::report::comparison::difference;
///
/// let a = EstimateRecord { estimate: 0.5, low: Some(0.47), high: Some(0.53) };
/// let b = EstimateRecord { estimate: 0.7, low: Some(0.66), high: Some(0.74) };
/// let d = difference(a, b);
/// assert!((d.estimate - 0.2).abs() < 1e-15);
/// assert!((d.low.unwrap() - 0.15).abs() < 1e-15 && (d.high.unwrap() - 0.25).abs() < 1e-15);
/// ```
pub fn difference(a: EstimateRecord, b: EstimateRecord) -> EstimateRecord {
    let estimate = b.estimate - a.estimate;
    let reach = |of_b: Option<f64>, of_a: Option<f64>| Some(libm::hypot(of_b? - b.estimate, of_a? - a.estimate));
    EstimateRecord {
        estimate,
        low: reach(b.low, a.high).map(|reach| estimate - reach),
        high: reach(b.high, a.low).map(|reach| estimate + reach),
    }
}
