//! The difference of two estimates, with an interval made of theirs.

use serde::{Deserialize, Serialize};

use crate::uncertainty::{Estimate, Interval, difference};

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
